"""Users' steps to their verdicts: right ones are never refuted, and planted errors always are."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.programs import henon_steps, user_steps
from tests.helpers.programs.blind import blind
from tests.helpers.programs.henon_steps import DRIVEN, HENON
from tests.helpers.programs.judged import judged
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.measures.survey import Request
from verify.integrators.results import Claims

Step = Callable[..., Any]
LEFT = pytest.mark.left_to_ci
PENDULUM = "p**2/2 - cos(q)"


@dataclass(frozen=True)
class Right:
    """A right step: its map has this order, and `defect` is that of S, None where S is 0.

    `keeps`: whether Ω, and volume; in the plane they are one, and `defect` tells it.
    """

    step: Step
    order: int
    defect: int | None = None
    how: str = "proof"
    formula: str = PENDULUM
    keeps: tuple[bool, bool] | None = None

    @property
    def kept(self) -> tuple[bool, bool]:
        return self.keeps or (self.defect is None, self.defect is None)


IN_THE_PLANE = {
    "euler_a": Right(user_steps.euler_a, 1),
    "euler_b": Right(user_steps.euler_b, 1),
    "verlet": Right(user_steps.verlet, 2),
    "lie2": Right(user_steps.lie2, 2, 3),
    "rk4": Right(user_steps.rk4, 4, 6),
    "explicit": Right(user_steps.explicit, 1, 2),
    "yoshida": Right(user_steps.yoshida, 4, how="duals"),
    "vectorised": Right(user_steps.vectorised, 1),
    "midpoint_until": Right(user_steps.midpoint_until, 2, how="duals"),
    "midpoint_loosely": Right(user_steps.midpoint_loosely, 2, how="duals"),
    "midpoint_by_newton": Right(user_steps.midpoint_by_newton, 2, how="duals"),
    "branching": Right(user_steps.branching, 1, how="duals"),
    "substeps": Right(user_steps.substeps, 2, how="duals"),
    "only_floats": Right(user_steps.only_floats, 1, how="floats"),
}
OF_ARRAYS = {
    "arrays: verlet": Right(henon_steps.verlet, 2, formula=HENON),
    "arrays: euler": Right(henon_steps.euler, 1, 2, formula=HENON),
    "arrays: rk4": Right(henon_steps.rk4, 4, 5, formula=HENON),
    "arrays: skewed": Right(henon_steps.skewed, 2, 3, formula=HENON, keeps=(False, True)),
    "arrays: q_first": Right(henon_steps.q_first, 2, formula=HENON),
    "arrays: lists": Right(henon_steps.taking_lists, 2, formula=HENON),
    "arrays: kepler": Right(henon_steps.kepler, 2, formula=henon_steps.KEPLER),
    "arrays: not separable": Right(
        henon_steps.explicit_midpoint_of_rotating, 2, 3, formula=henon_steps.ROTATING
    ),
    "arrays: of roots": Right(henon_steps.verlet_of_roots, 2, formula=henon_steps.ROOTS),
    "arrays: driven by a still clock": Right(henon_steps.driven_at(0, 0), 1, formula=DRIVEN),
    "arrays: yoshida": Right(henon_steps.yoshida, 4, how="duals", formula=HENON),
}
ITERATED = {
    "arrays: midpoint": Right(henon_steps.midpoint, 2, how="duals", formula=HENON),
    "arrays: trapezoid": Right(henon_steps.trapezoid, 2, 3, "duals", HENON),
}
IN_FLOATS = {
    "floats: verlet": Right(blind(henon_steps.verlet), 2, how="floats", formula=HENON),
    "floats: euler": Right(blind(henon_steps.euler), 1, 2, "floats", HENON),
    "floats: rk4": Right(  # its S is seen to be none, and no power of h
        blind(henon_steps.rk4), 4, None, "floats", HENON, (False, False)
    ),
    "floats: yoshida": Right(blind(henon_steps.yoshida), 4, how="floats", formula=HENON),
}
SLOW = ITERATED | IN_FLOATS
RIGHT = IN_THE_PLANE | OF_ARRAYS | SLOW
# Iterations that stop before doubles do: what they leave is allowed by whoever uses them.
TOLERANCES = {"midpoint_until": Fraction(1, 10**11), "midpoint_loosely": Fraction(1, 10**7)}


def in_part(count: int, *others: str) -> list[Any]:
    """The names of a sample in the plane, and of the others in two degrees of freedom."""
    marks = (LEFT, pytest.mark.sample(count))
    own = [pytest.param(name, marks=marks) for name in IN_THE_PLANE]
    return own + [pytest.param(name, marks=LEFT if name in SLOW else ()) for name in others]


@pytest.mark.parametrize("name", in_part(8, *OF_ARRAYS, *SLOW))
def test_a_right_step_is_told_its_orders_and_its_claims_hold(name: str) -> None:
    right, within = RIGHT[name], TOLERANCES.get(name)
    symplectic, volume = right.kept
    area_order = right.defect if right.how == "proof" else None
    claims = Claims(right.order, area_order, volume, symplectic)
    found = judged(right.step, claims, hamiltonian=right.formula, request=Request(within=within))
    verdict = "PROVED" if right.how == "proof" else "MEASURED"
    assert (found.verdict, found.how) == (verdict, right.how), found
    assert (found.convergence_order, found.order_decided) == (right.order, True)
    assert found.order == right.defect
    assert (found.symplectic, found.area_preserving) == right.kept
    assert found.counterexample is None
    if found.proof is not None:
        assert found.proof.order == right.defect
    else:
        assert f"the map's order is {right.order}" in str(found.reason)


@pytest.mark.parametrize("name", TOLERANCES)
def test_a_tolerance_that_nobody_allows_is_refuted_and_named(name: str) -> None:
    found = judged(RIGHT[name].step, Claims(order=2, area_preserving=True))
    assert found.verdict == "REFUTED"
    assert "an iteration that stops, at a tolerance of at least" in found.reason
    assert judged(RIGHT[name].step, Claims(order=2)).verdict == "MEASURED"


@LEFT
@pytest.mark.parametrize("name", in_part(4, "arrays: verlet", "arrays: midpoint", *IN_FLOATS))
def test_one_order_too_many_is_refuted_with_a_counterexample(name: str) -> None:
    right = RIGHT[name]
    found = judged(right.step, Claims(order=right.order + 1), hamiltonian=right.formula)
    assert found.verdict == "REFUTED"
    assert f"order {right.order + 1} is claimed; the map agrees with the exact flow up to " in (
        found.reason
    )
    assert f"up to h^{right.order} only" in str(found.reason)
    assert found.counterexample is not None
    assert float(found.counterexample.found) > 0
    if right.defect is not None and name in IN_THE_PLANE:
        for claims in (Claims(area_order=right.defect + 1), Claims(area_preserving=True)):
            found = judged(right.step, claims)
            assert found.verdict == "REFUTED"
            assert found.counterexample is not None
            assert "det J" in found.counterexample.quantity


CLAIMED = {
    "nearly Verlet's area": (
        user_steps.nearly_verlet, PENDULUM, Claims(area_preserving=True), "REFUTED", ""),
    "nearly Yoshida's area": (
        user_steps.nearly_yoshida, PENDULUM, Claims(area_preserving=True), "PROVED", ""),
    "nearly Verlet's order": (user_steps.nearly_verlet, PENDULUM, Claims(order=2), "REFUTED", ""),
    "nearly Verlet's less": (user_steps.nearly_verlet, PENDULUM, Claims(order=1), "PROVED", ""),
    "nearly Yoshida's order": (user_steps.nearly_yoshida, PENDULUM, Claims(order=4), "REFUTED", ""),
    "nearly Yoshida's less": (user_steps.nearly_yoshida, PENDULUM, Claims(order=1), "PROVED", ""),
    "RK4's form": (henon_steps.rk4, HENON, Claims(symplectic=True), "REFUTED",
                "that it is symplectic is claimed; S has order 5"),
    "RK4's volume": (henon_steps.rk4, HENON, Claims(area_order=6), "PROVED", ""),
    "RK4's volume, one more": (henon_steps.rk4, HENON, Claims(area_order=7), "REFUTED",
                               "is claimed; det J − 1 has order 6"),
    "skewed form": (henon_steps.skewed, HENON, Claims(symplectic=True), "REFUTED", "S has order 3"),
    "the trapezoid's form": (henon_steps.trapezoid, HENON, Claims(symplectic=True), "REFUTED", ""),
}  # fmt: skip


@pytest.mark.parametrize(
    ("step", "formula", "claims", "verdict", "words"),
    [
        pytest.param(*row, marks=() if name.endswith("area") else LEFT, id=name)
        for name, row in CLAIMED.items()
    ],
)
def test_a_claim_is_judged_apart_from_what_else_the_step_does(
    step: Step, formula: str, claims: Claims, verdict: str, words: str
) -> None:
    found = judged(step, claims, hamiltonian=formula)
    assert (found.verdict, words in found.reason) == (verdict, True), found.reason


@LEFT
def test_an_iteration_that_stops_early_does_not_preserve_area_exactly() -> None:
    found = judged(user_steps.midpoint_iterated, Claims(order=2, area_order=12))
    assert found.verdict == "PROVED"
    assert found.area_preserving is False


@LEFT
def test_newton_with_three_corrections_preserves_area_to_the_noise_where_h_is_small() -> None:
    """Its ΔJ of h^13 drowns in doubles below h = 1/2, and is seen at h = 1, where that is asked."""
    assert judged(user_steps.newton_thrice, Claims(order=2, area_order=12)).verdict == "MEASURED"
    assert judged(user_steps.newton_thrice, Claims(area_preserving=True)).verdict == "MEASURED"
    large = Request(step_size=Fraction(1))
    found = judged(user_steps.newton_thrice, Claims(area_preserving=True), request=large)
    assert found.verdict == "REFUTED"
    assert "O(h^13), as where an iteration ends early" in found.reason


@pytest.mark.parametrize(
    ("step", "formula", "claims"),
    [
        pytest.param(user_steps.flipped, PENDULUM, Claims(), id="flipped"),
        pytest.param(henon_steps.no_potential, HENON, Claims(), id="no potential"),
        pytest.param(henon_steps.one_exchanged, HENON, Claims(), id="one exchanged"),
        pytest.param(henon_steps.wrong_weights, HENON, Claims(order=4), id="wrong weights"),
        pytest.param(
            blind(henon_steps.no_potential), HENON, Claims(), marks=LEFT, id="floats: no potential"
        ),
        pytest.param(
            blind(henon_steps.wrong_weights), HENON, Claims(), marks=LEFT, id="floats: weights"
        ),
    ],
)
def test_what_does_not_approximate_the_flow_is_no_scheme(
    step: Step, formula: str, claims: Claims
) -> None:
    found = judged(step, claims, hamiltonian=formula)
    assert (found.verdict, found.convergence_order) == ("REFUTED", 0)
    assert "not a scheme for this H" in found.reason
    assert found.counterexample is not None


def test_rounded_coefficients_are_neither_a_proof_nor_an_error() -> None:
    found = judged(user_steps.yoshida)
    assert found.verdict == "MEASURED"
    assert "but for the rounding of its coefficients" in found.reason
    assert "det J ≡ 1, proved" in found.reason
    assert any("1.35120719195965" in note for note in found.notes)


def euler_of_root(p: Any, q: Any, h: Any) -> Any:
    p = p - h / (2 * math.sqrt(q - 5))
    return p, q + h * p


def test_a_step_that_fails_where_h_is_not_defined_is_not_refuted() -> None:
    assert judged(euler_of_root, hamiltonian="p**2/2 + sqrt(q - 5)").verdict == "PROVED"
    with pytest.raises(InputError, match="raises ValueError"):
        judged(euler_of_root)


@pytest.mark.parametrize(
    ("step", "formula"),
    [
        pytest.param(euler_of_root, "p**2/2 + sqrt(q - 5) + sqrt(4 - q)", id="n = 1"),
        pytest.param(
            henon_steps.verlet_of_roots, f"{henon_steps.ROOTS} + sqrt(4 - q1)", id="n = 2"
        ),
        pytest.param(
            blind(lambda p, q, h: (p, q)),
            "p1**2/2 + p2**2/2 + sqrt(q1 - 50)**3 + sqrt(40 - q1) + q2**2",
            id="n = 2, in floats",
        ),
    ],
)
def test_where_h_has_no_exact_solution_the_order_is_undecided(step: Step, formula: str) -> None:
    """Every place that is tried lies outside of where H is smooth."""
    for claims in (Claims(), Claims(order=2)):
        found = judged(step, claims, 0.5, formula)
        assert (found.verdict, found.order_decided) == ("UNDECIDED", False)
        assert "H has no exact solution from any of the places" in found.reason


def test_a_parameter_of_the_hamiltonian_is_given_by_name() -> None:
    quartic = Hamiltonian.parse("p**2/2 + c*q**4/4", {"c": "1/10"})

    def step(p: Any, q: Any, h: Any, *, c: Any) -> Any:
        p = p - h * c * q**3
        return p, q + h * p

    assert judged(step, hamiltonian=quartic).verdict == "PROVED"
    for right, formula in (
        (user_steps.verlet, "p**2/2 + c*q**4/4"),
        (henon_steps.verlet, "(p1**2 + p2**2)/2 + k*q1**2*q2"),
    ):
        with pytest.raises(InputError, match="has no value"):
            judged(right, hamiltonian=formula)


def test_a_map_that_is_not_the_identity_at_h_0_is_no_scheme() -> None:
    def step(p: Any, q: Any, h: Any) -> Any:
        p, q = user_steps.verlet(p, q, h)
        return p + 1e-12, q

    found = judged(step)
    assert (found.verdict, found.convergence_order) == ("REFUTED", -1)
    assert found.reason.endswith("not even at h = 0")


def test_names_that_do_not_tell_take_the_order_that_fits() -> None:
    def step(x: Any, y: Any, z: Any) -> Any:
        return user_steps.euler_b(x, y, z)

    found = judged(step)
    assert found.verdict == "PROVED"
    assert "its arguments (x, y, z) are taken as (q, p, h), the order that fits" in found.notes
    assert not any("the order that" in note for note in judged(user_steps.flipped).notes)
