"""Schemes: step maps, tableaux, splittings, order conditions; `methods/` has one scheme a file.

A file of `methods/` defines `SCHEME`, its one Scheme, whose name is the file's; or, for a family,
`EXAMPLES`, some of the names it answers to, and `make(name)`, which returns the Scheme of that name
or None. The name of a file is the beginning of the names it answers to; those in `methods/user/`
answer to texts of the users' own. Adding a scheme is adding one file.
"""

from functools import cache
from typing import TYPE_CHECKING

from verify.discovery import Catalogue
from verify.errors import InputError

if TYPE_CHECKING:
    from verify.schemes.scheme import Scheme

_FILES = Catalogue(f"{__name__}.methods", [f"{folder}/methods" for folder in __path__])
_USERS = "user"


@cache
def names() -> tuple[str, ...]:
    """A name for each scheme; a family is shown by its first members."""
    return tuple(
        name for file in _FILES.names for name in getattr(_FILES.module(file), "EXAMPLES", [file])
    )


@cache
def get(name: str) -> "Scheme":
    """The scheme of that name; InputError where there is none."""
    if not isinstance(name, str):
        raise InputError("scheme", name, "is not a name")
    for file in _candidates(name):
        scheme = _made(file, name)
        if scheme is not None:
            return scheme
    raise InputError("scheme", name, f"unknown; allowed: {', '.join(names())}, …")


def _candidates(name: str) -> list[str]:
    """The files that may answer to the name: `lie2` imports `lie.py` and no other."""
    users = [file for file in _FILES.names if _FILES.folder(file) == _USERS]
    return [*(f for f in _FILES.names if name.startswith(f) and f not in users), *users]


def _made(file: str, name: str) -> "Scheme | None":
    """What the file makes of the name; None where it does not answer to it."""
    module = _FILES.module(file)
    scheme: Scheme | None
    if hasattr(module, "SCHEME"):
        scheme = module.SCHEME if file == name else None
    else:
        scheme = module.make(name)
    return scheme
