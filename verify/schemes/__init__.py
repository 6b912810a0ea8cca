"""Schemes: step maps, tableaux, splittings, order conditions; `methods/` has one scheme a file.

A file of `methods/` defines `SCHEME`, the Scheme that has the file's name. For a family it defines
`EXAMPLES`, some names of members, and `make(name)`, which returns the member of that name or None.
The names of members begin with the file's name; the files in `methods/user/` take texts that users
write, and that may begin with a title: `mine: p_half = …`. `ALIASES` are other names of the scheme.
To add a scheme is to add one file.
"""

import re
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

from verify.discovery import Catalogue
from verify.errors import InputError, plain_name, unknown_name

if TYPE_CHECKING:
    from collections.abc import Mapping

    from verify.schemes.scheme import Scheme

_FILES = Catalogue(f"{__name__}.methods", [f"{folder}/methods" for folder in __path__])
_USER_FOLDER = "user"
_TITLED = re.compile(r"([A-Za-z][\w-]*)\s*:\s*(.*)", re.ASCII | re.DOTALL)


@cache
def names() -> tuple[str, ...]:
    """Return the names of all schemes; a family stands with its `EXAMPLES`."""
    return tuple(
        name for file in _FILES.names for name in getattr(_FILES.module(file), "EXAMPLES", [file])
    )


@cache
def get(name: str) -> "Scheme":
    """Return the scheme of that name, which is read as `canonical` reads it.

    The name may be an alias, a member of a family such as `lie7`, or a user's own formulas or
    coefficients, with a title before them or not. Raises InputError if it is none of these.
    """
    if not isinstance(name, str):
        raise InputError("scheme", name, "is not a name")
    title, text = separate_title(name)
    if title:
        return _get_titled(title, text)
    # Importing every file would load sympy: only files whose name begins the scheme's are tried.
    for file in _candidates(canonical(name)):
        scheme = _scheme_from_file(file, canonical(name))
        if scheme is not None:
            return scheme
    advice = "; code of your own goes with verify check-integrator" if ".py" in name else ""
    raise unknown_name("scheme", name, names(), f", …{advice}", aliases())


def separate_title(name: str) -> tuple[str, str]:
    """Return the title that a user gave a scheme, or "", and what stands behind it.

    >>> separate_title("mine: kick 1; drift 1"), separate_title("rk4")
    (('mine', 'kick 1; drift 1'), ('', 'rk4'))
    """
    match = _TITLED.fullmatch(name)
    return (match[1], match[2]) if match else ("", name)


def _get_titled(title: str, text: str) -> "Scheme":
    if not text.strip() or separate_title(text)[0]:
        raise InputError("scheme", f"{title}: {text}", "has no scheme behind its one title")
    try:
        taken = get(title).name
    except InputError:
        taken = ""
    if taken:
        raise InputError("scheme", title, f"is the scheme {taken}; give yours another title")
    scheme = get(text)
    if family(text) != _USER_FOLDER:
        raise InputError("scheme", f"{title}: {text}", f"has the name {scheme.name}; write that")
    return replace(scheme, name=f"{title}: {scheme.name}")


@cache
def family(name: str) -> str:
    """Return the family of a scheme, which is the folder of its file in `methods/`.

    Raises InputError if there is no such scheme.

    >>> family("leapfrog"), family("lie2")
    ('splitting', 'taylor')
    """
    plain = canonical(get(separate_title(name)[1]).name)
    file = next(file for file in _candidates(plain) if _scheme_from_file(file, plain) is not None)
    return _FILES.folder(file).replace("_", "-")


@cache
def aliases() -> "Mapping[str, str]":
    """Return other names of schemes, each with the name of its scheme."""
    ours = filter(_is_ours, _FILES.names)
    return {a: file for file in ours for a in getattr(_FILES.module(file), "ALIASES", ())}


@cache
def canonical(name: str) -> str:
    """Return the name of the scheme that this name or alias means, in any case and spacing.

    A name that is not known, and a text that a user wrote, is returned as it is.

    >>> canonical("RK4"), canonical("leapfrog"), canonical("kick 1; drift 1")
    ('rk4', 'stormer-verlet', 'kick 1; drift 1')
    """
    if not isinstance(name, str):  # `get` raises the error
        return name
    plain = plain_name(name)
    files = [file for file in _FILES.names if plain.startswith(file) and _is_ours(file)]
    if any(_answers(file, plain) for file in files):
        return plain
    return aliases().get(plain, name)


def _is_ours(file: str) -> bool:
    return _FILES.folder(file) != _USER_FOLDER


def _answers(file: str, name: str) -> bool:
    try:
        return _scheme_from_file(file, name) is not None
    except InputError:  # a name of the family without a member; `get` raises the error
        return True


def _candidates(name: str) -> list[str]:
    """Return the files that may have the scheme: for `lie2` those are `lie.py` and the users'."""
    users = [file for file in _FILES.names if not _is_ours(file)]
    return [*(f for f in _FILES.names if name.startswith(f) and _is_ours(f)), *users]


def _scheme_from_file(file: str, name: str) -> "Scheme | None":
    """Return the file's scheme of that name; None if it has none."""
    module = _FILES.module(file)
    scheme: Scheme | None
    if hasattr(module, "SCHEME"):
        scheme = module.SCHEME if file == name else None
    else:
        scheme = module.make(name)
    return scheme
