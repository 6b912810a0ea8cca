"""Step maps in n degrees of freedom, from the coefficients that a scheme has for every H.

A file of `kinds/` has `KIND`, a class of coefficients, and `build(coefficients, hamiltonian)`, the
map that they make. Adding a kind is adding one file.
"""

from functools import cache
from typing import TYPE_CHECKING

from verify.discovery import Catalogue
from verify.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from verify.hamiltonians.hamiltonian import Hamiltonian
    from verify.schemes.degrees.canonical_map import CanonicalMap
    from verify.schemes.scheme import Scheme

_FILES = Catalogue(f"{__name__}.kinds", [f"{folder}/kinds" for folder in __path__])


@cache
def _builders() -> "Mapping[type, Callable[..., CanonicalMap]]":
    modules = map(_FILES.module, _FILES.names)
    return {module.KIND: module.build for module in modules}


def map_in_degrees(scheme: "Scheme", hamiltonian: "Hamiltonian") -> "CanonicalMap":
    """The scheme's map of H(p1 … pn, q1 … qn). Raises InputError for what it does not take."""
    if scheme.formulas:
        from verify.schemes.degrees.by_formulas import map_by_formulas

        return map_by_formulas(hamiltonian, scheme.formulas)
    build = _builders().get(type(scheme.every_h))
    if build is None:
        raise InputError("scheme", scheme.name, "is known in one degree of freedom only")
    return build(scheme.every_h, hamiltonian)
