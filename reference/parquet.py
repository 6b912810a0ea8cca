"""The tables as Parquet, where pyarrow is installed: every column a text, as in CSV."""

import io
from importlib.util import find_spec

from reference.writing import Row
from verify.errors import InputError


def installed() -> bool:
    return find_spec("pyarrow") is not None


def require() -> None:
    """InputError where pyarrow is not installed."""
    if not installed():
        raise InputError("--parquet", "", "pyarrow is not installed; the extra `parquet` has it")


def parquet_bytes(rows: list[Row]) -> bytes:
    import pyarrow
    from pyarrow import parquet

    names, *content = rows
    columns = list(zip(*content, strict=True)) or [()] * len(names)
    arrays = [pyarrow.array(column, pyarrow.string()) for column in columns]
    out = io.BytesIO()
    parquet.write_table(pyarrow.table(arrays, names=list(names)), out, compression="zstd")
    return out.getvalue()


def parquet_rows(content: bytes) -> list[Row]:
    """The table again. InputError where that is no Parquet file."""
    import pyarrow
    from pyarrow import parquet

    try:
        table = parquet.read_table(io.BytesIO(content))
    except (pyarrow.ArrowException, OSError) as error:
        raise InputError("parquet", "", f"cannot be read: {error}") from None
    columns = [[_text(x) for x in table[name].to_pylist()] for name in table.column_names]
    return [tuple(table.column_names), *zip(*columns, strict=True)]


def _text(x: object) -> str:
    return x if isinstance(x, str) else repr(x)
