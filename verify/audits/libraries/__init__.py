"""Other libraries whose integrators are compared with their claims; each is one file here.

A file defines

- `TITLE`: the library's name for people;
- `LIBRARY`: the package that it needs, imported only when it is used; None if it needs none;
- `PACKAGE`: the name of the package for pip, if that is another one;
- `EXTRA`: our extra that installs it, if that is not `peers`;
- `LEFT_OUT`: the integrators that cannot be called as a one-step map, each with the reason;
- `integrators()`: yields those that are verified (see `verify.audits.methods.integrator`).

The files are discovered: to add a library, add one file.
"""

from functools import cache
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from types import ModuleType

from verify.discovery import Catalogue

_FILES = Catalogue(__name__, __path__)


@cache
def names() -> tuple[str, ...]:
    """Return the names of the files, those that need no library last."""
    return tuple(sorted(_FILES.names, key=lambda name: (get(name).LIBRARY is None, name)))


def get(name: str) -> ModuleType:
    """Return the module of that name."""
    module: ModuleType = _FILES.module(name)
    return module


def installed_version(name: str) -> str | None:
    """Return the version of the library that a file needs; "" if it needs none, None if it is not
    installed."""
    library = get(name).LIBRARY
    if library is None:
        return ""
    if find_spec(library) is None:
        return None
    try:
        return version(getattr(get(name), "PACKAGE", library))
    except PackageNotFoundError:
        return "unknown version"
