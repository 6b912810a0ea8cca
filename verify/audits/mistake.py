"""A described mistake, with all that is measured of it; or why it is not reported.

A person has read of each mistake: the words that claim, the line to blame, and the correction. One
TOML file describes one, `reports/audits/findings/NAME.toml`. Nothing in it is taken for true: the
claims must be refuted where it is reported, and the tables and programs are run again, the tables
also with the entries changed as the correction would have them.
"""

import re
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import cache
from pathlib import Path
from typing import Annotated, Any, Literal

import sympy
from pydantic import Field, ValidationError

from verify.audits.library_claims import files
from verify.audits.second_look import claimed_of, look_at_table
from verify.audits.table_convergence import SystemConvergence
from verify.content import content
from verify.errors import InputError
from verify.integrators.tables import kinds
from verify.integrators.tables.entry import TableEntry
from verify.integrators.tables.splitting_claims import AlternatingEntry, parts_of
from verify.integrators.tables.table_file import read_tables
from verify.scenes.frozen import Frozen
from verify.scenes.model_mistakes import describe_first_error
from verify.scenes.results.claim import ClaimResult
from verify.scenes.toml_file import read_toml
from verify.schemes.printed.naming import Naming
from verify.verdict import Verdict

Text = Annotated[str, Field(min_length=1, max_length=20000)]


class TableCorrection(Frozen):
    """A printed table, by the first word of its file's title and its name; which of its claims; and
    the entries that the mend changes, by key, row and column from 1, to their texts."""

    id: Text
    kind: Text
    changes: dict[str, str] = Field(default_factory=dict)


class Description(Frozen):
    """A mistake as a person has read it: where it is, what holds instead, and how it is mended.

    `claims`: ids of what is refuted, with * for any text. `program` is in the library's `language`;
    `mended`, the same with the mend; `ran`: by whom it was run and when, unless it is run here.
    """

    title: Text
    library: Text
    claims: Annotated[tuple[Text, ...], Field(min_length=1)]
    quote: Text
    where: Text
    holds: Text
    blame: Text
    mend: Text
    language: Literal["python", "c", "c++", "julia"]
    program: Text
    mended: Text | None = None
    ran: str = ""
    output: str = ""
    table: tuple[TableCorrection, ...] = ()

    def tells_of(self, claim: str) -> bool:
        """Return True if it is about the claim of that id."""
        return any(fnmatchcase(_plain(claim), _plain(pattern)) for pattern in self.claims)


def _plain(text: str) -> str:
    """Replace the brackets that stand for more than themselves in a pattern."""
    return text.replace("[", "(").replace("]", ")")


def folder() -> Path:
    """Return the folder of the descriptions."""
    return Path(content("reports", "audits", "findings"))


def descriptions() -> dict[str, Description]:
    """Read all descriptions, by name. Raises InputError for a file that is none."""
    return {path.stem: read(path) for path in sorted(folder().glob("*.toml"))}


def read(path: Path) -> Description:
    """Read one description. InputError names the file."""
    try:
        return Description.model_validate(read_toml(path))
    except ValidationError as error:
        problem = describe_first_error(error, f"finding {path.stem}", Description)
        raise problem from None


RIGHT = "right"


def entry_of(name: str) -> TableEntry:
    """Return the printed table of that id. Raises InputError for none."""
    entry = _entries().get(name)
    if entry is None:
        raise InputError("table", name, "is none of the printed tables in reports/audits")
    return entry


@cache
def _entries() -> dict[str, TableEntry]:
    """Read all printed tables of libraries, by id; the files are read once."""
    table_files = map(read_tables, files())
    return {
        f"{x.title.split()[0]}/{entry.name}": entry for x in table_files for entry, _ in x.entries
    }


def change_entries(entry: TableEntry, changes: Mapping[str, str]) -> TableEntry:
    """Return the table with those entries. Raises InputError for a key that it has not."""
    data = entry.model_dump(exclude_unset=True)
    for key, value in changes.items():
        if key == "times" and value == RIGHT:
            data["times"] = _right_times(entry)
        else:
            _put_entry(data, key, value)
    try:
        table: TableEntry = kinds.get(entry.kind).ENTRY.model_validate(data)
    except ValidationError as error:
        raise describe_first_error(error, "changes", type(entry)) from None
    return table.in_folder(entry.folder)


def _put_entry(data: dict[str, Any], key: str, value: str) -> None:
    *path, last = [int(x) - 1 if x.isdigit() else x for x in key.split(".")]
    container: Any = data
    for step in path:
        # Models hold tuples: on the way down each is replaced by a list that can be changed.
        container[step] = (
            list(container[step]) if isinstance(container[step], tuple) else container[step]
        )
        container = container[step]
    if isinstance(last, int) and not last < len(container):
        raise InputError("changes", key, "is no entry of the table")
    container[last] = value


