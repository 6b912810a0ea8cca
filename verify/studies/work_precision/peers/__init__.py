"""Other people's integrators, for the same error and the same clock; one file each, found by
themselves.

A file defines `NAME`, `LIBRARY`, the package that it needs and imports only where it is used, and
`make(problem)`, which returns what solves the problem (see
`verify.studies.work_precision.peer_interface`). Adding a peer is adding one file.
"""

from functools import cache
from types import ModuleType

from verify.discovery import Catalogue

_FILES = Catalogue(__name__, __path__)


@cache
def _modules() -> dict[str, ModuleType]:
    modules = (_FILES.module(file) for file in _FILES.names)
    return {module.NAME: module for module in modules}


def libraries() -> dict[str, str]:
    """Return the package that each peer needs, by the peer's name."""
    return {name: module.LIBRARY for name, module in _modules().items()}


def get(name: str) -> ModuleType:
    """Return the module of the peer of that name."""
    return _modules()[name]
