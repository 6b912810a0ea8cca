"""Splittings for every H = T(p) + V(q): kicks and drifts in turn."""

from collections.abc import Iterator

from verify.integrators.tables.splittings.claims import AlternatingEntry, of_alternating
from verify.integrators.tables.told import TableClaim


class Entry(AlternatingEntry):
    """See `AlternatingEntry`."""


def claims(entry: Entry) -> Iterator[TableClaim]:
    """Of the order, in time, of digits, symplectic, symmetric."""
    yield from of_alternating(entry)
