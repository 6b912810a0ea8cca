"""Files that may be corrupt or hostile → JSON and tables, or one InputError that tells the mistake.

Nothing is read that is larger than `MOST_BYTES`, and no JSON that would become very many objects. A
table is CSV or, if pyarrow is installed, Parquet with a text in each cell, as in CSV; Parquet is
written here, too.

A user's table of any size is read line by line: CSV with commas, semicolons, tabs or spaces. The
first line names the columns, and may begin with #; other lines that do are comments. An InputError
names the line, and no more than a line is held.
"""

import csv
import io
import json
import re
from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from importlib.util import find_spec
from pathlib import Path
from typing import IO, Any

from verify.arithmetic.exact import rational
from verify.errors import NOT_GIVEN, InputError
from verify.files import MOST_BYTES, open_regular_file, text_of
from verify.formats import reject_repeated_keys
from verify.reference.make.row_values import Row

MOST_CELLS = 8 * 2**20  # or commas and brackets, each about an object of Python's
_MOST_OPEN = 2**21
_HALF = re.compile(r"(?<!\\)(?:\\\\)*\\u[dD][89a-fA-F]")  # a surrogate, which no UTF-8 text has


def json_of(content: bytes, name: str) -> Any:
    """Return the JSON in it, in which no number is a float. InputError for what is not such
    JSON."""
    # Counted before parsing: a few megabytes of brackets would become gigabytes of Python objects.
    opened = content.count(b"[") + content.count(b"{")
    if opened > _MOST_OPEN or opened + content.count(b",") > MOST_CELLS:
        raise InputError("file", name, "has too many parts")
    text = text_of(content, name)
    if _HALF.search(text):
        raise InputError("file", name, "is not JSON in UTF-8: it has half a character, as \\ud800")
    try:
        return json.loads(
            text,
            object_pairs_hook=reject_repeated_keys,
            parse_float=_no_float,
            parse_constant=_no_float,
        )
    except RecursionError:
        raise InputError("file", name, "is nested too deep") from None
    except InputError:
        raise
    except ValueError as error:  # JSONDecodeError is one, and so is an integer of too many digits
        raise InputError("file", name, f"is not JSON: {error}") from None


def _no_float(text: str) -> None:
    raise ValueError(f"{text[:20]} is no number that these files have")


def rows_of(content: bytes, name: str) -> list[tuple[str, ...]]:
    """Return the rows of a CSV file. InputError for what is not CSV."""
    source = text_of(content, name)
    if content.count(b",") > MOST_CELLS or content.count(b"\n") > MOST_CELLS:
        raise InputError("file", name, "has too many cells")
    try:
        return [tuple(row) for row in csv.reader(io.StringIO(source, newline=""), strict=True)]
    except csv.Error as error:
        raise InputError("file", name, f"is not CSV: {error}") from None


# -- Parquet --------------------------------------------------------------------------------------


def has_pyarrow() -> bool:
    """Return True if pyarrow is installed."""
    return find_spec("pyarrow") is not None


def require_pyarrow() -> None:
    """Raise InputError if pyarrow is not installed."""
    if not has_pyarrow():
        raise InputError(
            "--parquet", NOT_GIVEN, "pyarrow is not installed; the extra `parquet` has it"
        )


def parquet_bytes(rows: list[Row]) -> bytes:
    """Return the file of a table, whose first row names the columns."""
    import pyarrow
    from pyarrow import parquet

    names, *content = rows
    columns = list(zip(*content, strict=True)) or [()] * len(names)
    arrays = [pyarrow.array(column, pyarrow.string()) for column in columns]
    stream = io.BytesIO()
    parquet.write_table(pyarrow.table(arrays, names=list(names)), stream, compression="zstd")
    return stream.getvalue()


def parquet_rows(content: bytes, name: str) -> list[Row]:
    """Return the table again. Raises InputError if the content is no such file, or would be
    very large."""
    import pyarrow

    try:
        names, columns = _read_columns(content)
    except (pyarrow.ArrowException, OSError, ValueError, MemoryError) as error:
        raise InputError("file", name, f"is not Parquet as it should be: {error}") from None
    return [tuple(names), *zip(*columns, strict=True)]


def _read_columns(content: bytes) -> tuple[list[str], list[list[str]]]:
    """Return names and cells of the columns. ValueError if they are no texts, or too long ones.

    A few bytes may stand for very many cells, or for one long text in all of them: so columns are
    read as dictionaries, and their size is computed before they are expanded.
    """
    import pyarrow.compute
    from pyarrow import parquet

    metadata = parquet.read_metadata(io.BytesIO(content))
    kinds = [metadata.schema.column(k) for k in range(metadata.num_columns)]
    # A column of lists or structures has a path of several names.
    if any(x.logical_type.type != "STRING" or x.path != x.name for x in kinds):
        raise ValueError("a column is no text")
    # The sizes in the metadata are claims of the file; they are checked again on the columns that
    # were read.
    groups = [metadata.row_group(k).total_byte_size for k in range(metadata.num_row_groups)]
    if sum(groups) > MOST_BYTES or metadata.num_rows * metadata.num_columns > MOST_CELLS:
        raise ValueError("too many cells")
    names = [x.name for x in kinds]
    if len(set(names)) < len(names):
        raise ValueError("a column stands twice")
    table = parquet.ParquetFile(io.BytesIO(content), read_dictionary=names).read()
    for chunk in (chunk for column in table.columns for chunk in column.chunks):
        longest = pyarrow.compute.max(pyarrow.compute.binary_length(chunk.dictionary)).as_py()
        if (longest or 0) * metadata.num_rows > MOST_BYTES:
            raise ValueError("too long cells")
    return names, [[_text(x) for x in column.to_pylist()] for column in table.columns]


def _text(x: object) -> str:
    return x if isinstance(x, str) else repr(x)


# -- a table line by line -------------------------------------------------------------------------

_LONGEST_LINE = 2**16
_MOST_COLUMNS = 500


@contextmanager
def open_table(path: Path) -> Iterator["CellLines"]:
    """Open the table in a file. Raises InputError if it is no file, or cannot be read."""
    with open_regular_file(path) as file:
        yield CellLines(io.TextIOWrapper(file, encoding="utf-8-sig", newline=""), path.name)


class CellLines:
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
