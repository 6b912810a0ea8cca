"""The named systems, one file each with a `SYSTEM`, found by themselves.

`double_well.py` has the system `double-well`. Adding a system is adding one file.
"""

from typing import TYPE_CHECKING

from verify.discovery import Catalogue
from verify.errors import InputError

if TYPE_CHECKING:
    from verify.hamiltonians.named_system import System

_FILES = Catalogue(__name__, __path__)


def names() -> tuple[str, ...]:
    """The names of all systems."""
    return _FILES.names


def all_systems() -> "dict[str, System]":
    """Every named system by its name."""
    return {name: get(name) for name in names()}


def get(name: str) -> "System":
    """The system of that name; InputError where there is none."""
    if name not in _FILES:
        raise InputError("system", name, f"unknown; allowed: {', '.join(names())}")
    system: System = _FILES.module(name).SYSTEM
    return system
