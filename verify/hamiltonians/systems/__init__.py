"""The named systems, one file each with a `SYSTEM`, found by themselves.

`double_well.py` has the system `double-well`. Adding a system is adding one file.
"""

import re
from functools import cache
from typing import TYPE_CHECKING

from verify.discovery import Catalogue
from verify.errors import InputError, plain_name, unknown_name

if TYPE_CHECKING:
    from collections.abc import Mapping

    from verify.hamiltonians.named_system import System

_FILES = Catalogue(__name__, __path__)


def names() -> tuple[str, ...]:
    """Return the names of all systems."""
    return _FILES.names


@cache
def all_systems(degrees: int | None = 1) -> "Mapping[str, System]":
    """Return the named systems by their names: those of so many degrees of freedom, or with None
    all.

    Cached: every search for a known flow goes through them.
    """
    systems = {name: get(name) for name in names()}
    return {n: x for n, x in systems.items() if degrees is None or x.degrees == degrees}


def canonical(name: str) -> str:
    """Return the system's name, given in any case and with spaces; the name itself where there is
    none."""
    plain = plain_name(name) if isinstance(name, str) else name
    return plain if plain in _FILES else name


def check_is_formula(text: str) -> None:
    """Raise InputError where a formula is expected, and the text is a system's name."""
    name = canonical(text)
    if name in _FILES:
        write = f'write system = "{name}" in a scene, or --system {name}'
        raise InputError("hamiltonian", text, f"is no formula but a system; {write}")


def get(name: str) -> "System":
    """Return the system of that name; InputError where there is none."""
    name = canonical(name)
    if name not in _FILES:
        more = "; a formula goes with --hamiltonian" if re.search(r"[*^+/()=]", str(name)) else ""
        raise unknown_name("system", name, names(), more)
    system: System = _FILES.module(name).SYSTEM
    return system
