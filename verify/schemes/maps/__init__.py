"""Step maps from a scheme's coefficients, in any number of degrees of freedom.

A file of `kinds/` is for one kind of coefficients, whose `kind` is the file's name. It defines
`build(coefficients, hamiltonian, name)`, which returns the step map of the scheme `name`, and
`conditions(coefficients, degrees)`, conditions that suffice for a symplectic map, for every H. To
add a kind is to add one file.
"""

from typing import Any

from verify.discovery import Catalogue
from verify.errors import InputError

_FILES = Catalogue(f"{__name__}.kinds", [f"{folder}/kinds" for folder in __path__])


def kind_of(every_h: object, name: str) -> Any:
    """Return the module of `kinds/` for the coefficients `every_h` of the scheme `name`.

    Raises InputError if there is none.
    """
    kind = getattr(every_h, "kind", "")
    if kind not in _FILES:
        raise InputError("scheme", name, "is known in one degree of freedom only")
    return _FILES.module(kind)
