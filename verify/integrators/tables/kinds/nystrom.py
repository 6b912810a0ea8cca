"""Splittings for every H = p·M⁻¹p/2 + V(q): with fewer conditions, for T is quadratic."""

from collections.abc import Iterator

from verify.integrators.tables.splittings.claims import AlternatingEntry, of_alternating
from verify.integrators.tables.told import TableClaim


class Entry(AlternatingEntry):
    """See `AlternatingEntry`."""


def claims(entry: Entry) -> Iterator[TableClaim]:
    """Of the order, in time, of digits, symplectic, symmetric."""
    yield from of_alternating(entry)
