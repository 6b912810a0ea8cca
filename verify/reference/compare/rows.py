"""What a table of somebody's numbers is made of: which column is which, a row's numbers, its step,
and the rows of each run that are kept.
"""

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from verify.arithmetic.exact import rational
from verify.errors import InputError, unknown, without_controls
from verify.reference.compare.published import PublishedRun
from verify.reference.compare.table import Table

_SHOWN = 60  # characters of a text
_SAME_NUMBER = Fraction(1, 10**6)  # of a step, by which N·h may miss a time
_WHOLE = re.compile(r"[0-9]{1,40}")
COUNTED = ("step", "time")
_ALIASES = {
    "step": ("n", "k", "i", "index", "steps"),
    "time": ("t",),
    "step_size": ("h", "dt"),
    "delta_j": ("Δj", "dj", "deltaj", "delta-j"),
    "lambda": ("λ", "lam"),
}


@dataclass(frozen=True)
class Row:
    """A row of theirs: where it stands, and the texts of its values."""

    line: int
    cells: dict[str, str]


@dataclass
class Theirs:
    """What of a table is in the reference data. `rows`: of the table; `runs`: by run and step.

    `other_steps`: rows of runs that the reference data have, though not at that step. `outside`:
    rows of other runs, of which `first_outside` is one.
    `ignored`: columns that mean nothing here. `read_as`: inputs that are not written exactly as
    ours are, though they are the same double: theirs, ours.
    """

    columns: tuple[str, ...] = ()
    ignored: tuple[str, ...] = ()
    rows: int = 0
    other_steps: int = 0
    outside: int = 0
    first_outside: str = ""
    runs: dict[str, tuple[PublishedRun, dict[int, Row]]] = field(default_factory=dict)
    read_as: dict[str, tuple[Fraction, Fraction]] = field(default_factory=dict)

    def keep(self, run: PublishedRun, step: int, row: Row, lines: Table) -> None:
        """Takes up a row; InputError where another one of this step says something else."""
        rows = self.runs.setdefault(run.label, (run, {}))[1]
        before = rows.setdefault(step, row)
        if before.cells != row.cells:
            raise lines.error(f"says of step {step} of {run.label} other than line {before.line}")

    def kept(self) -> list[Row]:
        """All rows of all runs. InputError where there is none."""
        if not self.runs:
            steps = f"{self.other_steps} rows of other steps" if self.other_steps else "no rows"
            raise InputError("table", self.first_outside or steps, "has no row of these data")
        return [row for _, own in self.runs.values() for row in own.values()]


def places_of(
    lines: Table,
    names: Mapping[str, str],
    known: Collection[str],
    values: Collection[str],
    found: Theirs,
) -> dict[str, int]:
    """Where each `known` column stands; `names`: what the table calls a column, by ours. `found`
    gets the columns that are `values`, and those that mean nothing."""
    own_names = {alias: name for name, aliases in _ALIASES.items() for alias in aliases}
    own_names |= {name: name for name in known}
    for name, theirs in names.items():
        if name not in known:
            raise unknown("--column", name, known)
        if theirs not in lines.header:
            has = ", ".join(lines.header)
            raise InputError("--column", theirs, f"is no column of the table; it has: {has}")
    own = {theirs: name for name, theirs in names.items()}
    places: dict[str, int] = {}
    ignored = []
    for at, head in enumerate(lines.header):
        column = own.get(head) or own_names.get(head.casefold())
        means_nothing = column not in known or (column in own.values() and head not in own)
        if column is None or means_nothing:
            ignored.append(printable(head))
        elif column in places:
            raise lines.error(f"has two columns for {column}; --column {column}=… says which")
        else:
            places[column] = at
    if not any(name in places for name in values):
        raise lines.error(f"names no column of {', '.join(values)}; it has {_listed(lines.header)}")
    if not any(name in places for name in COUNTED):
        raise lines.error(f"names no column step or time; it has {_listed(lines.header)}")
    found.columns = tuple(name for name in values if name in places)
    found.ignored = tuple(ignored)
    return places


def step_of(
    lines: Table, row: list[str], places: Mapping[str, int], t0: Fraction, step_size: str
) -> int | None:
    """How many steps a row is of; None where its time is no multiple of the step size."""
    if "step" in places:
        text = row[places["step"]]
        if _WHOLE.fullmatch(text):
            return int(text)
        count = number_of(lines, text, "step")  # 1e3 and 1000.0 are whole numbers, too
        if count.denominator != 1:
            raise lines.error(f"has the step {text[:40]!r}, which is not a whole number")
        return int(count)
    count = (number_of(lines, row[places["time"]], "time") - t0) / rational(step_size)
    near = round(count)
    return near if abs(count - near) <= _SAME_NUMBER * max(1, abs(near)) else None


def number_of(lines: Table, text: str, name: str) -> Fraction:
    """The number that a cell is; InputError names the line."""
    try:
        return rational(text, name)
    except InputError as error:
        raise lines.error(f"has the {name} {text[:40]!r}: {error.problem}") from None


def printable(text: str) -> str:
    """A text of a file as it may be shown: short, and without control characters."""
    short = text if len(text) <= _SHOWN else text[: _SHOWN - 1] + "…"
    return without_controls(short)


def _listed(names: tuple[str, ...]) -> str:
    return ", ".join(names[:12]) + (", …" if len(names) > 12 else "")
