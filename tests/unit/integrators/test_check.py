"""Users' steps to their verdicts: right ones are never refuted, and planted errors always are."""

import math
from collections.abc import Callable
from contextlib import suppress
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from tests.helpers.programs import user_steps as own_steps
from tests.helpers.programs.judged import judged as found_of
from verify.algebra.formula import parse
from verify.errors import InputError
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.measures.survey import Request
from verify.integrators.results import Claims
from verify.proof.order_for_one_h import prove
from verify.schemes import get

Function = Callable[..., Any]


RIGHT = [
    # function, how, verdict, order of the map, det J ≡ 1 or else the order of ΔJ
    (own_steps.euler_a, "proof", "PROVED", 1, None),
    (own_steps.euler_b, "proof", "PROVED", 1, None),
    (own_steps.verlet, "proof", "PROVED", 2, None),
    (own_steps.lie2, "proof", "PROVED", 2, 3),
    (own_steps.rk4, "proof", "PROVED", 4, 6),
    (own_steps.explicit, "proof", "PROVED", 1, 2),
    (own_steps.yoshida, "duals", "MEASURED", 4, None),
    (own_steps.vectorised, "proof", "PROVED", 1, None),
    (own_steps.midpoint_until, "duals", "MEASURED", 2, None),
    (own_steps.midpoint_loosely, "duals", "MEASURED", 2, None),
    (own_steps.midpoint_by_newton, "duals", "MEASURED", 2, None),
    (own_steps.branching, "duals", "MEASURED", 1, None),
    (own_steps.substeps, "duals", "MEASURED", 2, None),
    (own_steps.only_floats, "floats", "MEASURED", 1, None),
]


# Iterations that stop before doubles do: what they leave is allowed by whoever uses them.
TOLERANCES = {own_steps.midpoint_until: Fraction(1, 10**11),
              own_steps.midpoint_loosely: Fraction(1, 10**7)}  # fmt: skip
NAMES = [row[0].__name__ for row in RIGHT]


@pytest.mark.left_to_ci
@pytest.mark.sample(8)
@pytest.mark.parametrize(("function", "how", "verdict", "order", "area"), RIGHT, ids=NAMES)
def test_a_right_step_is_told_its_orders_and_its_claims_hold(
    function: Function, how: str, verdict: str, order: int, area: int | None
) -> None:
    request = Request(within=TOLERANCES.get(function))
    found = found_of(function, Claims(order, area, area is None), request=request)
    assert (found.verdict, found.how) == (verdict, how), found
    assert (found.convergence_order, found.order) == (order, area)
    assert found.area_preserving is (area is None)
    assert found.counterexample is None


@pytest.mark.parametrize("function", TOLERANCES, ids=lambda f: f.__name__)
def test_a_tolerance_that_nobody_allows_is_refuted_and_named(function: Function) -> None:
    found = found_of(function, Claims(order=2, area_preserving=True))
    assert found.verdict == "REFUTED"
    assert "an iteration that stops, at a tolerance of at least" in found.reason
    assert found_of(function, Claims(order=2)).verdict == "MEASURED"


@pytest.mark.left_to_ci
@pytest.mark.sample(4)
@pytest.mark.parametrize(
    ("function", "order", "area"), [(r[0], r[3], r[4]) for r in RIGHT], ids=NAMES
)
def test_one_order_too_many_is_refuted_with_a_counterexample(
    function: Function, order: int, area: int | None
) -> None:
    found = found_of(function, Claims(order=order + 1))
    assert found.verdict == "REFUTED"
    assert found.counterexample is not None
    assert float(found.counterexample.found) > 0
    if area is not None:
        for claims in (Claims(area_order=area + 1), Claims(area_preserving=True)):
            found = found_of(function, claims)
            assert found.verdict == "REFUTED"
            assert found.counterexample is not None
            assert "det J" in found.counterexample.quantity


@pytest.mark.left_to_ci
def test_an_iteration_that_stops_early_does_not_preserve_area_exactly() -> None:
    found = found_of(own_steps.midpoint_iterated, Claims(order=2, area_order=12))
    assert found.verdict == "PROVED"
    assert found.area_preserving is False


@pytest.mark.left_to_ci
def test_newton_with_three_corrections_preserves_area_to_the_noise_where_h_is_small() -> None:
    """Its ΔJ of h^13 drowns in doubles below h = 1/2, and is seen at h = 1, where that is asked."""
    assert found_of(own_steps.newton_thrice, Claims(order=2, area_order=12)).verdict == "MEASURED"
    assert found_of(own_steps.newton_thrice, Claims(area_preserving=True)).verdict == "MEASURED"
    large = Request(step_size=Fraction(1))
    found = found_of(own_steps.newton_thrice, Claims(area_preserving=True), request=large)
    assert found.verdict == "REFUTED"
    assert "O(h^13), as where an iteration ends early" in found.reason


