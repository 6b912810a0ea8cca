"""Arithmetic: exact rationals and balls; `systems/` has one file for each number system.

A file of `systems/` defines `NUMBER_SYSTEM`, the description that is read before the system
computes; its library is imported only when it computes. To add a number system, add one file.
"""

from functools import cache
from typing import TYPE_CHECKING

from verify.discovery import Catalogue
from verify.errors import unknown_name

if TYPE_CHECKING:
    from verify.arithmetic.number_system import Arithmetic, NumberSystem

AUTO = "auto"  # the fastest number system that certifies the digits
ALIASES = {  # names that others use → the names here
    **dict.fromkeys(("double", "float", "binary64"), "float64"),
    **dict.fromkeys(("quad", "float128", "bigfloat", "multiprecision"), "mpfr"),
    **dict.fromkeys(("interval", "arb"), "ball"),
    "decimal": "mpmath",
}
_FILES = Catalogue(f"{__name__}.systems", [f"{folder}/systems" for folder in __path__])


def names() -> tuple[str, ...]:
    """Return the names of all number systems."""
    return _FILES.names


def get(name: str, digits: int) -> "Arithmetic":
    """Return the arithmetic of that name with at least `digits` decimal digits (float64 has its
    own).

    Raises InputError if there is none of that name.
    """
    return about(name).make(digits)


def about(name: str) -> "NumberSystem":
    """Return the description of the number system of that name; no library is imported.

    Raises InputError if there is none of that name.

    >>> about("float64").digits, about("mpfr").digits
    (17, None)
    """
    if name not in _FILES:
        raise unknown_name("arithmetic", name, (AUTO, *names()), aliases=ALIASES)
    system: NumberSystem = _FILES.module(name).NUMBER_SYSTEM
    return system


@cache
def automatic() -> "tuple[NumberSystem, ...]":
    """Return the number systems that `auto` tries, the fastest first; the last has every range
    and function."""
    systems = (about(name) for name in names())
    return tuple(sorted((x for x in systems if x.automatic), key=lambda x: x.cost))


def step_cost(name: str) -> int:
    """Return about how many steps of float64 take as long as one step of the number system.

    For `auto` it is the system that `auto` tries first.
    """
    return _first(name).cost


def in_lanes(name: str) -> bool:
    """Return True if the number system steps several orbits together.

    For `auto` it is the system that `auto` tries first.
    """
    return _first(name).in_lanes


def _first(name: str) -> "NumberSystem":
    return automatic()[0] if name == AUTO else about(name)
