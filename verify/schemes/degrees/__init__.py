"""Step maps in n degrees of freedom, from the coefficients that a scheme has for every H.

A file of `kinds/` has `KIND`, a class of coefficients; `build(coefficients, hamiltonian)`, the map
that they make; and `conditions(coefficients)`, which suffice for a symplectic one, for every H.
Adding a kind is adding one file.
"""

from functools import cache
from typing import TYPE_CHECKING, Any

from verify.discovery import Catalogue
from verify.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from verify.hamiltonians.hamiltonian import Hamiltonian
    from verify.schemes.degrees.canonical_map import CanonicalMap
    from verify.schemes.scheme import Scheme

_FILES = Catalogue(f"{__name__}.kinds", [f"{folder}/kinds" for folder in __path__])


@cache
def _kinds() -> "Mapping[type, Any]":
    modules = map(_FILES.module, _FILES.names)
    return {module.KIND: module for module in modules}


def kind_of(scheme: "Scheme") -> Any:
    """The module of `kinds/` that knows its coefficients; InputError where there is none."""
    found = _kinds().get(type(scheme.every_h))
    if found is None:
        raise InputError("scheme", scheme.name, "is known in one degree of freedom only")
    return found


def map_in_degrees(scheme: "Scheme", hamiltonian: "Hamiltonian") -> "CanonicalMap":
    """The scheme's map of H(p1 … pn, q1 … qn). Raises InputError for what it does not take."""
    if scheme.formulas:
        from verify.schemes.degrees.by_formulas import map_by_formulas

        return map_by_formulas(hamiltonian, scheme.formulas)
    made: CanonicalMap = kind_of(scheme).build(scheme.every_h, hamiltonian)
    return made


def check_takes(scheme: "Scheme", hamiltonian: "Hamiltonian") -> None:
    """InputError for an H that the scheme does not take, in any number of degrees of freedom."""
    if hamiltonian.planar:
        scheme.step_map(hamiltonian)
    else:
        map_in_degrees(scheme, hamiltonian)
