"""The exact solution: its digits, what it is recognised by, where it ends, extreme inputs."""

from fractions import Fraction
from typing import Any

import mpmath
import pytest
from flint import arb

from verify.arithmetic.arb import make_ball
from verify.arithmetic.exact import plain
from verify.arithmetic.flint_precision import working_precision
from verify.errors import InputError
from verify.flows import solution as solution_module
from verify.flows.ball_evaluation import MOST_DIGITS, evaluate
from verify.flows.extrapolation import NoFlowError, NumericalFlow
from verify.flows.solution import NOT_KNOWN, ExactSolution, exact_solution, leaves_by_algebra
from verify.hamiltonians import systems
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.flow_recognition import closed_form, named_systems, potential
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.named_system import Motion, exactly

DUFFING = "p**2/2 + q**2/2 + delta*q**4/4"
PENDULUM = "p**2/2 - cos(q)"
CUBIC = "p**2/2 + q**2/2 - q**3/3"
LENNARD_JONES = "p**2/2 + 4*((1/q)**12 - (1/q)**6)"
PI = "3.14159265358979323846264338327950288419716939937510582097494459230781640628620899"
REGIMES = [(name, r) for name, system in systems.all_systems().items() for r in system.regimes]


def solve(
    formula: str, p: Any, q: Any, time: Any, digits: int = 30, **parameters: Any
) -> ExactSolution:
    hamiltonian = Hamiltonian.parse(formula, parameters)
    p, q, time = Fraction(p), Fraction(q), Fraction(time)
    return exact_solution(hamiltonian, p=p, q=q, time=time, digits=digits)


def where(formula: str, p: Any, q: Any, time: Any = 100, **parameters: Any) -> str | None:
    hamiltonian = Hamiltonian.parse(formula, parameters)
    return leaves_by_algebra(hamiltonian, p=Fraction(p), q=Fraction(q), time=Fraction(time))


def near(value: Fraction, true: Any, digits: int) -> bool:
    return bool(abs(mpmath.mpf(value.numerator) / value.denominator - true) < 10.0**-digits)


# -- digits ---------------------------------------------------------------------------------------


@pytest.mark.sample(30)
@pytest.mark.parametrize("digits", [5, 30, 100])
@pytest.mark.parametrize(("name", "regime"), REGIMES, ids=map("-".join, REGIMES))
def test_the_bound_holds_and_is_as_small_as_asked_for(name: str, regime: str, digits: int) -> None:
    system = systems.get(name)
    in_time = system.time_dependent and system.flow_in_time is None
    if digits == 100 and (name in ("lennard-jones", "toda-oscillator") or in_time):
        digits = 40
    values, p, q = system.regime(regime)
    hamiltonian, time = system.hamiltonian(values), Fraction(3, 4)
    found, finer = (
        exact_solution(hamiltonian, p=p, q=q, time=time, digits=d) for d in (digits, digits + 20)
    )
    scale = max(map(abs, (p, q, found.p, found.q)))
    assert found.bound * 10**digits <= scale
    for x, y in ((found.p, finer.p), (found.q, finer.q)):
        assert abs(x - y) <= found.bound + finer.bound


def test_without_a_closed_form_it_goes_back_to_where_it_came_from() -> None:
    there = solve(LENNARD_JONES, "1/10", "3/2", 2)
    back = solve(LENNARD_JONES, there.p, there.q, -2, 25)
    assert "numerical" in there.method
    assert abs(back.p - Fraction(1, 10)) + abs(back.q - Fraction(3, 2)) < Fraction(1, 10**24)


@pytest.mark.parametrize("noise", [arb(1, 1e-9), arb.nan(), arb.pos_inf()])
def test_a_ball_that_no_precision_makes_narrow_has_no_digits(noise: Any) -> None:
    motion = Motion(lambda _: (noise, arb(1)), "noise")
    with pytest.raises(NoFlowError, match="loses more than"):
        evaluate(motion, (Fraction(1), Fraction(1)), Fraction(1), 20)


def test_a_modulus_that_rounds_to_1_takes_more_precision() -> None:
    """At 2 ± 10⁻¹⁰⁰ the pendulum's two fates part at t ≈ 230; 30 digits do not see it."""
    over, under = (solve(PENDULUM, 2 + Fraction(x, 10**100), 0, 1000, 10) for x in (1, -1))
    assert over.q > 28
    assert under.q < 4


