"""The elementary functions that a formula may have: `elementary/` has one a file.

A file of `elementary/` defines `FUNCTION`, all that any other room needs of that function: algebra,
every number system, kernels, traced code, pages.
"""

from functools import cache

from verify.discovery import Catalogue
from verify.functions.function import Function

_FILES = Catalogue(f"{__name__}.elementary", [f"{folder}/elementary" for folder in __path__])


def names() -> tuple[str, ...]:
    """Return the names of all functions, as formulas have them, in alphabetical order."""
    return _FILES.names


@cache
def by_name() -> dict[str, Function]:
    """Return all functions by their names."""
    return {name: _FILES.module(name).FUNCTION for name in names()}


@cache
def in_rings() -> dict[str, Function]:
    """Return the functions that a ring has generators of, and so a kernel calls: the others are
    made of them."""
    return {name: function for name, function in by_name().items() if function.image is not None}
