"""A table of numbers in a text file, line by line: CSV with commas, semicolons, tabs or spaces.

The first line names the columns, and may begin with #; other lines that do are comments. A file may
be corrupt or hostile: what cannot be read is one InputError that names the line, and no more than a
line is held.
"""

import csv
import io
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from verify import files
from verify.errors import InputError

_LONGEST_LINE = 2**16
_MOST_COLUMNS = 500


@contextmanager
def opened(path: Path) -> Iterator["Table"]:
    """The table in a file. InputError where it is no file, or cannot be read."""
    with files.opened(path) as file:
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
        if _numbers(self.header):
            raise self.error("is no header: the first line must name the columns")

    def error(self, problem: str) -> InputError:
        """What is wrong with the line that was read last."""
        return InputError("file", self.name, f"line {self.line} {problem}")

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
        """Line by line, none of which may be very long."""
        while True:
            try:
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


def _numbers(cells: tuple[str, ...]) -> bool:
    try:
        [float(cell) for cell in cells]
    except ValueError:
        return False
    return True