@pytest.mark.parametrize("time", ["1e4", "1e40"])
@pytest.mark.parametrize("formula", [PENDULUM, "p**2/2 + q**2/2 + q**4/4"])
def test_a_long_time_keeps_h_within_its_enclosure(formula: str, time: str) -> None:
    """Energy at the end, in balls around what is told, holds that at the start."""
    for p, q in (("1/3", "3/2"), ("5/2", "1"), ("-3", "-7/2")):
        found = solve(formula, p, q, time, 40)
        assert found.enclosed
        with working_precision(500):
            before = energy(formula, arb(exactly(Fraction(p))), arb(exactly(Fraction(q))))
            after = energy(formula, *(make_ball(x, found.bound) for x in (found.p, found.q)))
            assert after.overlaps(before)
            wrong = make_ball(found.p + 100 * found.bound, found.bound)
            off = energy(formula, wrong, make_ball(found.q, found.bound))
            assert not off.overlaps(before), "the control: a state outside of its bound"


def energy(formula: str, p: Any, q: Any) -> Any:
    return p**2 / 2 - q.cos() if formula == PENDULUM else p**2 / 2 + q**2 / 2 + q**4 / 4


def test_what_a_numerical_flow_finds_is_not_called_enclosed() -> None:
    assert not solve(LENNARD_JONES, "1/10", "3/2", 2).enclosed
    assert solve(PENDULUM, "1/10", "3/2", 2).enclosed


# -- what is recognised ---------------------------------------------------------------------------

SAME: dict[str, tuple[str, str]] = {
    "duffing": ("p**2/2 + q**2/2 + q**4/4", DUFFING),
    "shifted": ("p**2/2 + 1 - cos(q)", PENDULUM),
    "morse": ("p**2/2 + 2*(1 - exp(-3*q/2))**2", "p**2/2 + D*(1 - exp(-a*q))**2"),
    "morse-expanded": ("p**2/2 - 4*exp(-q) + 2*exp(-2*q) + 7", "p**2/2 + D*(1 - exp(-a*q))**2"),
    "morse-mirrored": ("p**2/2 + 3*(exp(q) - 1)**2", "p**2/2 + D*(1 - exp(-a*q))**2"),
    "toda": ("p**2/2 + exp(q) + exp(-q) - 2", "p**2/2 + exp(q) + exp(-q)"),
    "twist": ("p**4/4 + p**2*q**2/2 + q**4/4", "(p**2 + q**2)**2/4"),
    "any-quartic": ("3*p**2 + q - q**2/7 + q**3/5 + q**4", ""),
    "a-mass": ("p**2/20 + 10*q**2", ""),
    "double-well": ("p**2/2 + (q**2 - 4)**2/4", ""),
}


@pytest.mark.parametrize(("formula", "system"), SAME.values(), ids=SAME)
def test_a_known_flow_is_recognised_in_other_words(formula: str, system: str) -> None:
    hamiltonian = Hamiltonian.parse(formula)
    assert closed_form(hamiltonian, Fraction(1, 3), Fraction(1, 2)) is not None
    found = solve(formula, "1/3", "1/2", "7/5", 30)
    assert "closed form" in found.method
    flow = NumericalFlow(canonical_field(hamiltonian)[0], 35)
    z = flow.follow((flow.number(Fraction(1, 3)), flow.number(Fraction(1, 2))), Fraction(7, 5))
    for x, y in zip((found.p, found.q), map(flow.arithmetic.exact, z), strict=True):
        assert abs(x - y) < Fraction(1, 10**28)
    if system:
        assert system in {n.system.formula for n in named_systems(hamiltonian)} or potential(
            hamiltonian
        )


def test_the_parameters_are_read_off() -> None:
    (found,) = named_systems(Hamiltonian.parse("p**2/2 + 2*(1 - exp(-3*q/2))**2"))
    assert (found.system.name, dict(found.values)) == ("morse", {"D": 2, "a": Fraction(3, 2)})


