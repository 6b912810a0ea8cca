"""The differences that a check finds: a place in the files, what should stand there, and what does.

Texts and tables are compared here, too.
"""

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from itertools import zip_longest

from verify.errors import without_controls
from verify.files import text_of
from verify.reference.make.data_files import csv_text
from verify.reference.make.file_contents import rows_of
from verify.reference.make.row_values import Row

_MOST_SHOWN = 120


@dataclass(frozen=True)
class FileDifference:
    """A place in a file where `found` stands and the check expects `wanted`."""

    file: str
    row: str
    column: str
    wanted: str
    found: str

    def __str__(self) -> str:
        place = ": ".join(filter(None, map(without_controls, (self.file, self.row, self.column))))
        return f"{place}: should be {_short(self.wanted)}, is {_short(self.found)}"

    def as_json(self) -> dict[str, str]:
        """Return the same for JSON, with marks for bytes in a file's name that are not UTF-8."""
        return {k: v.encode(errors="replace").decode() for k, v in asdict(self).items()}


def _short(text: str) -> str:
    shortened = text if len(text) <= _MOST_SHOWN else f"{text[:_MOST_SHOWN]}…"
    return without_controls(shortened) or "nothing"


@dataclass
class DataFindings:
    """The findings of a check: the number of rows `recomputed`, the differences, and what could not
    be recomputed, with the reason."""

    recomputed: int = 0
    differences: list[FileDifference] = field(default_factory=list)
    not_recomputed: list[str] = field(default_factory=list)

    def add(self, findings: "DataFindings") -> None:
        """Add the findings of another check to these."""
        self.recomputed += findings.recomputed
        self.differences += findings.differences
        self.not_recomputed += findings.not_recomputed


@dataclass(frozen=True)
class DataPlace:
    """A file, or a row of it; differences in it are added to `findings`."""

    findings: DataFindings
    file: str
    row: str = ""

    def at_row(self, row: str) -> "DataPlace":
        """Return the place of a row of the file."""
        return DataPlace(self.findings, self.file, row)

    def require(self, holds: object, column: str, expected: str, actual: str) -> None:
        """Add a difference unless `right` is true."""
        if not holds:
            self.differs(column, expected, actual)

    def differs(self, column: str, expected: str, actual: str) -> None:
        """Add a difference."""
        self.findings.differences.append(
            FileDifference(self.file, self.row, column, expected, actual)
        )

    def is_left_out(self, reason: object) -> None:
        """Note that the row is not recomputed, and why."""
        self.findings.not_recomputed.append(f"{self.file}: {self.row}: {reason}")


# -- the same in another form ---------------------------------------------------------------------


def compare_tables(expected: Sequence[Row], actual: Sequence[Row], file: DataPlace) -> None:
    """Report cells of a table that differ from the scene's JSON, up to a line of another length."""
    names = expected[0]
    for k, (expected_row, actual_row) in enumerate(zip_longest(expected, actual), start=1):
        if expected_row == actual_row:
            continue
        line = file.at_row(f"line {k}")
        if expected_row is None or actual_row is None or len(expected_row) != len(actual_row):
            line.differs("", _join_cells(expected_row), _join_cells(actual_row))
            return
        for name, expected_cell, actual_cell in zip(names, expected_row, actual_row, strict=True):
            line.require(expected_cell == actual_cell, name, expected_cell, actual_cell)


def _join_cells(row: Row | None) -> str:
    return "no line" if row is None else ",".join(row)


def compare_texts(expected: str, actual: str, file: DataPlace) -> None:
    """Report the first line in which two texts differ."""
    if expected == actual:
        return
    lines = zip_longest(expected.split("\n"), actual.split("\n"))
    k, (expected_line, actual_line) = next(
        (k, pair) for k, pair in enumerate(lines, 1) if pair[0] != pair[1]
    )
    pairs = enumerate(zip(expected_line or "", actual_line or "", strict=False))
    shorter = min(len(expected_line or ""), len(actual_line or ""))
    column = next((i for i, (a, b) in pairs if a != b), shorter)
    cut = max(0, column - 40)
    excerpts = (
        repr(x[cut : column + 40]) if x is not None else "no line"
        for x in (expected_line, actual_line)
    )
    file.at_row(f"line {k}").differs(f"character {column + 1}", *excerpts)


def compare_csv(expected: Sequence[Row], content: bytes, file: DataPlace) -> None:
    """Compare a CSV file with the scene's JSON, cell by cell, then character by character.

    Raises InputError if it is not CSV.
    """
    before = len(file.findings.differences)
    compare_tables(expected, rows_of(content, file.file), file)
    if len(file.findings.differences) == before:
        compare_texts(csv_text(list(expected)), text_of(content, file.file), file)
