"""The tables as Parquet, where pyarrow is installed: every column a text, as in CSV."""

import io
from importlib.util import find_spec

from verify.errors import NOT_GIVEN, InputError
from verify.files import MOST_BYTES
from verify.reference.make.columns import Row
from verify.reference.make.reading import MOST_CELLS


def is_installed() -> bool:
    """Return True if pyarrow is installed."""
    return find_spec("pyarrow") is not None


def require() -> None:
    """Raise InputError where pyarrow is not installed."""
    if not is_installed():
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
    out = io.BytesIO()
    parquet.write_table(pyarrow.table(arrays, names=list(names)), out, compression="zstd")
    return out.getvalue()


def parquet_rows(content: bytes, name: str) -> list[Row]:
    """Return the table again. Raises InputError where the content is no such file, or would be
    very large."""
    import pyarrow

    try:
        names, columns = _read(content)
    except (pyarrow.ArrowException, OSError, ValueError, MemoryError) as error:
        raise InputError("file", name, f"is not Parquet as it should be: {error}") from None
    return [tuple(names), *zip(*columns, strict=True)]


def _read(content: bytes) -> tuple[list[str], list[list[str]]]:
    """Return names and cells of the columns. ValueError where they are no texts, or too long ones.

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
