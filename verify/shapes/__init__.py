"""The named shapes, one file each with a `SHAPE`, found by themselves."""

import pkgutil
from functools import cache
from importlib import import_module

from verify.errors import InputError
from verify.outline import Shape


@cache
def all_shapes() -> dict[str, Shape]:
    """Every named shape by its name."""
    modules = (import_module(f"{__name__}.{m.name}") for m in pkgutil.iter_modules(__path__))
    shapes: list[Shape] = [module.SHAPE for module in modules]
    return {s.name: s for s in sorted(shapes, key=lambda s: s.name)}


def get(name: str) -> Shape:
    """The shape of that name; InputError where there is none."""
    if name not in all_shapes():
        raise InputError("shape", name, f"unknown; allowed: {', '.join(all_shapes())}")
    return all_shapes()[name]