OTHERS = [
    "p**2/2 + 2*(1 - exp(-3*q/2))**2 + q", "p**2/2 - cos(q)/2", "p**2 - cos(q)",
    "p**2/2 + q**5", "p**2/2 + q*p**2", "p**4/4 + q**2/2", "p**2/2 + exp(q) + 2*exp(-q)",
    "p + q**2", "p**2/2 + 2*exp(-3*q) - 4*exp(-q)", "p**2/2 + pi*q**2", "cos(p) - cos(q)",
    "p**2/2 + p*q + q**2", "p**4/4 + p**2*q**2/3 + q**4/4", "q**2/2", "p**3 + exp(p*q) + sin(q)",
]  # fmt: skip


@pytest.mark.parametrize("formula", OTHERS)
def test_what_only_looks_like_a_known_flow_is_not_taken_for_one(formula: str) -> None:
    assert closed_form(Hamiltonian.parse(formula), Fraction(1, 3), Fraction(1, 2)) is None


def test_a_morse_barrier_has_no_closed_form_and_an_answer() -> None:
    assert "numerical" in solve("p**2/2 - (1 - exp(-q))**2", 0, "1/2", 1).method


# -- where solutions end --------------------------------------------------------------------------

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
    told = Fraction(str(info.value).split()[-1])
    if end is not None:
        assert near(told, end, 9)
    assert where(formula, p, q, 4) == f"it blows up at t = {plain(told, 6)}"
    assert where(formula, p, q, told * Fraction(99, 100)) is None
    assert abs(solve(formula, p, q, told * Fraction(999, 1000), 10).q) > 20
    hamiltonian = Hamiltonian.parse(formula)
    flow = NumericalFlow(canonical_field(hamiltonian)[0], 20)
    with pytest.raises(NoFlowError, match=r"at about t = "):
        flow.follow((flow.number(Fraction(p)), flow.number(Fraction(q))), told * Fraction(101, 100))


def test_backwards_the_time_of_the_end_is_another() -> None:
    with pytest.raises(NoFlowError, match=r"blows up at t = −1\.866"):
        solve(CUBIC, "-4/3", "5/2", -3)
    assert solve(CUBIC, "-4/3", "5/2", 1).q < 3


def test_past_the_end_in_time_a_formula_still_has_values_and_they_are_not_given() -> None:
    found = closed_form(Hamiltonian.parse(CUBIC), Fraction(0), Fraction(3, 2))
    assert found is not None
    assert found.state(arb(4))[1] < 100
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
    found = where(formula, p, q)
    assert found is not None
    assert said in found


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


# -- bad input -------------------------------------------------------------------------------------


def test_a_parameter_without_a_value_is_bad_input() -> None:
    with pytest.raises(InputError, match=r"^parameter=delta: needs a value"):
        solve(DUFFING, 0, 1, 1)
    with pytest.raises(InputError, match=r"^parameter=delta: needs a value"):
        where(DUFFING, 0, 1)


def test_an_h_of_several_degrees_of_freedom_is_bad_input() -> None:
    kepler = systems.get("kepler").hamiltonian({"mu": 1})
    with pytest.raises(InputError, match=r"^p=1: has 1 of 2 numbers; H is of p1, p2"):
        exact_solution(kepler, p=Fraction(1), q=Fraction(1), time=Fraction(1), digits=20)
    with pytest.raises(InputError, match=r"^hamiltonian=.* is of p1, p2, q1, q2; "):
        leaves_by_algebra(kepler, p=Fraction(1), q=Fraction(1), time=Fraction(1))


@pytest.mark.parametrize("digits", [0, -1, MOST_DIGITS + 1])
def test_digits_beyond_the_limits_are_bad_input(digits: int) -> None:
    with pytest.raises(InputError, match=r"^digits="):
        solve(PENDULUM, 0, 1, 1, digits)


# -- the numerical flow ----------------------------------------------------------------------------


def test_a_numerical_flow_that_is_cut_short_is_not_an_answer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The control of the two flows' agreement: a step too long by 10⁻²⁵ at the lower precision."""

    class Wrong(NumericalFlow):
        def follow(self, z: Any, time: Fraction, most_steps: int = 1000) -> Any:
            off = Fraction(1) + Fraction(self.arithmetic.bits, 10**27)
            return super().follow(z, time * off, most_steps)

    monkeypatch.setattr(solution_module, "NumericalFlow", Wrong)
    with pytest.raises(NoFlowError, match="digits asked for are lost"):
        solve("p**2/2 + q**6", 1, 1, 1, 30)
