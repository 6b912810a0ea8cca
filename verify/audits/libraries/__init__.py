"""Other people's integrators, to be held against what they claim; one file each, found by
themselves.

A file defines `TITLE`, what people call it; `LIBRARY`, the package that it needs and imports only
where it is used, or None where it needs none; `PACKAGE`, what pip calls it, where that is another
name; `EXTRA`, of ours, that installs it, unless that is `peers`; `LEFT_OUT`, what of it cannot be
driven as a one-step map, each with the reason; and `integrators()`, which yields what is verified
(see `verify.audits.methods.integrator`). Adding a library is adding one file.
"""

from functools import cache
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from types import ModuleType

from verify.discovery import Catalogue

_FILES = Catalogue(__name__, __path__)


@cache
def names() -> tuple[str, ...]:
    """Return the files' names; those that need no library last."""
    return tuple(sorted(_FILES.names, key=lambda name: (get(name).LIBRARY is None, name)))


def get(name: str) -> ModuleType:
    """Return the module of that name."""
    module: ModuleType = _FILES.module(name)
    return module


def installed_version(name: str) -> str | None:
    """Return the version of the library that it needs; "" where it needs none, None where it is not
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
