"""Theorems of papers in words: each with a verdict, a proof that can be quoted, and its checks.

A function that returns an `Argument`, and computes the checks on which it rests, is a theorem under
its name: `eq_9` is `eq-9`. Theorems are discovered automatically: adding one is adding a function.
"""

from collections.abc import Callable, Mapping
from functools import cache
from inspect import isfunction

from verify.discovery import Catalogue
from verify.errors import unknown_name
from verify.papers.argument import Argument

__all__ = ["Argument", "check_theorem", "names"]

_FILES = Catalogue(__name__, __path__)


@cache
def _functions() -> Mapping[str, Callable[[], Argument]]:
    functions: dict[str, Callable[[], Argument]] = {}
    for module in map(_FILES.module, _FILES.names):
        for name, function in vars(module).items():
            # Imported functions are skipped: a theorem counts in the module that defines it, once.
            is_local = isfunction(function) and function.__module__ == module.__name__
            if is_local and name[0] != "_" and function.__annotations__.get("return") is Argument:
                functions[name.replace("_", "-")] = function
    return functions


def names() -> tuple[str, ...]:
    """Return the names of all theorems."""
    return tuple(_functions())


@cache
def check_theorem(name: str) -> Argument:
    """Return the argument for the theorem of that name; InputError if there is none."""
    if name not in _functions():
        raise unknown_name("theorem", name, names())
    return _functions()[name]()
