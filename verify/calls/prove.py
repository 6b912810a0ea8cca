"""`verify.prove`: the order of ΔJ and of the map, by exact algebra."""

from verify.calls.inputs import (
    ParametersLike,
    SchemeLike,
    SystemLike,
    hamiltonian_from,
    scheme_from,
    step_map_from,
)
from verify.errors import NOT_GIVEN, InputError
from verify.proof.order import prove as prove_map
from verify.proof.proof import Proof
from verify.schemes.maps.step_map import StepMap
from verify.schemes.scheme import Scheme


def prove(
    system: SystemLike | StepMap,
    scheme: SchemeLike | None = None,
    *,
    parameters: ParametersLike = None,
) -> Proof:
    """Prove the order in h of ΔJ = det J − 1, that of the map, and what the scheme claims.

    For an H in p1 … pn and q1 … qn, the order of S = JᵀΩJ − Ω is proved in place of that of ΔJ.

    Parameters
    ----------
    system: a Hamiltonian, a system's name, a formula in p, q (or p1, p2, …) and t; or a StepMap,
        which is then proved itself, with a `scheme` or without one whose claims it is held to.
    scheme: a name, 'p_next = …; q_next = …', a Scheme, or a StepMap of the same Hamiltonian.
    parameters: exact values by name; one without a value stays a symbol, and the proof holds for
        all its values but those that `domain` names.

    Raises InputError, one line, for a bad argument.

    >>> proof = prove("duffing", "lie2")
    >>> str(proof.verdict), proof.order, proof.leading
    ('PROVED', 3, 3*delta*p*q)
    >>> several = prove("p1**2/2 + p2**2/2 - cos(q1 - q2)", "lie2")
    >>> several.order, several.symplectic, several.telescopes
    (3, False, True)
    """
    if isinstance(system, StepMap):
        claims = None if scheme is None else scheme_from(scheme)
        if isinstance(claims, StepMap) or parameters:
            name = "parameters" if parameters else "scheme"
            raise InputError(
                name, parameters or claims, "does not go with a StepMap that is proved"
            )
        return prove_map(system, claims)
    exact = hamiltonian_from(system, parameters)
    if scheme is None:
        raise InputError("scheme", NOT_GIVEN, "is missing; such as prove('duffing', 'lie2')")
    scheme_or_map = scheme_from(scheme)
    return prove_map(
        step_map_from(scheme_or_map, exact),
        scheme_or_map if isinstance(scheme_or_map, Scheme) else None,
    )
