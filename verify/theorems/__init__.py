"""The paper's theorems in words: each with a verdict, a proof that can be quoted, and its checks.

A file defines `THEOREMS`, its functions by name; each computes what its argument rests on, and
returns an `Argument`. They are found by themselves: adding a theorem is adding a function.
"""

import pkgutil
from collections.abc import Callable, Mapping
from functools import cache
from importlib import import_module

from verify.errors import InputError
from verify.theorems.argument import Argument

__all__ = ["Argument", "check_theorem", "names"]


@cache
def _functions() -> Mapping[str, Callable[[], Argument]]:
    found: dict[str, Callable[[], Argument]] = {}
    for module in sorted(m.name for m in pkgutil.iter_modules(__path__)):
        found.update(getattr(import_module(f"{__name__}.{module}"), "THEOREMS", {}))
    return found


def names() -> tuple[str, ...]:
    """The names of all theorems."""
    return tuple(_functions())


@cache
def check_theorem(name: str) -> Argument:
    """The argument for the theorem of that name; InputError where there is none."""
    if name not in _functions():
        raise InputError("theorem", name, f"unknown; allowed: {', '.join(names())}")
    return _functions()[name]()
