"""Where exact solutions end or leave, and where they do not."""

from fractions import Fraction
from typing import Any

import mpmath
import pytest
from flint import arb

from tests.unit.flows.test_solution import (
    CUBIC,
    KEPLER,
    LENNARD_JONES,
    PENDULUM,
    near,
    solve,
    where,
)
from verify.arithmetic.exact import plain
from verify.flows.extrapolation import NoFlowError, NumericalFlow
from verify.flows.solution import NOT_KNOWN
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.flow_recognition import closed_form
from verify.hamiltonians.hamiltonian import Hamiltonian

LEMNISCATE = mpmath.ellipk(mpmath.mpf(1) / 2)
ENDS: dict[str, tuple[str, Any, Any, Any]] = {
    "cubic-from-rest": (CUBIC, 0, "3/2", mpmath.pi),
    "quartic-hill": ("p**2/2 - q**4/4", 0, 1, LEMNISCATE),
    "soft-turning-first": ("p**2/2 + q**2/2 - q**4/4", 2, -2, 3 * mpmath.pi / 4),
    "soft-outwards": ("p**2/2 + q**2/2 - q**4/4", -2, -2, mpmath.pi / 4),
    "separatrix-outwards": ("p**2/2 + q**2/2 - q**4/2", "7/2", 2, None),
}


@pytest.mark.parametrize(("formula", "p", "q", "end"), ENDS.values(), ids=ENDS)
def test_a_blow_up_is_an_error_that_names_its_time(formula: str, p: Any, q: Any, end: Any) -> None:
    with pytest.raises(NoFlowError, match=r"blows up at t = ") as info:
        solve(formula, p, q, 4)
    time = Fraction(str(info.value).split()[-1])
    if end is not None:
        assert near(time, end, 9)
    assert where(formula, p, q, 4) == f"it blows up at t = {plain(time, 6)}"
    assert where(formula, p, q, time * Fraction(99, 100)) is None
    assert abs(solve(formula, p, q, time * Fraction(999, 1000), 10).q) > 20
    hamiltonian = Hamiltonian.parse(formula)
    flow = NumericalFlow(canonical_field(hamiltonian)[0], 20)
    with pytest.raises(NoFlowError, match=r"at about t = "):
        flow.follow((flow.number(Fraction(p)), flow.number(Fraction(q))), time * Fraction(101, 100))


def test_backwards_the_time_of_the_end_is_another() -> None:
    with pytest.raises(NoFlowError, match=r"blows up at t = −1\.866"):
        solve(CUBIC, "-4/3", "5/2", -3)
    assert solve(CUBIC, "-4/3", "5/2", 1).q < 3


def test_past_the_end_in_time_a_formula_still_has_values_and_they_are_not_given() -> None:
    motion = closed_form(Hamiltonian.parse(CUBIC), Fraction(0), Fraction(3, 2))
    assert motion is not None
    assert motion.state(arb(4))[1] < 100
    with pytest.raises(NoFlowError, match="blows up"):
        solve(CUBIC, 0, "3/2", 4)


STAY: dict[str, tuple[str, Any, Any]] = {
    "hard": ("p**2/2 + q**2/2 + q**4/4", 1, 3),
    "inside": ("p**2/2 + q**2/2 - q**4/4", 0, "1/2"),
    "separatrix": ("p**2/2 + q**2/2 - q**4/2", "1/2", 0),
    "saddle": ("p**2/2 + q**2/2 - q**4/4", 0, 1),
    "down-to-the-saddle": ("p**2/2 - q**2/2", 1, -1),
    "swing": (PENDULUM, 1, 1),
    "top": (PENDULUM, 2, 0),
    "bound": ("p**2/2 + (1 - exp(-q))**2", 1, 0),
    "bound-atoms": (LENNARD_JONES, 0, "3/2"),
    "toda-oscillator": ("p**2/2 + exp(q) - q - 1", 1, 5),
    "at-rest": ("p**2/2 + q**6", 0, 0),
}
GO: dict[str, tuple[str, Any, Any, str]] = {
    "free": ("p**2/2", -1, 1, "−∞ as t grows"),
    "hill": ("p**2/2 - q**2/2", 1, 1, "+∞ as t grows"),
    "round": (PENDULUM, "-21/10", 0, "−∞ as t grows: the pendulum goes round"),
    "threshold": ("p**2/2 + 2*(1 - exp(-q))**2", 2, 0, "+∞ as t grows: the energy"),
    "dissociates": ("p**2/2 + 2*(1 - exp(q))**2", 3, 0, "−∞ as t grows: the energy"),
    "free-atoms": (LENNARD_JONES, -2, "3/2", "+∞ as t grows: the energy"),
}


@pytest.mark.parametrize(("formula", "p", "q"), STAY.values(), ids=STAY)
def test_what_stays_does_not_leave(formula: str, p: Any, q: Any) -> None:
    assert where(formula, p, q) is None


@pytest.mark.parametrize(("formula", "p", "q", "said"), GO.values(), ids=GO)
def test_what_goes_to_infinity_is_said_to(formula: str, p: Any, q: Any, said: str) -> None:
    departure = where(formula, p, q)
    assert departure is not None
    assert said in departure


@pytest.mark.parametrize(
    "formula",
    [
        "p*q",
        "p**2/2 - q**6",
        "p**2/2 + 4/q**12 - 3/q**6",
        "p**2/2 + q**6",
        "p**2/2 - cos(q) - cos(2*q)",
    ],
)
def test_what_is_not_known_is_not_guessed(formula: str) -> None:
    assert where(formula, 1, 1) == NOT_KNOWN


@pytest.mark.parametrize("above", [1, -1])
def test_the_border_between_staying_and_leaving_is_exact(above: int) -> None:
    tiny = Fraction(above, 10**200)
    assert (where(PENDULUM, 2 + tiny, 0) is not None) == (above > 0)
    assert (where("p**2/2 + 2*(1 - exp(-q))**2", 2 + tiny, 0) is not None) == (above > 0)
    # V = q²/2 − q⁴/2 has barriers of height 1/8, reached from 0 by p = 1/2
    soft = "p**2/2 + q**2/2 - q**4/2"
    assert (where(soft, Fraction(1, 2) + tiny, 0, 10**6) is not None) == (above > 0)


def test_a_collision_ends_it() -> None:
    with pytest.raises(NoFlowError):
        solve(KEPLER, ["0", "0"], ["1", "0"], 2, 25)


def test_an_h_that_is_not_smooth_in_time_on_the_way_ends_it() -> None:
    with pytest.raises(NoFlowError, match="H is not smooth"):
        solve("p1**2/2 + q1**2*q2/(1 - t) + p2**2", ["0", "0"], ["1", "0"], 2, 25)
