"""A described mistake with its evidence, or the reason why it is not reported.

A person has described each mistake in a TOML file, `reports/audits/findings/NAME.toml`: the claim
in its own words, the line to blame, and the correction. Nothing in it is taken for true. A mistake
is reported only if the claims are refuted in the same run, and if the tables and programs show it
when they are run again. The corrected tables and programs must show the claimed order.
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
    """The correction of a printed table.

    `id`: the first word of the title of its file, "/" and its name. `kind`: that of the claim.
    `changes`: the new texts of entries, by key, row and column, counted from 1, as "a.3.2".
    """

    id: Text
    kind: Text
    changes: dict[str, str] = Field(default_factory=dict)


class Description(Frozen):
    """A mistake as a person has described it: where it is, what holds instead, and its correction.

    `claims`: the ids of the refuted claims, with * for any text. `program`: shows the mistake, in
    the library's `language`; `mended`: the same with the correction. `ran`: who has run it and
    when, if it cannot be run here.
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
        """Return True if it concerns the claim of that id."""
        return any(fnmatchcase(_plain(claim), _plain(pattern)) for pattern in self.claims)


def _plain(text: str) -> str:
    """Replace square brackets, which have a meaning of their own in a pattern."""
    return text.replace("[", "(").replace("]", ")")


def folder() -> Path:
    """Return the folder of the descriptions."""
    return Path(content("reports", "audits", "findings"))


def descriptions() -> dict[str, Description]:
    """Read all descriptions, by name. Raises InputError for a file that is no description."""
    return {path.stem: read(path) for path in sorted(folder().glob("*.toml"))}


def read(path: Path) -> Description:
    """Read one description. Raises InputError, which names the file."""
    try:
        return Description.model_validate(read_toml(path))
    except ValidationError as error:
        problem = describe_first_error(error, f"finding {path.stem}", Description)
        raise problem from None


RIGHT_TIMES = "right"


def entry_of(name: str) -> TableEntry:
    """Return the printed table of that id. Raises InputError if there is none."""
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
    """Return the table with these entries changed. Raises InputError for a key that it lacks."""
    data = entry.model_dump(exclude_unset=True)
    for key, value in changes.items():
        if key == "times" and value == RIGHT_TIMES:
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
    """Return the right time of each part: the sum of the earlier parts of the other kind."""
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


_PROGRAM_SECONDS = 300.0
_PRINTED_ORDER = re.compile(r"^order on (.+): (-?\d+\.\d+)$", re.MULTILINE)
_ORDER_TOLERANCE = 0.3  # a correction raises a printed order by 1, less this number, at least


@dataclass(frozen=True)
class ProgramOutput:
    """The output of a program, and the orders that it prints, by problem.

    `failed`: the reason of a failure, "" if it has ended well.
    """

    printed: str
    orders: dict[str, float]
    failed: str = ""


@dataclass(frozen=True)
class TableEvidence:
    """One table: its claimed order, and the convergence as printed and with the correction."""

    name: str
    claimed: int
    printed: tuple[SystemConvergence, ...]
    mended: tuple[SystemConvergence, ...] = ()


@dataclass(frozen=True)
class ConfirmedFinding:
    """A confirmed finding: the description, the refuted claims, and the results of what was run."""

    name: str
    described: Description
    claims: tuple[ClaimResult, ...]
    tables: tuple[TableEvidence, ...] = ()
    program: ProgramOutput | None = None
    mended: ProgramOutput | None = None


class NotConfirmedError(Exception):
    """The reason why a mistake is not reported, one clause."""


def confirm(name: str, described: Description, claims: Sequence[ClaimResult]) -> ConfirmedFinding:
    """Confirm a mistake on the claims that were judged in this run.

    Raises NotConfirmedError if a claim that it concerns is not refuted, if a table or a program
    does not show it, or if the correction does not help.
    """
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
        or any(x.is_below(claimed) for x in mended)
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
        printed_order = program.orders.get(problem)
        if printed_order is None or order < printed_order + 1 - _ORDER_TOLERANCE:
            raise NotConfirmedError(f"the mend does not raise the order on {problem}")


# -- a program in Python, where its library is installed ------------------------------------------


def run(program: str) -> ProgramOutput:
    """Run the lines of a Python program in a process; return its output."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "program.py"
        path.write_text(program, encoding="utf-8")
        try:
            process = subprocess.run(  # noqa: S603 - the program is ours, beside the descriptions
                [sys.executable, str(path)],
                capture_output=True,
                text=True,
                timeout=_PROGRAM_SECONDS,
                cwd=folder,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return ProgramOutput("", {}, f"does not end within {_PROGRAM_SECONDS:.0f} s")
    orders = {name: float(order) for name, order in _PRINTED_ORDER.findall(process.stdout)}
    last = process.stderr.strip().splitlines()[-1:] if process.returncode else []
    return ProgramOutput(process.stdout.strip(), orders, " ".join(last))
