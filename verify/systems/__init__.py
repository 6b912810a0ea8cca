"""The named systems, one file each with a `SYSTEM`, found by themselves."""

import pkgutil
from functools import cache
from importlib import import_module

from verify.errors import InputError
from verify.system import System


@cache
def all_systems() -> dict[str, System]:
    """Every named system by its name."""
    modules = (import_module(f"{__name__}.{m.name}") for m in pkgutil.iter_modules(__path__))
    systems: list[System] = [module.SYSTEM for module in modules]
    return {s.name: s for s in sorted(systems, key=lambda s: s.name)}


def get(name: str) -> System:
    """The system of that name; InputError where there is none."""
    if name not in all_systems():
        raise InputError("system", name, f"unknown; allowed: {', '.join(all_systems())}")
    return all_systems()[name]