def test_a_flipped_sign_is_no_scheme() -> None:
    found = found_of(own_steps.flipped)
    assert found.verdict == "REFUTED"
    assert "not a scheme" in found.reason
    assert found.counterexample is not None


@pytest.mark.left_to_ci
@pytest.mark.parametrize(
    ("function", "order"), [(own_steps.nearly_verlet, 2), (own_steps.nearly_yoshida, 4)]
)
def test_a_wrong_coefficient_misses_the_order_and_keeps_the_rest(
    function: Function, order: int
) -> None:
    assert found_of(function, Claims(order=order)).verdict == "REFUTED"
    assert found_of(function, Claims(order=1)).verdict == "PROVED"


def test_a_wrong_coefficient_in_verlet_spoils_the_area() -> None:
    assert found_of(own_steps.nearly_verlet, Claims(area_preserving=True)).verdict == "REFUTED"
    assert found_of(own_steps.nearly_yoshida, Claims(area_preserving=True)).verdict == "PROVED"


def test_rounded_coefficients_are_neither_a_proof_nor_an_error() -> None:
    found = found_of(own_steps.yoshida)
    assert found.verdict == "MEASURED"
    assert "but for the rounding of its coefficients" in found.reason
    assert "det J ≡ 1, proved" in found.reason
    assert any("1.35120719195965" in note for note in found.notes)


@pytest.mark.parametrize(
    ("function", "verdict", "fault", "said"),
    [
        (own_steps.frozen, "REFUTED", "frozen", "preserves area and is no scheme"),
        (own_steps.without_h, "REFUTED", "ignores h", "it ignores h"),
        (own_steps.drawn, "UNDECIDED", "not a function", "not deterministic"),
        (own_steps.counting, "UNDECIDED", "not a function", "not deterministic"),
    ],
)
def test_what_is_wrong_is_named(function: Function, verdict: str, fault: str, said: str) -> None:
    found = found_of(function)
    assert (found.verdict, found.how, found.faults) == (verdict, "calls", (fault,))
    assert said in found.reason


def test_a_state_that_shows_after_many_calls_is_found_at_the_end() -> None:
    calls = [0]

    def step(p: Any, q: Any, h: Any) -> Any:
        calls[0] += 1
        p, q = own_steps.branching(p, q, h)
        return p + (1e-9 if calls[0] > 40 else 0), q

    assert found_of(step).faults == ("not a function",)


def test_a_step_that_fails_where_h_is_not_defined_is_not_refuted() -> None:
    def euler_b(p: Any, q: Any, h: Any) -> Any:
        p = p - h / (2 * math.sqrt(q - 5))
        return p, q + h * p

    assert found_of(euler_b, hamiltonian="p**2/2 + sqrt(q - 5)").verdict == "PROVED"
    found = found_of(euler_b, hamiltonian="p**2/2 + sqrt(q - 5) + sqrt(4 - q)")
    assert (found.verdict, "H has no exact solution" in found.reason) == ("UNDECIDED", True)
    with pytest.raises(InputError, match="raises ValueError"):
        found_of(euler_b)


def test_changed_arrays_are_named_and_nothing_is_refuted() -> None:
    found = found_of(own_steps.in_place)
    assert (found.verdict, found.faults) == ("PROVED", ("mutates",))
    assert "changes the arrays" in " ".join(found.notes)
    assert found_of(own_steps.euler_a).faults == ()


def test_what_it_prints_does_not_reach_standard_output(capsys: pytest.CaptureFixture[str]) -> None:
    assert found_of(own_steps.printing).verdict == "PROVED"
    out, err = capsys.readouterr()
    assert out == ""
    assert "a step" in err


def test_a_parameter_of_the_hamiltonian_is_given_by_name() -> None:
    quartic = Hamiltonian.parse("p**2/2 + c*q**4/4", {"c": "1/10"})

    def step(p: Any, q: Any, h: Any, *, c: Any) -> Any:
        p = p - h * c * q**3
        return p, q + h * p

    assert found_of(step, hamiltonian=quartic).verdict == "PROVED"
    with pytest.raises(InputError, match="has no value"):
        found_of(own_steps.verlet, hamiltonian="p**2/2 + c*q**4/4")


