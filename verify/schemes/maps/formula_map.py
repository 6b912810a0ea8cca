"""A user's own map: `p_next = …; q_next = …`, or `p1_next = …; q1_next = …`, and steps between."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from verify.algebra.domain import FormulaDomain
from verify.algebra.expressions.function_nodes import requirements_of_expression
from verify.algebra.formula import symbol
from verify.effort import limit_effort
from verify.errors import InputError
from verify.hamiltonians.canonical_field import field_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.lazy_sympy import sympy
from verify.schemes.maps.step_formula import StepFormula, names_of_time
from verify.schemes.maps.step_map import StepMap
from verify.structures import AREA

_NEXT = "_next"


def step_map_from_formulas(
    hamiltonian: Hamiltonian, formulas: Mapping[str, str], numbers: Collection[str] = ()
) -> StepMap:
    """Return the map that has a formula for each coordinate, by its name with `_next`.

    A formula may use the coordinates, h, the parameters of H, t if H depends on it, the names in
    `numbers`, the names of earlier formulas, and derivatives of H as `H_q(p_half, q_next)`.
    Formulas with other names, such as p_half, are steps in between. Raises InputError.
    """
    coordinates = hamiltonian.coordinates
    last = [name for name in formulas if name.endswith(_NEXT)]
    if sorted(last) != sorted(name + _NEXT for name in coordinates):
        raise _other_coordinates(hamiltonian, formulas)
    time = names_of_time(hamiltonian)
    names = [*coordinates, "h", *time, *hamiltonian.parameters, *numbers]
    for name in formulas:
        if name in names:
            problem = "stands for a value of the step in the map's formulas"
            raise InputError("parameter", name, problem)
    substitutions: dict[sympy.Symbol, sympy.Expr] = {}
    domain = FormulaDomain.from_requirements(())
    for name, formula in formulas.items():
        # Formulas may use earlier ones, so that substitution can grow exponentially.
        with limit_effort(name, formula, "to put what stands before into it"):
            read = StepFormula(hamiltonian, formula, names, name)
            domain &= read.domain.substitute(substitutions).substitute(
                hamiltonian.value_substitutions
            )
            substitutions[symbol(name)] = hamiltonian.substitute_values(
                read.expression.xreplace(substitutions)
            )
        names.append(name)
    exact = [substitutions[symbol(name + _NEXT)] for name in coordinates]
    return map_from_expressions(hamiltonian, exact, domain)


def _other_coordinates(hamiltonian: Hamiltonian, formulas: Mapping[str, str]) -> InputError:
    formula_text = "; ".join(map(" = ".join, formulas.items()))
    required_names = ", ".join(name + _NEXT for name in hamiltonian.coordinates)
    if hamiltonian.structure is AREA:
        problem = "H has other coordinates; allowed: formulas of p_next and q_next"
        return InputError("scheme", formula_text, problem)
    system = "the field" if hamiltonian.energy is None else "H"
    return InputError("scheme", "; ".join(formulas), f"{system} needs {required_names}, once each")


def map_from_expressions(
    hamiltonian: Hamiltonian, exact: Sequence[sympy.Expr], domain: FormulaDomain | None = None
) -> StepMap:
    """Return the map of z' as expressions in z, h, the parameters, and t if H depends on it.

    `domain`: a domain besides that of these expressions. Raises InputError as `canonical_field`
    does.
    """
    field, elements = field_of(hamiltonian, *exact)
    smooth = FormulaDomain.from_requirements(
        r for x in exact for r in requirements_of_expression(x, smooth=True)
    )
    domain = smooth if domain is None else smooth & domain
    return StepMap(hamiltonian, field, formulas=tuple(elements), formula_domain=domain)
