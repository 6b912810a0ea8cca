"""The number systems, one file each, found by themselves.

A file defines `NAME` and `make(digits)`, the arithmetic that works with at least that many decimal
digits. Adding a number system is adding one file.
"""

import pkgutil
from functools import cache
from importlib import import_module

from verify.errors import InputError
from verify.number_system import Arithmetic


@cache
def names() -> tuple[str, ...]:
    return tuple(sorted(m.name for m in pkgutil.iter_modules(__path__)))


def get(name: str, digits: int) -> Arithmetic:
    """The arithmetic of that name with at least `digits` decimal digits (float64 has its own)."""
    if name not in names():
        raise InputError("arithmetic", name, f"unknown; allowed: {', '.join(names())}")
    made: Arithmetic = import_module(f"{__name__}.{name}").make(digits)
    return made
