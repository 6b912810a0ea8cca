"""`verify.prove` and `verify.modified_hamiltonian`: order, area and energy by exact algebra."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, overload

from verify import schemes
from verify.arithmetic.exact import whole
from verify.calls import inputs
from verify.errors import NOT_GIVEN, InputError
from verify.hamiltonians import systems
from verify.proof.order_for_one_h import prove as prove_map
from verify.proof.proof_for_one_h import Proof
from verify.scenes.keeps_section import name_keys, read_claims
from verify.schemes.maps.step_map import StepMap
from verify.schemes.scheme import Scheme
from verify.structures.reading import KeepsRequest

if TYPE_CHECKING:
    from verify.proof.plane.modified_equation import ModifiedEquation
    from verify.proof.proof_for_every_h import ProofForEveryH
    from verify.proof.structures.structures_proof import StructuresProof


@overload
def prove(
    system: inputs.SystemLike | StepMap,
    scheme: inputs.SchemeLike | None = None,
    *,
    parameters: inputs.ParametersLike = None,
) -> Proof: ...
@overload
def prove(
    system: inputs.SystemLike | StepMap,
    scheme: inputs.SchemeLike | None = None,
    *,
    parameters: inputs.ParametersLike = None,
    keeps: inputs.Texts,
    form: str = "",
    density: str = "",
    poisson: str = "",
    casimirs: inputs.Texts = (),
    reverses: str = "",
    factor: str = "",
) -> StructuresProof: ...


@overload
def prove(
    system: None = None,
    scheme: inputs.SchemeLike | None = None,
    *,
    every_hamiltonian: Literal[True],
    separable: bool = False,
    time_dependent: bool = False,
    degrees: int = 1,
) -> ProofForEveryH: ...
@overload
def prove(
    system: None = None,
    scheme: inputs.SchemeLike | None = None,
    *,
    keeps: inputs.Texts,
    reverses: str = "",
    every_hamiltonian: Literal[True],
    separable: bool = False,
    time_dependent: bool = False,
    degrees: int = 1,
) -> StructuresProof: ...


def prove(
    system: inputs.SystemLike | StepMap | None = None,
    scheme: inputs.SchemeLike | None = None,
    *,
    parameters: inputs.ParametersLike = None,
    keeps: inputs.Texts = (),
    form: str = "",
    density: str = "",
    poisson: str = "",
    casimirs: inputs.Texts = (),
    reverses: str = "",
    factor: str = "",
    every_hamiltonian: bool = False,
    separable: bool = False,
    time_dependent: bool = False,
    degrees: int | None = None,
) -> Proof | StructuresProof | ProofForEveryH:
    """Prove the order in h of ΔJ = det J − 1, the order of the map, and the claims of the scheme.

    For an H in p1 … pn and q1 … qn, the order of S = JᵀΩJ − Ω is proved in place of that of ΔJ.
    With `keeps`, only what it names is judged, and the claims of the scheme are not.

    Parameters
    ----------
    system: a Hamiltonian, a system's name, a formula in p, q (or p1, p2, …) and t; or a StepMap,
        the map to be proved. It is held to the claims of `scheme`, if there is one. With `keeps`
        also equations without an H, as 'u_dot = u*(v - 2); v_dot = v*(1 - u)'.
    scheme: a name, 'p_next = …; q_next = …', a Scheme, or a StepMap of the same Hamiltonian.
    parameters: exact values by name; a parameter without a value stays a symbol, and the proof
        holds for all its values but those that `domain` names.
    keeps: a structure that the step is meant to keep, or several: area, symplectic, volume, energy,
        momentum, angular-momentum, reversible, symmetric, conformal, poisson, or the formula of a
        first integral; with ': 3' behind it, its defect in one step is meant to be O(h^3), else 0.
    form, density, poisson, casimirs, reverses, factor: what refines a structure, as `verify prove`
        has it: the 2-form of symplectic, the density of volume, the bracket and its Casimirs, the
        involution of reversible, the factor of conformal.
    every_hamiltonian: prove it for every smooth H, without a system; `separable`: for every
        H = T(p) + V(q); `time_dependent`: for those that depend on t; `degrees`: of freedom, 1 if
        left out. What the step keeps is judged of every H whose flow keeps it.

    With `keeps` it returns a StructuresProof, whose `keeps` has for each structure a `verdict` with
    its `reason`, the `order` of the defect, its `leading` coefficient as a text, and whether this
    `telescopes`. For every H without `keeps` it returns a ProofForEveryH. Else it returns a Proof:
    `verdict` with its `reason`; `order` of ΔJ or S and its `leading` coefficient, an expression;
    `convergence_order` of the map; `area_preserving` and `symplectic`, each None if it is
    undecided. Raises InputError, one line, for a bad argument.

    >>> proof = prove("duffing", "lie2")
    >>> str(proof.verdict), proof.order, proof.leading
    ('PROVED', 3, 3*delta*p*q)
    >>> several = prove("p1**2/2 + p2**2/2 - cos(q1 - q2)", "lie2")
    >>> several.order, several.symplectic, several.telescopes
    (3, False, True)
    >>> energy, area = prove("pendulum", "lie2", keeps=["energy: 3", "area"]).keeps
    >>> str(energy.verdict), energy.leading, str(area.verdict)
    ('PROVED', '-p**3*sin(q)/6', 'REFUTED')
    >>> prove(scheme="gauss4", every_hamiltonian=True, degrees=2, keeps="angular-momentum").verdict
    <Verdict.PROVED: 'PROVED'>
    """
    request = inputs.keeps_request(keeps, form, density, poisson, casimirs, reverses, factor)
    family = {"separable": separable, "time_dependent": time_dependent, "degrees": degrees}
    if every_hamiltonian:
        if system is not None or parameters:
            name, value = ("parameters", parameters) if system is None else ("system", system)
            raise InputError(name, value, "goes without every_hamiltonian")
        return _prove_for_every_h(scheme, request, separable, time_dependent, degrees)
    for option, choice in family.items():
        if choice:
            raise InputError(option, choice, "goes with every_hamiltonian=True")
    if system is None:
        raise InputError("system", NOT_GIVEN, "is missing; such as prove('duffing', 'lie2')")
    if isinstance(system, StepMap):
        claims = None if scheme is None else inputs.scheme_from(scheme)
        if isinstance(claims, StepMap) or parameters:
            name = "parameters" if parameters else "scheme"
            raise InputError(
                name, parameters or claims, "does not go with a StepMap that is proved"
            )
        return _prove(system, claims, request)
    hamiltonian = inputs.hamiltonian_from(system, parameters, takes_field=bool(request))
    if scheme is None:
        raise InputError("scheme", NOT_GIVEN, "is missing; such as prove('duffing', 'lie2')")
    scheme_or_map = inputs.scheme_from(scheme)
    claims = scheme_or_map if isinstance(scheme_or_map, Scheme) else None
    return _prove(inputs.step_map_from(scheme_or_map, hamiltonian), claims, request)


def _prove(
    step_map: StepMap, scheme: Scheme | None, request: KeepsRequest
) -> Proof | StructuresProof:
    if request:
        from verify.proof.structures.structures_proof import prove_structures

        return prove_structures(step_map, read_claims(request, step_map.hamiltonian), scheme)
    inputs.hamiltonian_from(step_map.hamiltonian)  # raises InputError for equations without an H
    return prove_map(step_map, scheme)


def _prove_for_every_h(
    scheme: inputs.SchemeLike | None,
    request: KeepsRequest,
    separable: bool,
    timed: bool,
    degrees: int | None,
) -> StructuresProof | ProofForEveryH:
    from verify.proof.order_for_every_h import prove_for_every_h
    from verify.proof.structures.structures_for_every_h import prove_structures_for_every_h

    method = None if scheme is None else inputs.scheme_from(scheme)
    if not isinstance(method, Scheme):
        problem = "is of one H; every_hamiltonian=True goes with a scheme of every H, as 'lie2'"
        raise InputError("scheme", NOT_GIVEN if scheme is None else scheme, problem)
    count = 1 if degrees is None else whole("degrees", degrees, 1)
    if not request:
        return prove_for_every_h(method.name, separable, timed=timed, degrees=count)
    try:
        return prove_structures_for_every_h(
            method.name, request, separable, timed=timed, degrees=count
        )
    except InputError as error:
        raise name_keys(error) from None


def modified_hamiltonian(
    scheme: inputs.SchemeLike,
    system: inputs.SystemLike | None = None,
    order: int = 4,
    *,
    parameters: inputs.ParametersLike = None,
    separable: bool = False,
) -> ModifiedEquation:
    """Return the modified equation's terms and the modified Hamiltonian H̃ = H + h H_2 + h² H_3 + ….

    The map of the scheme is the exact flow of the modified field, as a series in h. If all terms of
    the field are Hamiltonian, H̃ is the energy that the scheme keeps. The divergence of the first
    term that is not is the leading coefficient of ΔJ.

    Parameters
    ----------
    scheme: a name, 'p_next = …; q_next = …', a Scheme, or a StepMap of the same Hamiltonian.
    system: a Hamiltonian, a system's name, a formula. Without one: the Hamiltonian of the StepMap;
        else every smooth H that the scheme takes, or every H = T(p) + V(q) if `separable`.
    order: the highest power of h in the field and in H̃: 1 … 10, or 1 … 8 without a system.
    parameters: exact values by name; one without a value stays a symbol.

    Returns a ModifiedEquation: its `terms` by powers of h, the `expression` of H̃ up to the last
    term before one that is not Hamiltonian, and a `verdict` with its `reason`. Raises InputError,
    one line, for a bad argument.

    >>> modified_hamiltonian("stormer-verlet", "p**2/2 + q**4/4", 2).expression
    h**2*q**2*(6*p**2 - q**4)/24 + p**2/2 + q**4/4
    >>> equation = modified_hamiltonian("lie2", "duffing", 4)
    >>> equation.reach, equation.first_not_hamiltonian.divergence
    (1, '3*delta*p*q')
    """
    # Imported here, as `prove` does not need these modules.
    from verify.proof.plane.modified_for_every_h import MOST_ORDER as MOST_ORDER_FOR_EVERY
    from verify.proof.plane.modified_for_every_h import modified_for_every_h
    from verify.proof.plane.modified_for_one_h import MOST_ORDER, modified_for_one_h

    scheme_or_map = _resolve_scheme(scheme, system)
    whole("order", order, 1, MOST_ORDER_FOR_EVERY if system is None else MOST_ORDER)
    if system is None:
        if parameters:
            raise InputError("parameters", parameters, "goes with a system")
        if isinstance(scheme_or_map, StepMap):
            return modified_for_one_h(scheme_or_map, None, order)
        return modified_for_every_h(scheme_or_map.name, order, separable)
    if separable:
        raise InputError("separable", separable, "goes without a system")
    hamiltonian = inputs.hamiltonian_from(system, parameters)
    claims = scheme_or_map if isinstance(scheme_or_map, Scheme) else None
    return modified_for_one_h(inputs.step_map_from(scheme_or_map, hamiltonian), claims, order)


def _resolve_scheme(
    scheme: inputs.SchemeLike, system: inputs.SystemLike | None
) -> Scheme | StepMap:
    """Return the scheme. If the name is that of a system, InputError gives the right call."""
    if isinstance(scheme, str) and systems.canonical(scheme) in systems.names():
        is_swapped = isinstance(system, str) and schemes.canonical(system) in schemes.names()
        example = system if is_swapped else "stormer-verlet"
        write = f"modified_hamiltonian({example!r}, {scheme!r})"
        raise InputError("scheme", scheme, f"is a system; write {write}")
    return inputs.scheme_from(scheme)
