"""Step maps, from the coefficients that a scheme has for every H, in any number of degrees.

A file of `kinds/` has `KIND`, a class of coefficients; `build(coefficients, hamiltonian, name)`,
the map that they make, `name` being the scheme's; and `conditions(coefficients, degrees)`, which
suffice for a symplectic one, for every H. Adding a kind is adding one file.
"""

from functools import cache
from typing import TYPE_CHECKING, Any

from verify.discovery import Catalogue
from verify.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping

_FILES = Catalogue(f"{__name__}.kinds", [f"{folder}/kinds" for folder in __path__])


@cache
def _kinds() -> "Mapping[type, Any]":
    modules = map(_FILES.module, _FILES.names)
    return {module.KIND: module for module in modules}


def kind_of(every_h: object, name: str) -> Any:
    """The module of `kinds/` for these coefficients of a scheme of that name; InputError where
    there is none."""
    kind = _kinds().get(type(every_h))
    if kind is None:
        raise InputError("scheme", name, "is known in one degree of freedom only")
    return kind