def test_a_branch_that_hides_from_symbols_is_seen() -> None:
    """`except` swallows what a symbol cannot do, so that a trace alone would be of another map."""

    def step(p: Any, q: Any, h: Any) -> Any:
        try:
            large = bool(q > -10)
        except TypeError:
            large = False
        p = p - h * math.sin(q) * (1 if large else 2)
        return p, q + h * p

    found = found_of(step, Claims(order=1))
    assert (found.verdict, found.how) == ("MEASURED", "duals")
    assert "catches the error of a symbol" in found.notes[0]


@pytest.mark.parametrize("signs", [(1, 1), (1, -1), (-1, 1), (-1, -1)])
def test_a_mistake_in_any_quadrant_is_seen(signs: tuple[int, int]) -> None:
    """Code that compares numbers is measured where it is tried, which is in all four."""

    def step(p: Any, q: Any, h: Any) -> Any:
        wrong = p * signs[0] > 0 and q * signs[1] > 0
        return own_steps.euler_a(p * (1 + h / 1000 if wrong else 1), q, h)

    found = found_of(step, Claims(order=1, area_preserving=True))
    assert (found.verdict, found.how) == ("REFUTED", "duals")


def test_a_caught_error_hides_no_branch_that_no_point_reaches() -> None:
    """Floats at the points that are tried agree with such a trace, and it is no proof."""

    def compares(p: Any, q: Any, h: Any) -> Any:
        with suppress(TypeError):
            p = 2 * p if q > 100 else p
        return own_steps.euler_a(p, q, h)

    def rounds(p: Any, q: Any, h: Any) -> Any:
        try:
            turns = round(q / 1000)
        except TypeError:
            turns = 0
        return own_steps.euler_a(p * (1 + turns), q, h)

    for step in (compares, rounds):
        assert found_of(step, Claims(order=1)).verdict == "MEASURED"


def test_what_asks_whether_h_is_positive_is_proved_for_such_h() -> None:
    def step(p: Any, q: Any, h: Any) -> Any:
        if not h > 0:
            raise ValueError("h")
        return own_steps.verlet(p, q, h)

    found = found_of(step)
    assert found.verdict == "PROVED"
    assert "h > 0 is taken for granted" in found.notes


def test_a_map_that_is_not_the_identity_at_h_0_is_no_scheme() -> None:
    def step(p: Any, q: Any, h: Any) -> Any:
        p, q = own_steps.verlet(p, q, h)
        return p + 1e-12, q

    found = found_of(step)
    assert (found.verdict, found.convergence_order) == ("REFUTED", -1)
    assert found.reason.endswith("not even at h = 0")


def test_names_that_do_not_tell_take_the_order_that_fits() -> None:
    def step(x: Any, y: Any, z: Any) -> Any:
        return own_steps.euler_b(x, y, z)

    found = found_of(step)
    assert found.verdict == "PROVED"
    assert "its arguments (x, y, z) are taken as (q, p, h), the order that fits" in found.notes
    assert not any("the order that" in note for note in found_of(own_steps.flipped).notes)


@pytest.mark.left_to_ci
@pytest.mark.sample(5)
@pytest.mark.parametrize("name", ["duffing", "pendulum", "morse", "toda", "lennard-jones", "twist"])
@pytest.mark.parametrize("scheme", ["euler", "rk4", "explicit-midpoint"])
def test_a_traced_scheme_is_proved_as_the_scheme_itself_is(name: str, scheme: str) -> None:
    system = systems.get(name)
    hamiltonian = system.hamiltonian(dict.fromkeys(system.parameters, "3/2"))
    gradient = hamiltonian.gradient()

    def slope(z: Any) -> Any:
        h_p, h_q = gradient(*z)
        return np.array([-h_q, h_p])

    def step(p: Any, q: Any, h: Any) -> Any:
        z = np.array([p, q])
        a = slope(z)
        b = slope(z + h / 2 * a)
        if scheme == "euler":
            return z + h * a
        if scheme == "explicit-midpoint":
            return z + h * b
        c = slope(z + h / 2 * b)
        return z + h / 6 * (a + 2 * b + 2 * c + slope(z + h * c))

    found = found_of(step, hamiltonian=hamiltonian)
    known = prove(get(scheme).step_map(hamiltonian))
    assert (found.how, found.verdict) == ("proof", known.verdict), found.notes
    assert (found.order, found.convergence_order) == (known.order, known.convergence_order)
    assert parse(found.leading or "") == parse(known.first.text)
