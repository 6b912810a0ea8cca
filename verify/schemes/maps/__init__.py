"""Step maps, from the coefficients that a scheme has for every H, in any number of degrees.

A file of `kinds/` has `build(coefficients, hamiltonian, name)`, the map that a kind of coefficients
makes, `name` being the scheme's; and `conditions(coefficients, degrees)`, which suffice for a
symplectic one, for every H. Adding a kind is adding one file; its coefficients have its name as
their `kind`.
"""

from typing import Any

from verify.discovery import Catalogue
from verify.errors import InputError

_FILES = Catalogue(f"{__name__}.kinds", [f"{folder}/kinds" for folder in __path__])


def kind_of(every_h: object, name: str) -> Any:
    """Return the module of `kinds/` for these coefficients of a scheme of that name; InputError
    where there is none."""
    kind = getattr(every_h, "kind", "")
    if kind not in _FILES:
        raise InputError("scheme", name, "is known in one degree of freedom only")
    return _FILES.module(kind)
