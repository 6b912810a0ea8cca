"""The schemes, one file each, found by themselves.

A file defines `EXAMPLES`, names it answers to, and `make(name)`, which returns the Scheme of that
name or None. Adding a scheme is adding one file.
"""

import pkgutil
from functools import cache
from importlib import import_module

from verify.errors import InputError
from verify.scheme import Scheme


@cache
def _modules() -> tuple[object, ...]:
    names = sorted(m.name for m in pkgutil.iter_modules(__path__))
    return tuple(import_module(f"{__name__}.{name}") for name in names)


def names() -> tuple[str, ...]:
    """A name for each scheme; a family is shown by its first members."""
    return tuple(name for module in _modules() for name in module.EXAMPLES)  # type: ignore[attr-defined]


@cache
def get(name: str) -> Scheme:
    """The scheme of that name; InputError where there is none."""
    if not isinstance(name, str):
        raise InputError("scheme", name, "is not a name")
    for module in _modules():
        scheme = module.make(name)  # type: ignore[attr-defined]
        if scheme is not None:
            return scheme  # type: ignore[no-any-return]
    raise InputError("scheme", name, f"unknown; allowed: {', '.join(names())}, …")
