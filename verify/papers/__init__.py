"""Theorems of papers in words: each with a verdict, a proof that can be quoted, and its checks.

A file defines `THEOREMS`, its functions by name; each computes what its argument rests on, and
returns an `Argument`. They are found by themselves: adding a theorem is adding a function.
"""

from collections.abc import Callable, Mapping
from functools import cache

from verify.discovery import Catalogue
from verify.errors import unknown
from verify.papers.argument import Argument

__all__ = ["Argument", "check_theorem", "names"]

_FILES = Catalogue(__name__, __path__)


@cache
def _functions() -> Mapping[str, Callable[[], Argument]]:
    found: dict[str, Callable[[], Argument]] = {}
    for file in _FILES.names:
        found.update(getattr(_FILES.module(file), "THEOREMS", {}))
    return found


def names() -> tuple[str, ...]:
    """The names of all theorems."""
    return tuple(_functions())


@cache
def check_theorem(name: str) -> Argument:
    """The argument for the theorem of that name; InputError where there is none."""
    if name not in _functions():
        raise unknown("theorem", name, names())
    return _functions()[name]()
