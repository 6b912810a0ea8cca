"""A table of numbers in a text file, read line by line, and the rows of each run that are kept.

It is CSV with commas, semicolons, tabs or spaces.

The first line names the columns, and may begin with #; other lines that do are comments. A file may
be corrupt or hostile: what cannot be read is one InputError that names the line, and no more than a
line is held.
"""

import csv
import io
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import IO

from verify import files
from verify.arithmetic.exact import rational
from verify.errors import InputError
from verify.reference.compare.published import PublishedRun

_LONGEST_LINE = 2**16
_MOST_COLUMNS = 500


@contextmanager
def open_table(path: Path) -> Iterator["Table"]:
    """Open the table in a file. Raises InputError where it is no file, or cannot be read."""
    with files.open_regular_file(path) as file:
        yield Table(io.TextIOWrapper(file, encoding="utf-8-sig", newline=""), path.name)


class Table:
    """A file's lines as cells; `header` is the first, `line` the number of the last one read."""

    def __init__(self, file: IO[str], name: str) -> None:
        self.name, self.line, self._file = name, 0, file
        head = self._head()
        mark = next((mark for mark in (",", ";", "\t") if mark in head), " ")
        self._cells = csv.reader(
            self._texts(), delimiter=mark, skipinitialspace=mark == " ", strict=True
        )
        first = next(csv.reader([head], delimiter=mark, skipinitialspace=True))
        self.header = tuple(cell.strip() for cell in first if cell.strip() or mark != " ")
        self.width = len(self.header)
        if self.width > _MOST_COLUMNS:
            raise self.error(f"has {self.width} columns; allowed: {_MOST_COLUMNS}")
        if _are_numbers(self.header):
            raise self.error("is no header: the first line must name the columns")

    def error(self, problem: str) -> InputError:
        """Return an error that names the line read last."""
        return InputError("file", self.name, f"line {self.line} {problem}")

    def number(self, text: str, name: str) -> Fraction:
        """Return the number in a cell; InputError names the line."""
        try:
            return rational(text, name)
        except InputError as error:
            raise self.error(f"has the {name} {text[:40]!r}: {error.problem}") from None

    def __iter__(self) -> Iterator[list[str]]:
        try:
            for row in self._cells:
                if row and not (row[0].startswith("#")):
                    if len(row) < self.width:
                        raise self.error(f"has {len(row)} cells, and the header {self.width}")
                    yield row
        except csv.Error as error:
            raise self.error(f"is not CSV: {error}") from None

    def _head(self) -> str:
        for text in self._texts():
            head = text.strip().lstrip("#").strip()
            if head:
                return head
        raise InputError("file", self.name, "is empty")

    def _texts(self) -> Iterator[str]:
        """Yield line by line; none may be very long."""
        while True:
            try:
                # A file without line ends must not be read as a whole.
                text = self._file.readline(_LONGEST_LINE)
            except UnicodeDecodeError:
                self.line += 1
                raise self.error("or one soon after it is not UTF-8 text") from None
            if not text:
                return
            self.line += 1
            if len(text) == _LONGEST_LINE and not text.endswith("\n"):
                raise self.error(f"has more than {_LONGEST_LINE} characters")
            if "\0" in text:
                raise self.error("has a NUL: this is no text file")
            yield text


def _are_numbers(cells: tuple[str, ...]) -> bool:
    try:
        [float(cell) for cell in cells]
    except ValueError:
        return False
    return True


@dataclass(frozen=True)
class Row:
    """A row of theirs: where it stands, and the texts of its values."""

    line: int
    cells: dict[str, str]


@dataclass
class SubmittedTable:
    """The part of a table that is in the reference data. `rows`: of the table; `runs`: by run and
    step.

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
        """Add a row; InputError where another one of this step differs."""
        rows = self.runs.setdefault(run.label, (run, {}))[1]
        before = rows.setdefault(step, row)
        if before.cells != row.cells:
            raise lines.error(f"says of step {step} of {run.label} other than line {before.line}")

    def all_rows(self) -> list[Row]:
        """Return all rows of all runs. Raises InputError where there is none."""
        if not self.runs:
            steps = f"{self.other_steps} rows of other steps" if self.other_steps else "no rows"
            raise InputError("table", self.first_outside or steps, "has no row of these data")
        return [row for _, rows in self.runs.values() for row in rows.values()]
