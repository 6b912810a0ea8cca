"""Other people's integrators, for the same error and the same clock; one file each, found by
themselves.

A file defines `NAME`, `LIBRARY`, the package that it needs and imports only where it is used, and
`make(problem)`, which returns what solves the problem (see `verify.peer`). Adding a peer is adding
one file.
"""

import pkgutil
from functools import cache
from importlib import import_module
from typing import Any


@cache
def _modules() -> dict[str, Any]:
    found = sorted(m.name for m in pkgutil.iter_modules(__path__))
    modules = (import_module(f"{__name__}.{name}") for name in found)
    return {module.NAME: module for module in modules}


def libraries() -> dict[str, str]:
    """The package that each peer needs, by the peer's name."""
    return {name: module.LIBRARY for name, module in _modules().items()}


def get(name: str) -> Any:
    """The module of that name."""
    return _modules()[name]
