"""Schemes: step maps, tableaux, splittings, order conditions; `methods/` has one scheme a file.

A file of `methods/` defines `SCHEME`, its one Scheme, whose name is the file's; or, for a family,
`EXAMPLES`, some of the names it answers to, and `make(name)`, which returns the Scheme of that name
or None. The name of a file is the beginning of the names it answers to; those in `methods/user/`
answer to texts that users write. `ALIASES` are other names of the scheme. Adding a scheme is adding
one file.
"""

from functools import cache
from typing import TYPE_CHECKING

from verify.discovery import Catalogue
from verify.errors import InputError, plain_name, unknown_name

if TYPE_CHECKING:
    from collections.abc import Mapping

    from verify.schemes.scheme import Scheme

_FILES = Catalogue(f"{__name__}.methods", [f"{folder}/methods" for folder in __path__])
_USERS = "user"


@cache
def names() -> tuple[str, ...]:
    """Return a name for each scheme; a family is represented by its first members."""
    return tuple(
        name for file in _FILES.names for name in getattr(_FILES.module(file), "EXAMPLES", [file])
    )


@cache
def get(name: str) -> "Scheme":
    """Return the scheme of that name, as `canonical` reads it.

    The name may be an alias, a member of a family such as `lie7`, or formulas or coefficients of
    one's own. Raises InputError where there is none.
    """
    if not isinstance(name, str):
        raise InputError("scheme", name, "is not a name")
    # Importing every file would load sympy for each scheme: only those whose names fit are tried.
    for file in _candidates(canonical(name)):
        scheme = _scheme_from_file(file, canonical(name))
        if scheme is not None:
            return scheme
    advice = "; code of your own goes with verify check-integrator" if ".py" in name else ""
    raise unknown_name("scheme", name, names(), f", …{advice}", aliases())


@cache
def family(name: str) -> str:
    """Return the family of the scheme of that name: the folder of `methods/` that its file lies in.

    Raises InputError where there is no such scheme.

    >>> family("leapfrog"), family("lie2")
    ('splitting', 'taylor')
    """
    plain = canonical(get(name).name)
    file = next(file for file in _candidates(plain) if _scheme_from_file(file, plain) is not None)
    return _FILES.folder(file).replace("_", "-")


@cache
def aliases() -> "Mapping[str, str]":
    """Return other names of schemes, each with the name of its scheme."""
    ours = filter(_is_ours, _FILES.names)
    return {a: file for file in ours for a in getattr(_FILES.module(file), "ALIASES", ())}


@cache
def canonical(name: str) -> str:
    """Return the name of the scheme with this alias: in any case, with spaces.

    The name itself where there is none, and of a text of the users' own.

    >>> canonical("RK4"), canonical("leapfrog"), canonical("kick 1; drift 1")
    ('rk4', 'stormer-verlet', 'kick 1; drift 1')
    """
    if not isinstance(name, str):  # `get` says so
        return name
    plain = plain_name(name)
    files = [file for file in _FILES.names if plain.startswith(file) and _is_ours(file)]
    if any(_answers(file, plain) for file in files):
        return plain
    return aliases().get(plain, name)


def _is_ours(file: str) -> bool:
    return _FILES.folder(file) != _USERS


def _answers(file: str, name: str) -> bool:
    try:
        return _scheme_from_file(file, name) is not None
    except InputError:  # a member of the family that it cannot make; it will say so
        return True


def _candidates(name: str) -> list[str]:
    """Return the files that may answer to the name: `lie2` imports `lie.py` and no other."""
    users = [file for file in _FILES.names if not _is_ours(file)]
    return [*(f for f in _FILES.names if name.startswith(f) and _is_ours(f)), *users]


def _scheme_from_file(file: str, name: str) -> "Scheme | None":
    """Return the scheme that the file has for the name; None where it does not answer to it."""
    module = _FILES.module(file)
    scheme: Scheme | None
    if hasattr(module, "SCHEME"):
        scheme = module.SCHEME if file == name else None
    else:
        scheme = module.make(name)
    return scheme
