"""One step: our map, its Jacobian and ΔJ are those of heyoka's Taylor integrator.

See `by_heyoka` for how it is held to the scheme lieη, and for the bounds. Needs the extra
`oracle`; without heyoka this is skipped.
"""

from fractions import Fraction
from functools import cache

import pytest

from tests.oracle.by_heyoka import (
    PRECISIONS,
    STEP_SIZE,
    SYSTEMS,
    Point,
    Precision,
    State,
    determinant,
    hy,
    oracle,
)
from verify.algebra.enclosure import enclose
from verify.arithmetic.arb import midpoint_and_radius
from verify.schemes import get

POINTS = [(Fraction(p, 8), Fraction(q, 8)) for p, q in ((4, 10), (-6, 3), (2, -12))]
every_case = pytest.mark.parametrize(
    ("name", "precision", "eta"),
    [
        pytest.param(name, precision, eta, id=f"{name}-{precision.name}-lie{eta}")
        for name, system in SYSTEMS.items()
        for precision in PRECISIONS.values()
        for eta in precision.etas
        if eta <= system.highest
    ],
)


def theirs(name: str, precision: Precision, eta: int, at: Point, sign: int = 1) -> State:
    """heyoka's step from a point, and the Jacobian."""
    chosen = oracle(name, precision, eta)
    chosen.start(at)
    return chosen.step(sign)


@cache
def ours(name: str, eta: int, at: Point) -> tuple[State, Fraction]:
    """p', q' and the Jacobian; and ΔJ by its own closed form. Enclosed to within 2^−380."""
    step = get(f"lie{eta}").step_map(SYSTEMS[name].hamiltonian).flat
    point = {"p": at[0], "q": at[1], "h": STEP_SIZE}
    found = []
    for x in (*step.elements, *step.jacobian[0], *step.jacobian[1], step.delta_j):
        middle, radius = midpoint_and_radius(enclose(step.ring, x, point, 400))
        assert radius < Fraction(1, 2**380)
        found.append(middle)
    return found[:-1], found[-1]


def distance(precision: Precision, x: State, y: State) -> float:
    """The greatest of the six differences, in units of what rounding allows."""
    return float(max(abs(a - b) / precision.rounding(b) for a, b in zip(x, y, strict=True)))


@every_case
def test_the_step_map_and_its_jacobian_are_those_of_heyoka(
    name: str, precision: Precision, eta: int
) -> None:
    for at in POINTS:
        state, _ = ours(name, eta, at)
        assert distance(precision, theirs(name, precision, eta, at), state) <= 1


@every_case
def test_delta_j_in_closed_form_is_the_determinant_of_heyoka_less_one(
    name: str, precision: Precision, eta: int
) -> None:
    for at in POINTS:
        state, delta_j = ours(name, eta, at)
        bound = precision.determinant_bound(state)
        assert abs(determinant(theirs(name, precision, eta, at)) - 1 - delta_j) <= bound
        assert abs(delta_j) > 50 * bound, "the bound would let ΔJ = 0 pass"


@every_case
def test_a_neighbouring_order_is_far_off(name: str, precision: Precision, eta: int) -> None:
    for at in POINTS:
        state = theirs(name, precision, eta, at)
        for other in (eta - 1, eta + 1):
            assert distance(precision, state, ours(name, other, at)[0]) > 100, other


@every_case
def test_a_step_backwards_is_far_off(name: str, precision: Precision, eta: int) -> None:
    for at in POINTS:
        back, (state, delta_j) = theirs(name, precision, eta, at, -1), ours(name, eta, at)
        assert distance(precision, back, state) > 10**10
        if eta % 2 == 0:  # ΔJ begins with h^(η+1), which changes its sign with h
            wrong = abs(determinant(back) - 1 - delta_j)
            assert wrong > 100 * precision.determinant_bound(state)


def test_heyoka_has_no_order_below_two() -> None:
    p, q = hy.make_vars("p", "q")
    taylor = hy.taylor_adaptive([(p, -q), (q, p)], [0.5, 0.5], tol=1.0)
    assert taylor.order == 2, "lie1 could be compared too"
