"""Theorems of papers in words: each with a verdict, a proof that can be quoted, and its checks.

A function that returns an `Argument`, and computes what that rests on, is a theorem by its name:
`eq_9` is `eq-9`. They are found by themselves: adding a theorem is adding a function.
"""

from collections.abc import Callable, Mapping
from functools import cache
from inspect import isfunction

from verify.discovery import Catalogue
from verify.errors import unknown
from verify.papers.argument import Argument

__all__ = ["Argument", "check_theorem", "names"]

_FILES = Catalogue(__name__, __path__)


@cache
def _functions() -> Mapping[str, Callable[[], Argument]]:
    found: dict[str, Callable[[], Argument]] = {}
    for module in map(_FILES.module, _FILES.names):
        for name, function in vars(module).items():
            own = isfunction(function) and function.__module__ == module.__name__
            if own and name[0] != "_" and function.__annotations__.get("return") is Argument:
                found[name.replace("_", "-")] = function
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
