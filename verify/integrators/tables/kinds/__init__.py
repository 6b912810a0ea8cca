"""Kinds of tables, one a file, found by itself: what is written of one, and what it claims.

A file has `ENTRY`, a model of the keys, and `claims(entry)`, which yields a
`verify.integrators.tables.table_claim.TableClaim` for each.
"""

from types import ModuleType

from verify.discovery import Catalogue

CATALOGUE = Catalogue(__name__, __path__)


def names() -> tuple[str, ...]:
    """Return the names of all kinds."""
    return CATALOGUE.names


def get(name: str) -> ModuleType:
    """Return the module of a kind. Raises KeyError where there is none."""
    module: ModuleType = CATALOGUE.module(name)
    return module
