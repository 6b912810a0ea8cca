"""Rows of tables, and what a cell of one is."""

from typing import Any

Row = tuple[str, ...]


def cell(value: Any) -> str:
    """The text of a value; empty for None."""
    if value is None:
        return ""
    return str(value).lower() if isinstance(value, bool) else str(value)
