"""One step: our map, its Jacobian and S = JᵀΩJ − Ω are those of heyoka's Taylor integrator.

In the plane S is ΔJ. See `by_heyoka` for how it is held to the scheme lieη, and for the bounds.
Needs the extra `oracle`; without heyoka this is skipped.
"""

from fractions import Fraction
from functools import cache
from itertools import chain

import pytest

from tests.oracle.by_heyoka import (
    IN_TWO_DEGREES,
    PRECISIONS,
    STEP_SIZE,
    SYSTEMS,
    TIME,
    ZERO,
    Form,
    Point,
    Precision,
    State,
    defect,
    hy,
    oracle,
)
from verify.algebra.enclosure import enclose
from verify.algebra.ring import Poly
from verify.arithmetic.arb import midpoint_and_radius
from verify.proof.order_for_one_h import prove
from verify.schemes import get
from verify.schemes.maps.closed_form import ClosedForm

# The widest number type but heyoka's own.
WIDEST = PRECISIONS.get("quad") or PRECISIONS.get("extended") or PRECISIONS["double"]
BOTH = SYSTEMS | IN_TWO_DEGREES
POINTS: dict[int, list[Point]] = {
    1: [(Fraction(p, 8), Fraction(q, 8)) for p, q in ((4, 10), (-6, 3), (2, -12))],
    2: [(Fraction(5, 16), Fraction(-7, 16), Fraction(9, 16), Fraction(6, 16))],
}
CASES = [
    pytest.param(name, precision, eta, id=f"{name}-{precision.name}-lie{eta}")
    for name, system in BOTH.items()
    for precision in (PRECISIONS.values() if name in SYSTEMS else [WIDEST])
    for eta in precision.etas
    if eta <= system.highest
]
every_case = pytest.mark.parametrize(("name", "precision", "eta"), CASES)


def points_of(name: str) -> list[Point]:
    return POINTS[BOTH[name].hamiltonian.degrees]


def theirs(name: str, precision: Precision, eta: int, at: Point, sign: int = 1) -> State:
    """heyoka's step from a point, and the Jacobian."""
    chosen = oracle(name, precision, eta)
    chosen.start(at)
    return chosen.step(sign)


@cache
def step_of(name: str, eta: int) -> ClosedForm:
    return get(f"lie{eta}").step_map(BOTH[name].hamiltonian).flat


def value(step: ClosedForm, x: Poly, at: Point) -> Fraction:
    """Enclosed to within 2^−380."""
    point = {**dict(zip(step.field.names, at, strict=True)), "h": STEP_SIZE, "t": TIME}
    middle, radius = midpoint_and_radius(enclose(step.ring, x, point, 400))
    assert radius < Fraction(1, 2**380)
    return middle


@cache
def ours(name: str, eta: int, at: Point) -> State:
    """z' and the Jacobian."""
    step = step_of(name, eta)
    return [value(step, x, at) for x in (*step.elements, *chain(*step.jacobian))]


@cache
def our_defect(name: str, eta: int, at: Point) -> Form:
    """S by its own closed form."""
    step = step_of(name, eta)
    found: Form = dict.fromkeys(defect(ours(name, eta, at)), ZERO)
    assert step.forms is not None
    for power, coefficient in step.forms.items():
        for place, x in coefficient.entries.items():
            found[place] += STEP_SIZE**power * value(step, x, at)
    return found


def distance(precision: Precision, x: State, y: State) -> float:
    """The greatest of the differences, in units of what rounding allows."""
    return float(max(abs(a - b) / precision.rounding(b) for a, b in zip(x, y, strict=True)))


@every_case
def test_the_step_map_and_its_jacobian_are_those_of_heyoka(
    name: str, precision: Precision, eta: int
) -> None:
    for at in points_of(name):
        state = theirs(name, precision, eta, at)
        assert distance(precision, state, ours(name, eta, at)) <= 1


@every_case
def test_the_defect_in_closed_form_is_that_of_heyokas_jacobian(
    name: str, precision: Precision, eta: int
) -> None:
    for at in points_of(name):
        form, bounds = our_defect(name, eta, at), precision.defect_bounds(ours(name, eta, at))
        other = defect(theirs(name, precision, eta, at))
        assert all(abs(other[place] - x) <= bounds[place] for place, x in form.items())
        largest = max(abs(x) for x in form.values())
        assert largest > 50 * max(bounds.values()), "the bound would let S = 0 pass"


@pytest.mark.parametrize("eta", [2, 3, 4])
@pytest.mark.parametrize("name", ["duffing", *IN_TWO_DEGREES])
def test_heyokas_defect_has_the_order_and_the_leading_form_that_are_proved(
    name: str, eta: int
) -> None:
    scheme, at = get(f"lie{eta}"), points_of(name)[0]
    proof = prove(scheme.step_map(BOTH[name].hamiltonian), scheme)
    assert proof.order == eta + 1
    leading = proof.first.form
    assert leading is not None
    found = defect(theirs(name, WIDEST, eta, at))
    largest = max(abs(x) for x in found.values())
    bounds = WIDEST.defect_bounds(ours(name, eta, at))
    assert largest > 1000 * max(bounds.values()), "it is seen above heyoka's rounding"
    place = {**dict(zip(leading.names, at, strict=True)), "t": TIME}
    for (a, b), x in found.items():
        expected = midpoint_and_radius(enclose(leading.ring, leading.entry(a, b), place, 100))[0]
        assert abs(x / STEP_SIZE**proof.order - expected) < largest / STEP_SIZE**proof.order / 4


@every_case
def test_a_neighbouring_order_is_far_off(name: str, precision: Precision, eta: int) -> None:
    for at in points_of(name):
        state = theirs(name, precision, eta, at)
        for other in (eta - 1, eta + 1):
            assert distance(precision, state, ours(name, other, at)) > 100, other


@every_case
def test_a_step_backwards_is_far_off(name: str, precision: Precision, eta: int) -> None:
    for at in points_of(name):
        back, state = theirs(name, precision, eta, at, -1), ours(name, eta, at)
        assert distance(precision, back, state) > 10**10
        if eta % 2 == 0:  # S begins with h^(η+1), which changes its sign with h
            form, wrong = our_defect(name, eta, at), defect(back)
            bounds = precision.defect_bounds(state)
            assert any(abs(wrong[place] - x) > 100 * bounds[place] for place, x in form.items())


def test_heyoka_has_no_order_below_two() -> None:
    p, q = hy.make_vars("p", "q")
    taylor = hy.taylor_adaptive([(p, -q), (q, p)], [0.5, 0.5], tol=1.0)
    assert taylor.order == 2, "lie1 could be compared too"
