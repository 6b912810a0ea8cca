"""`verify.export`: a step map, its Jacobian and ΔJ as code."""

from verify.algebra.expressions.formula_text import to_text
from verify.calls.given import (
    GivenParameters,
    GivenScheme,
    GivenSystem,
    hamiltonian_from,
    scheme_from,
    step_map_from,
)
from verify.schemes.export import get
from verify.schemes.export.program import Program, program_of
from verify.schemes.scheme import Scheme


def export(
    system: GivenSystem,
    scheme: GivenScheme,
    language: str = "python",
    *,
    parameters: GivenParameters = None,
    name: str = "step",
) -> str:
    """The step map, its Jacobian and ΔJ as a text in C, Python, Julia or LaTeX.

    Parameters
    ----------
    system: a Hamiltonian, a system's name, a formula.
    scheme: a name, 'p_next = …; q_next = …', a Scheme, or a StepMap of the same Hamiltonian.
    language: c, python, julia or latex.
    parameters: exact values by name; one without a value becomes an argument of the functions.
    name: of the function that makes a step; those of J and ΔJ are NAME_jacobian and NAME_delta_j.

    The functions take p, q and h, and where H depends on time p, q, t and h; J is taken at that t.

    Numbers in the code are the doubles nearest to the exact ones, which comments beside them give.
    Raises InputError, one line, for what is none of this, and for a map that is given by equations.

    >>> code = export("harmonic", "symplectic-euler", "python", parameters={"omega": 1})
    >>> made = {}
    >>> exec(code, made)
    >>> made["step"](p=1.0, q=0.0, h=0.5), made["step_delta_j"](1.0, 0.0, 0.5)
    ((1.0, 0.5), 0)
    """
    return get(language).written(program(system, scheme, language, parameters, name))


def program(
    system: GivenSystem,
    scheme: GivenScheme,
    language: str,
    parameters: GivenParameters = None,
    name: str = "step",
) -> Program:
    """What is written: the map as assignments, with its constants; see `export`."""
    exact = hamiltonian_from(system, parameters)
    found = scheme_from(scheme)
    step_map = step_map_from(found, exact)
    if isinstance(found, Scheme):
        called = found.name
    else:
        called = f"p_next = {to_text(found.p_next)}; q_next = {to_text(found.q_next)}"
    return program_of(step_map, called, name, get(language).RESERVED)
