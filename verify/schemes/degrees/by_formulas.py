"""A user's own map in n degrees of freedom: `p1_next = …; p2_next = …; q1_next = …; …`."""

from collections.abc import Collection, Mapping

import sympy

from verify.algebra.domain import Domain
from verify.algebra.formula import read, symbol
from verify.algebra.requirement import of_expression
from verify.effort import limited
from verify.errors import InputError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.degrees.canonical_map import CanonicalMap

_NEXT = "_next"


def map_by_formulas(
    hamiltonian: Hamiltonian, formulas: Mapping[str, str], numbers: Collection[str] = ()
) -> CanonicalMap:
    """The map that has a formula for each coordinate, by its name with `_next`.

    A formula may use the coordinates, h, H's parameters, t where H has it, and what was defined
    before it, and the names of `numbers`. Raises InputError.
    """
    coordinates = hamiltonian.coordinates
    if sorted(formulas) != sorted(name + _NEXT for name in coordinates):
        needed = ", ".join(name + _NEXT for name in coordinates)
        raise InputError("scheme", "; ".join(formulas), f"H needs {needed}, once each")
    time = ("t",) if hamiltonian.time_dependent else ()
    names = [*coordinates, "h", *time, *hamiltonian.parameters, *numbers]
    put: dict[sympy.Symbol, sympy.Expr] = {}
    asked = Domain.of(())
    for name, formula in formulas.items():
        found, required = read(formula, names, source=name)
        with limited(name, formula, "to put what stands before into it"):
            asked &= Domain.of(required).replaced(put).replaced(hamiltonian.put)
            put[symbol(name)] = hamiltonian.put_in(found.xreplace(put))
        names.append(name)
    exact = [put[symbol(name + _NEXT)] for name in coordinates]
    asked &= Domain.of(r for x in exact for r in of_expression(x, smooth=True))
    field, closed = canonical_field(hamiltonian, *exact)
    return CanonicalMap(hamiltonian, field, closed=tuple(closed), asked=asked)
