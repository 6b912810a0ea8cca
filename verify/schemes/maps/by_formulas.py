"""A user's own map: `p_next = …; q_next = …`, or `p1_next = …; q1_next = …`."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from verify.algebra.domain import Domain
from verify.algebra.formula import read, symbol
from verify.algebra.requirement import of_expression
from verify.effort import limited
from verify.errors import InputError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.late import sympy
from verify.schemes.maps.step_map import StepMap
from verify.structures import AREA, SYMPLECTIC

_NEXT = "_next"


def map_by_formulas(
    hamiltonian: Hamiltonian, formulas: Mapping[str, str], numbers: Collection[str] = ()
) -> StepMap:
    """The map that has a formula for each coordinate, by its name with `_next`.

    A formula may use the coordinates, h, H's parameters, t where H has it, and what was defined
    before it, and the names of `numbers`. Raises InputError.
    """
    coordinates = hamiltonian.coordinates
    if sorted(formulas) != sorted(name + _NEXT for name in coordinates):
        raise _other_coordinates(hamiltonian, formulas)
    time = ("t",) if hamiltonian.time_dependent else ()
    names = [*coordinates, "h", *time, *hamiltonian.parameters, *numbers]
    if "p_next" in formulas and "p_next" in names:
        raise InputError("parameter", "p_next", "stands for p' in a map's formulas")
    put: dict[sympy.Symbol, sympy.Expr] = {}
    asked = Domain.of(())
    for name, formula in formulas.items():
        expression, required = read(formula, names, source=name)
        with limited(name, formula, "to put what stands before into it"):
            asked &= Domain.of(required).replaced(put).replaced(hamiltonian.put)
            put[symbol(name)] = hamiltonian.put_in(expression.xreplace(put))
        names.append(name)
    exact = [put[symbol(name + _NEXT)] for name in coordinates]
    return map_by_expressions(hamiltonian, exact, asked)


def _other_coordinates(hamiltonian: Hamiltonian, formulas: Mapping[str, str]) -> InputError:
    written = "; ".join(map(" = ".join, formulas.items()))
    needed = ", ".join(name + _NEXT for name in hamiltonian.coordinates)
    shown, problem = {
        AREA: (written, "H has other coordinates; allowed: formulas of p_next and q_next"),
        SYMPLECTIC: ("; ".join(formulas), f"H needs {needed}, once each"),
    }[hamiltonian.structure]
    return InputError("scheme", shown, problem)


def map_by_expressions(
    hamiltonian: Hamiltonian, exact: Sequence[sympy.Expr], asked: Domain | None = None
) -> StepMap:
    """The map of z' as expressions in z, h, t where H has it, and parameters; `asked`: where more
    than they is defined. InputError where they are not smooth."""
    field, closed = canonical_field(hamiltonian, *exact)
    smooth = Domain.of(r for x in exact for r in of_expression(x, smooth=True))
    asked = smooth if asked is None else smooth & asked
    return StepMap(hamiltonian, field, formulas=tuple(closed), asked=asked)
