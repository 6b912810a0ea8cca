"""`verify.check` and `verify.check_map`: verification of a user's step function or map.

`check` also takes a scheme, which it proves; `check_map` decides whether a map is symplectic, or
what else it keeps, and needs no H.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

from verify.arithmetic.exact import Number, NumberOrList, positive, rational, whole
from verify.calls import inputs
from verify.calls.prove import prove as prove_structures_of
from verify.errors import InputError
from verify.hamiltonians.coordinates import check_degrees, coordinates_in
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.map_claims import MapSystem, coordinates_from
from verify.integrators.measures.survey import Request
from verify.integrators.results import MOST_CLAIMED, Claims, Finding
from verify.integrators.step_check import check_map as judge_map
from verify.integrators.step_check import check_step
from verify.integrators.user_code.coordinate_layout import callee_of_coordinates
from verify.integrators.user_code.loading import Callee, callee_from
from verify.integrators.user_code.step import TIME_LIMIT
from verify.proof.order_for_one_h import prove
from verify.proof.proof_for_one_h import Proof
from verify.proof.structures.structures_proof import StructuresProof
from verify.scenes.keeps_section import read_claims
from verify.schemes.scheme import Scheme


def check(
    system: inputs.SystemLike,
    step: Callable[..., Any] | inputs.SchemeLike,
    *,
    parameters: inputs.ParametersLike = None,
    order: int | None = None,
    area_preserving: bool = False,
    symplectic: bool = False,
    arguments: inputs.Texts | None = None,
    p: NumberOrList | None = None,
    q: NumberOrList | None = None,
    step_size: Number | None = None,
    within: Number | None = None,
    keeps: inputs.Texts = (),
    form: str = "",
    density: str = "",
    poisson: str = "",
    casimirs: inputs.Texts = (),
    reverses: str = "",
    factor: str = "",
    point: Sequence[Number] | None = None,
    time_limit: float = TIME_LIMIT,
) -> Finding | Proof | StructuresProof:
    """Decide whether a step is a scheme for H and what it preserves: by proof, or by measuring.

    Parameters
    ----------
    system, parameters: as in `verify.run`.
    step: a function step(p, q, h), or step(p, q, t, h) for an H in t, that returns p' and q'; it
        is called. Or a scheme's name, 'p_next = …; q_next = …', a Scheme or a StepMap; these are
        proved.
    order: the claimed order of convergence, which a higher one satisfies too, 1 … 12; by default
        the order that a scheme itself claims.
    area_preserving, symplectic: True claims det J ≡ 1, or JᵀΩJ ≡ Ω, which is the same in one degree
        of freedom.
    arguments: their order, such as "q,p,h" or ["q", "p", "h"], if the names of the function's
        arguments do not tell.
    q, p: the first state to try, numbers or, in n degrees of freedom, lists of n numbers.
    step_size: the largest step size to try.
    within: an allowed defect.
    keeps, form, …, factor: structures that the step is meant to keep, as in `verify.prove`. Then
        only they are judged, and the order if it is claimed. The system may be equations, as
        'u_dot = u*(v - 2); v_dot = v*(1 - u)', and the step is then step(u, v, h) or step(z, h).
    point: the first state to try, all coordinates, in place of `q` and `p`.
    time_limit: seconds for the whole check.

    For a function, returns a Finding: its `verdict` with the `reason`, its `order` and
    `convergence_order`, and a `counterexample` if it is refuted at a point; `keeps` has the verdict
    on each structure. For a scheme, returns a Proof or a StructuresProof, as `verify.prove` does.
    Raises InputError, one line.

    >>> euler = check("harmonic", lambda p, q, h: (p - h * q, q + h * p), parameters={"omega": 1})
    >>> str(euler.verdict), euler.area_preserving, euler.order
    ('PROVED', False, 2)
    >>> lotka = check(
    ...     "u_dot = u*(v - 2); v_dot = v*(1 - u)",
    ...     lambda u, v, h: (u / (1 - h * (v - 2)), v + h * v * (1 - u / (1 - h * (v - 2)))),
    ...     form="du^dv/(u*v)",
    ... )
    >>> str(lotka.verdict), str(lotka.keeps[0].reason)
    ('PROVED', "S = Jᵀω(z')J − ω(z) is 0 at every step")
    """
    request = inputs.keeps_request(keeps, form, density, poisson, casimirs, reverses, factor)
    hamiltonian = inputs.hamiltonian_from(system, parameters, takes_field=True)
    if order is not None:
        order = whole("order", order, 1, MOST_CLAIMED)
    for name, claimed in (("area_preserving", area_preserving), ("symplectic", symplectic)):
        if not isinstance(claimed, bool):
            raise InputError(name, claimed, "must be True or False")
    if not callable(step) or isinstance(step, Scheme):
        if request:
            refinements = {name: x for name, x in vars(request).items() if name != "keeps"}
            return prove_structures_of(hamiltonian, step, keeps=request.keeps, **refinements)
        scheme = inputs.scheme_from(step)
        step_map = inputs.step_map_from(scheme, hamiltonian)
        claims_symplectic = symplectic or (area_preserving and hamiltonian.degrees == 1)
        # If n > 1, det J ≡ 1 is weaker than JᵀΩJ ≡ Ω, and a scheme's proof decides the latter.
        if area_preserving and not claims_symplectic:
            problem = "of a scheme in several degrees of freedom symplectic=True is claimed"
            raise InputError("area_preserving", area_preserving, problem)
        # Without a claim of the caller the scheme's own claims are checked.
        if isinstance(scheme, Scheme) and order is None and not claims_symplectic:
            return prove(step_map, scheme)
        return prove(step_map, _with_claims(scheme, order, claims_symplectic))
    callee = callee_of_system(hamiltonian, step, arguments, time_limit)
    claims = Claims(order=order, area_preserving=area_preserving, symplectic=symplectic)
    structures = read_claims(request, hamiltonian) if request else ()
    where = request_of(hamiltonian, p, q, step_size, within, point)
    return check_step(callee, hamiltonian, claims, structures, where)


def callee_of_system(
    system: Hamiltonian, step: Callable[..., Any], arguments: inputs.Texts | None, time_limit: float
) -> Callee:
    """Return a step of H, or of equations, as a callee. Raises InputError."""
    if system.energy is not None:
        return callee_from(
            step, system.coordinates, arguments=inputs.names_from("arguments", arguments),
            parameters=dict(system.values),
            time_limit=time_limit,
        )  # fmt: skip
    if arguments is not None:
        raise InputError("arguments", arguments, "goes with an H; the names of coordinates tell")
    return callee_of_coordinates(
        step, system.coordinates, stepped=True, parameters=dict(system.values),
        time_limit=time_limit,
    )  # fmt: skip


def check_map(
    function: Callable[..., Any],
    degrees: int = 1,
    *,
    arguments: inputs.Texts | None = None,
    parameters: Mapping[str, Number] | None = None,
    point: Sequence[Number] | None = None,
    within: Number | None = None,
    coordinates: inputs.Texts | None = None,
    keeps: inputs.Texts = (),
    form: str = "",
    density: str = "",
    poisson: str = "",
    casimirs: inputs.Texts = (),
    reverses: str = "",
    factor: str = "",
    time_limit: float = TIME_LIMIT,
) -> Finding:
    """Decide whether a map is symplectic, JᵀΩJ = Ω everywhere: by proof, or by measuring.

    With `coordinates` or `keeps` other structures are judged, and only those that are named;
    volume, if none is.

    Parameters
    ----------
    function: map(p, q) → p', q', of numbers if `degrees` is 1, otherwise of arrays of `degrees`
        numbers; or map(z) → z' of one array of 2·degrees numbers. It is called.
    arguments: the order of the coordinates in z, such as "q1,p1,q2,p2"; by default p1, …, pn, q1,
        …, qn.
    parameters: the exact values of further arguments, which the function takes by name.
    point: the first point to try, 2·degrees numbers p1, …, pn, q1, …, qn.
    within: an allowed defect.
    coordinates: the names of the arguments, flattened, in their order, as "v1,v2,x1,x2" or
        ["v1", "v2", "x1", "x2"]; any number. By default p1, …, pn, q1, …, qn.
    keeps, form, …, factor: structures that the map is meant to keep, as in `verify.prove`.
    time_limit: seconds for all calls.

    Returns a Finding: its `verdict` with the `reason`, `symplectic` and `area_preserving`, and the
    `entry` of S = JᵀΩJ − Ω that is not 0, if there is one. Raises InputError, one line.

    >>> shear = check_map(lambda p, q: ([p[0] - q[1], p[1] - q[0]], q), degrees=2)
    >>> str(shear.verdict), shear.symplectic
    ('PROVED', True)
    >>> mixed = check_map(lambda p, q: ([2 * p[0], p[1]], [q[0], q[1] / 2]), degrees=2)
    >>> str(mixed.verdict), mixed.entry, mixed.area_preserving
    ('REFUTED', 'dp1∧dq1', True)
    >>> logistic = check_map(lambda x, y: (2 * x, y / 2), coordinates="x,y", density="1/(x*y)")
    >>> str(logistic.verdict), logistic.keeps[0].structure.label
    ('PROVED', 'volume with the density 1/(x*y)')
    """
    if not callable(function):
        raise InputError("map", function, "is no function; wanted: map(p, q), which returns p', q'")
    check_degrees(degrees)
    request = inputs.keeps_request(keeps, form, density, poisson, casimirs, reverses, factor)
    own_names = inputs.names_from("coordinates", coordinates)
    names = coordinates_in(degrees) if own_names is None else coordinates_from(own_names)
    values = {n: rational(x, f"parameter {n}") for n, x in (parameters or {}).items()}
    if coordinates is None:
        callee = callee_from(
            # `stepped=False`: the map has no step size h among its arguments.
            function, names, stepped=False, arguments=inputs.names_from("arguments", arguments),
            parameters=values, strict=True, time_limit=time_limit,
        )  # fmt: skip
    elif arguments is not None:
        raise InputError("arguments", arguments, "goes without coordinates")
    else:
        callee = callee_of_coordinates(
            function, names, stepped=False, parameters=values, time_limit=time_limit
        )
    tolerance = None if within is None else positive(within, "within")
    where = Request(z=_point_of(names, point), within=tolerance)
    if request or coordinates is not None:
        try:
            return judge_map(callee, MapSystem(names, values).read(request), where)
        except InputError as error:  # it names an option of the command line
            name = error.name.removeprefix("--")
            raise type(error)(name, error.value, error.problem) from None
    return judge_map(callee, (), where)


def _point_of(names: Sequence[str], point: Sequence[Number] | None) -> tuple[Fraction, ...] | None:
    if point is None:
        return None
    z = tuple(rational(x, "point") for x in point)
    if len(z) != len(names):
        raise InputError("point", point, f"has {len(z)} numbers; allowed: {len(names)}")
    return z


def request_of(
    hamiltonian: Hamiltonian,
    p: NumberOrList | None,
    q: NumberOrList | None,
    step_size: Number | None = None,
    within: Number | None = None,
    point: Sequence[Number] | None = None,
) -> Request:
    """Return the request for a first place to try, from a caller's arguments; or InputError."""
    if (p is None) != (q is None):
        raise InputError("p, q", p if p is not None else q, "give both or none")
    if p is not None and (point is not None or hamiltonian.energy is None):
        raise InputError("p, q", p, "goes with an H, and without point")
    z = list(_point_of(hamiltonian.coordinates, point) or ())
    for name, values in (("p", p), ("q", q)):
        coordinates: list[Any] = [] if values is None else _as_list(values)
        if values is not None and len(coordinates) != hamiltonian.degrees:
            problem = f"has {len(coordinates)} numbers; allowed: {hamiltonian.degrees}"
            raise InputError(name, values, problem)
        z += [rational(x, name) for x in coordinates]
    return Request(
        z=tuple(z) or None,
        step_size=None if step_size is None else positive(step_size, "step_size"),
        within=None if within is None else positive(within, "within"),
    )


def _as_list(value: Any) -> list[Any]:
    # A text such as "1/3" is one number, though it has a length.
    has_several = hasattr(value, "__len__") and not isinstance(value, str)
    return list(value) if has_several else [value]


def _with_claims(scheme: Any, order: int | None, area_preserving: bool) -> Scheme | None:
    """Return the scheme with these claims in place of its own; None for a step map without any.

    A scheme always claims an order, at least 1.
    """
    if isinstance(scheme, Scheme):
        return replace(scheme, order=order or 1, area_preserving=area_preserving)
    if order is None and not area_preserving:
        return None
    return Scheme("the step map", order or 1, area_preserving, True, False, "", lambda _: scheme)
