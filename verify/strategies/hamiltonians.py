"""The strategy of Hamiltonians, which parses drawn formulas."""

from collections.abc import Sequence

from hypothesis import strategies as st

from verify.algebra.limits import MAX_EXPONENT
from verify.errors import InputError, unknown_name
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.strategies.arguments import MOST_DEGREES, whole, yes_no, yes_no_either
from verify.strategies.formulas import KINDS as KINDS
from verify.strategies.formulas import Formula
from verify.strategies.systems import System
from verify.strategies.terms import Limits

_MOST_TERMS, _MOST_SIZE = 50, 10**9


def hamiltonians(
    kinds: Sequence[str] = KINDS,
    *,
    degree: int = 6,
    terms: int = 4,
    size: int = 9,
    separable: bool | None = None,
    bounded: bool | None = None,
    with_parameters: bool = False,
    time_dependent: bool = False,
    degrees: int = 1,
    coupled: bool | None = None,
) -> st.SearchStrategy[Hamiltonian]:
    """Return a strategy of Hamiltonians H(p, q) with rational coefficients, short, never constant.

    `kinds`: `polynomial`, `trigonometric` (sin and cos), `exponential` (exp, cosh, sinh),
    `rational` (quotients such as q/(1 + q**2), whose denominators vanish for no real p, q); one of
    those given is drawn. `degree` (1 … 64) is that of the polynomial part; `terms` (1 … 50) how
    many are added up at most; `size` (1 … 10^9) bounds the coefficients' numerators and
    denominators.

    `separable`: True for H = T(p) + V(q), False where H_pq is not the zero function, None for
    either. `bounded`: True where H → ∞ in every direction, so that H is bounded below and every
    orbit stays in a compact set; False where some ray from the origin is known along which H stays
    bounded above or falls to −∞; None for either, and for those of which neither is known. About
    one in seven of all is a quadratic form, elliptic, hyperbolic or parabolic.

    `with_parameters`: some coefficients are parameters `a` and `b`, with their values.

    `time_dependent`: H(p, q, t), by one term in t more: a force that grows, comes and goes or has a
    chirp, a stiffness or a mass that changes. `kinds` and `degree` are of H as a function of p and
    q, at each t; so is `bounded`, which must not be False: H → ∞ in every direction at each t, but
    a force in resonance drives an orbit to infinity.

    `degrees`: of freedom, 1 … 8; for more than one H(p1 … pn, q1 … qn), the sum of an H of the
    plane for each of them, of which `terms` are told, the first of the kind that is drawn, and of
    up to n − 1 terms of two degrees. `coupled`: True for one such term at least, False for a sum of
    planes, None for either. `bounded=False` is known along an axis of the first degree.

    >>> from hypothesis import Phase, find, settings
    >>> quietly = settings(database=None, phases=[Phase.generate, Phase.shrink])
    >>> find(hamiltonians(), lambda h: True, settings=quietly).formula
    'p**2/2 + q**2/2'
    >>> find(hamiltonians(time_dependent=True), lambda h: True, settings=quietly).formula
    'p**2/2 + q**2/2 + q*t'
    >>> find(hamiltonians(degrees=2, coupled=True), lambda h: True, settings=quietly).coordinates
    ('p1', 'p2', 'q1', 'q2')

    Shrinks towards p**2/2 + q**2/2. Raises InputError for a bad argument, and where no such H
    exists, when it is called and not when it draws.
    """
    if isinstance(kinds, str) or not isinstance(kinds, Sequence) or not kinds:
        raise InputError("kinds", kinds, f"is not a list of some of: {', '.join(KINDS)}")
    for kind in kinds:
        if kind not in KINDS:
            raise unknown_name("kinds", kind, KINDS)
    limits = Limits(
        whole("degree", degree, 1, MAX_EXPONENT),
        whole("terms", terms, 1, _MOST_TERMS),
        whole("size", size, 1, _MOST_SIZE),
    )
    yes_no_either("separable", separable)
    yes_no_either("bounded", bounded)
    yes_no("with_parameters", with_parameters)
    yes_no("time_dependent", time_dependent)
    if time_dependent and bounded is False:
        raise InputError("bounded", bounded, "is not known of an H in time; allowed: True, None")
    whole("degrees", degrees, 1, MOST_DEGREES)
    if yes_no_either("coupled", coupled) and degrees == 1:
        raise InputError("coupled", coupled, "wants two degrees of freedom or more")
    system = System(
        degrees, limits, tuple(kinds), separable, bounded, coupled, with_parameters, time_dependent
    )
    return system.formulas().map(Formula.hamiltonian)
