"""`verify.modified_hamiltonian`: the modified equation, and the energy that a scheme keeps."""

from verify import schemes
from verify.arithmetic.exact import whole
from verify.calls.inputs import (
    ParametersLike,
    SchemeLike,
    SystemLike,
    hamiltonian_from,
    scheme_from,
    step_map_from,
)
from verify.errors import InputError
from verify.hamiltonians import systems
from verify.proof.plane.modified.equation import ModifiedEquation
from verify.proof.plane.modified.every import MOST_ORDER as MOST_FOR_EVERY
from verify.proof.plane.modified.every import modified_for_every
from verify.proof.plane.modified.one import MOST_ORDER, modified_of
from verify.schemes.maps.step_map import StepMap
from verify.schemes.scheme import Scheme


def modified_hamiltonian(
    scheme: SchemeLike,
    system: SystemLike | None = None,
    order: int = 4,
    *,
    parameters: ParametersLike = None,
    separable: bool = False,
) -> ModifiedEquation:
    """Return the modified equation's terms and the modified Hamiltonian H̃ = H + h H_2 + h² H_3 + ….

    The map of the scheme is the exact flow of the modified field, as a series in h; where its terms
    are Hamiltonian, H̃ is the energy that the scheme keeps. The first term that is not has a
    divergence, which is the leading coefficient of ΔJ.

    Parameters
    ----------
    scheme: a name, 'p_next = …; q_next = …', a Scheme, or a StepMap of the same Hamiltonian.
    system: a Hamiltonian, a system's name, a formula; without one, for every smooth H that the
        scheme takes (`separable`: every H = T(p) + V(q)), or for that of the StepMap.
    order: the highest power of h in f̃ and H̃, 1 … 10, for every H 1 … 8.
    parameters: exact values by name; one without a value stays a symbol.

    Raises InputError, one line, for a bad argument.

    >>> modified_hamiltonian("stormer-verlet", "p**2/2 + q**4/4", 2).expression
    h**2*q**2*(6*p**2 - q**4)/24 + p**2/2 + q**4/4
    >>> equation = modified_hamiltonian("lie2", "duffing", 4)
    >>> equation.reach, equation.first_not_hamiltonian.divergence
    (1, '3*delta*p*q')
    """
    scheme_or_map = _resolve_scheme(scheme, system)
    whole("order", order, 1, MOST_FOR_EVERY if system is None else MOST_ORDER)
    if system is None:
        if parameters:
            raise InputError("parameters", parameters, "goes with a system")
        if isinstance(scheme_or_map, StepMap):
            return modified_of(scheme_or_map, None, order)
        return modified_for_every(scheme_or_map.name, order, separable)
    if separable:
        raise InputError("separable", separable, "goes without a system")
    exact = hamiltonian_from(system, parameters)
    claims = scheme_or_map if isinstance(scheme_or_map, Scheme) else None
    return modified_of(step_map_from(scheme_or_map, exact), claims, order)


def _resolve_scheme(scheme: SchemeLike, system: SystemLike | None) -> Scheme | StepMap:
    """Return the scheme; InputError with the right call where a system stands in its place."""
    if isinstance(scheme, str) and systems.canonical(scheme) in systems.names():
        is_swapped = isinstance(system, str) and schemes.canonical(system) in schemes.names()
        other = system if is_swapped else "stormer-verlet"
        write = f"modified_hamiltonian({other!r}, {scheme!r})"
        raise InputError("scheme", scheme, f"is a system; write {write}")
    return scheme_from(scheme)
