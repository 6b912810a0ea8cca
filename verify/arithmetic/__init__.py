"""Arithmetic: exact rationals, balls; `systems/` has one number system a file.

A file of `systems/` defines `NAME` and `make(digits)`, the arithmetic that works with at least that
many decimal digits. Adding a number system is adding one file.
"""

from typing import TYPE_CHECKING

from verify.discovery import Catalogue
from verify.errors import InputError

if TYPE_CHECKING:
    from verify.arithmetic.number_system import Arithmetic

_FILES = Catalogue(f"{__name__}.systems", [f"{folder}/systems" for folder in __path__])


def names() -> tuple[str, ...]:
    """The names of all number systems."""
    return _FILES.names


def get(name: str, digits: int) -> "Arithmetic":
    """The arithmetic of that name with at least `digits` decimal digits (float64 has its own).

    Raises InputError where there is none of that name.
    """
    if name not in _FILES:
        raise InputError("arithmetic", name, f"unknown; allowed: {', '.join(names())}")
    arithmetic: Arithmetic = _FILES.module(name).make(digits)
    return arithmetic
