"""`verify.export`: a step map, its Jacobian and ΔJ as code."""

from __future__ import annotations

from verify.algebra.expressions.formula_text import to_text
from verify.calls import inputs
from verify.schemes.export import get
from verify.schemes.export.program import Program, program_of
from verify.schemes.scheme import Scheme


def export(
    system: inputs.SystemLike,
    scheme: inputs.SchemeLike,
    language: str = "python",
    *,
    parameters: inputs.ParametersLike = None,
    name: str = "step",
) -> str:
    """Return the step map, its Jacobian and ΔJ as a text in C, Python, Julia or LaTeX.

    Parameters
    ----------
    system: a Hamiltonian, a system's name, a formula.
    scheme: a name, 'p_next = …; q_next = …', a Scheme, or a StepMap of the same Hamiltonian.
    language: c, python, julia or latex.
    parameters: exact values by name; one without a value becomes an argument of the functions.
    name: that of the function that makes a step; the functions of J and ΔJ are called
        NAME_jacobian and NAME_delta_j.

    The functions take p, q and h, or p, q, t and h if H depends on time; J is taken at that t.

    Numbers in the code are the doubles nearest to the exact ones, which comments beside them give.
    Raises InputError, one line, for a bad argument, and for a map that is given by equations.

    >>> code = export("harmonic", "symplectic-euler", "python", parameters={"omega": 1})
    >>> module = {}
    >>> exec(code, module)
    >>> module["step"](p=1.0, q=0.0, h=0.5), module["step_delta_j"](1.0, 0.0, 0.5)
    ((1.0, 0.5), 0)
    """
    return get(language).render(build_program(system, scheme, language, parameters, name))


def build_program(
    system: inputs.SystemLike,
    scheme: inputs.SchemeLike,
    language: str,
    parameters: inputs.ParametersLike = None,
    name: str = "step",
) -> Program:
    """Return the map as assignments, with its constants, for a language.

    The arguments are those of `export`.
    """
    hamiltonian = inputs.hamiltonian_from(system, parameters)
    scheme_or_map = inputs.scheme_from(scheme)
    step_map = inputs.step_map_from(scheme_or_map, hamiltonian)
    if isinstance(scheme_or_map, Scheme):
        scheme_text = scheme_or_map.name
    else:
        scheme_text = (
            f"p_next = {to_text(scheme_or_map.p_next)}; q_next = {to_text(scheme_or_map.q_next)}"
        )
    return program_of(step_map, scheme_text, name, get(language).RESERVED)