def _right_times(entry: TableEntry) -> list[str]:
    """Return the time that each part should read: what the other kind's parts before it add up
    to."""
    if not isinstance(entry, AlternatingEntry):
        raise InputError("changes", "times", "are made right of kicks and drifts alone")
    naming = Naming(entry.numbers)
    names, sizes, _ = parts_of(entry, naming)
    totals = {"kick": sympy.S.Zero, "drift": sympy.S.Zero}
    times = []
    for name, size in zip(names, sizes, strict=True):
        other_kind = "drift" if name == "kick" else "kick"
        times.append(str(sympy.N(totals[other_kind], 60)))
        totals[name] += naming.printed_numbers.at_print(naming.printed_numbers.entry(size))
    return times


_SECONDS = 300.0
_ORDER = re.compile(r"^order on (.+): (-?\d+\.\d+)$", re.MULTILINE)
_WITHIN = 0.3  # of the order that a program prints


@dataclass(frozen=True)
class ProgramOutput:
    """The output of a program, and the orders that it names, by problem; `failed`: why it did not
    end well."""

    printed: str
    orders: dict[str, float]
    failed: str = ""


@dataclass(frozen=True)
class TableEvidence:
    """One table: its claimed order, its steps' orders as printed, and with the mend."""

    name: str
    claimed: int
    printed: tuple[SystemConvergence, ...]
    mended: tuple[SystemConvergence, ...] = ()


@dataclass(frozen=True)
class ConfirmedFinding:
    """A confirmed finding: the description, the refuted claims, and what was run."""

    name: str
    described: Description
    claims: tuple[ClaimResult, ...]
    tables: tuple[TableEvidence, ...] = ()
    program: ProgramOutput | None = None
    mended: ProgramOutput | None = None


class NotConfirmedError(Exception):
    """The reason why a mistake is not reported, one clause."""


def confirm(name: str, described: Description, claims: Sequence[ClaimResult]) -> ConfirmedFinding:
    """Confirm a mistake on the claims that were judged just now. Raises NotConfirmedError where one
    that it is about is not refuted, or where a table or a program does not show it, or not the
    correction."""
    # Only claims that were judged in this run count: a newer version of the library may be right.
    matching = tuple(claim for claim in claims if described.tells_of(claim.id))
    if not matching:
        raise NotConfirmedError("none of its claims was judged: its library is not installed")
    for claim in matching:
        if claim.verdict is not Verdict.REFUTED:
            raise NotConfirmedError(f"{claim.id} is {claim.verdict}, not refuted")
    tables = tuple(_confirm_table(each) for each in described.table)
    program = None
    mended = None
    if described.language == "python":
        program = _run_confirmed(described.program)
        mended = _run_confirmed(described.mended) if described.mended else None
        _compare(program, mended)
    return ConfirmedFinding(name, described, matching, tables, program, mended)


def _confirm_table(correction: TableCorrection) -> TableEvidence:
    try:
        entry = entry_of(correction.id)
        claimed = claimed_of(entry, correction.kind)
        if claimed is None:
            raise NotConfirmedError(f"{correction.id} claims no order")
        printed = look_at_table(entry, correction.kind, claimed)
        mended: tuple[SystemConvergence, ...] = ()
        if correction.changes:
            mended = look_at_table(
                change_entries(entry, correction.changes), correction.kind, claimed
            ).slopes
    except InputError as error:
        raise NotConfirmedError(str(error)) from None
    if not printed.confirms:
        raise NotConfirmedError(f"{correction.id}: its steps do not show it")
    corrected_orders = [x.order for x in mended if x.order is not None]
    # A correction is reported only if the corrected steps show the claimed order by themselves.
    if correction.changes and (
        not corrected_orders
        or min(corrected_orders) < claimed
        or any(x.below(claimed) for x in mended)
    ):
        raise NotConfirmedError(f"{correction.id}: with the mend its order is not {claimed}")
    return TableEvidence(correction.id, claimed, printed.slopes, mended)


def _run_confirmed(program: str) -> ProgramOutput:
    result = run(program)
    if result.failed:
        raise NotConfirmedError(f"its program fails: {result.failed}")
    return result


def _compare(program: ProgramOutput, mended: ProgramOutput | None) -> None:
    """Check that the correction raises every order by nearly one, at least."""
    for problem, order in (mended.orders if mended else {}).items():
        before = program.orders.get(problem)
        if before is None or order < before + 1 - _WITHIN:
            raise NotConfirmedError(f"the mend does not raise the order on {problem}")


# -- a program in Python, where its library is installed ------------------------------------------


def run(program: str) -> ProgramOutput:
    """Run the lines of a program; only what it prints is let through."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "program.py"
        path.write_text(program, encoding="utf-8")
        try:
            process = subprocess.run(  # noqa: S603 - the program is ours, beside the descriptions
                [sys.executable, str(path)],
                capture_output=True,
                text=True,
                timeout=_SECONDS,
                cwd=folder,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return ProgramOutput("", {}, f"does not end within {_SECONDS:.0f} s")
    orders = {name: float(order) for name, order in _ORDER.findall(process.stdout)}
    last = process.stderr.strip().splitlines()[-1:] if process.returncode else []
    return ProgramOutput(process.stdout.strip(), orders, " ".join(last))
