"""Whose fault it is: scenes where each verdict is right beyond doubt, and those beside them."""

from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest

from verify.arithmetic.exact import rational
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.run_domain import NumberOrList, point_of
from verify.studies.stability import verdict_on_run as blame
from verify.studies.stability.rounded_start import nearest_equilibrium
from verify.studies.stability.run_motion import RunMotion
from verify.studies.stability.trail import StabilityRun, follow_precisely
from verify.studies.stability.verdict_on_run import RunJudgement, judge

HARMONIC = "p**2/2 + q**2/2"
DUFFING = "p**2/2 + q**2/2 + q**4/4"
PENDULUM = "p**2/2 - cos(q)"
CUBIC = "p**2/2 + q**2/2 - q**3/3"
QUARTIC = "p**2/2 + q**4/4"
EXPONENTIAL = "p**2/2 + exp(q) + exp(-q)"
HENON_HEILES = "p1**2/2 + p2**2/2 + q1**2/2 + q2**2/2 + q1**2*q2 - q2**3/3"
INVERTED = "(p1**2 + p2**2 - q1**2 - q2**2)/2"
PLANE, DEGREES = ("1",), (["0", "0.1"], ["0.4", "0"])  # of energy 0.085, regular
PI = Fraction("3.14159265358979323846264338327950288419716939937510582097494459230781640628620")


def case(
    text: str, scheme: str, h: str, steps: int, q: NumberOrList, p: NumberOrList = "0"
) -> StabilityRun:
    exact = Hamiltonian.parse(text)
    state = tuple(point_of(exact, q, p).values())
    return StabilityRun(exact, scheme, rational(h), state, steps)


def judged(*run: Any) -> RunJudgement:
    return judge(RunMotion(case(*run)))


# -- the scheme -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "scheme", "start", "steps", "below", "above"),
    [
        (HARMONIC, "stormer-verlet", PLANE, 3000, "1.9", "2.05"),
        (HARMONIC, "symplectic-euler", PLANE, 3000, "1.9", "2.05"),
        (HARMONIC, "lie4", PLANE, 3000, "2.7", "2.9"),
        (HARMONIC, "lie3", PLANE, 3000, "1.7", "1.8"),
        (HENON_HEILES, "stormer-verlet", DEGREES, 28, "0.1", "2.1"),
    ],
    ids=["stormer-verlet", "symplectic-euler", "lie4", "lie3", "degrees-stormer-verlet"],
)
def test_beyond_its_linear_limit_the_scheme_is_to_blame(
    text: str, scheme: str, start: tuple[Any, ...], steps: int, below: str, above: str
) -> None:
    assert judged(text, scheme, above, steps, *start).kind == "unstable: scheme"
    assert judged(text, scheme, below, steps, *start).kind in ("stable", "drifts")


def test_the_step_at_which_the_scheme_leaves_is_that_of_exact_arithmetic() -> None:
    # lie1 multiplies p² + q² by 1 + h²; the energy scale bounds come before those of p and q.
    found = judged(HARMONIC, "lie1", "1", 200, "1")
    assert found.kind == "unstable: scheme"
    p, q, step = Fraction(0), Fraction(1), 0
    orbit = RunMotion(case(HARMONIC, "lie1", "1", 200, "1")).orbit
    r_p, r_q = orbit.reach
    while (
        abs(p) <= 10 * r_p and abs(q) <= 10 * r_q and (p * p + q * q - 1) / 2 <= 100 * orbit.scale
    ):
        p, q, step = p - q, q + p, step + 1
    assert found.step == step


WRONG_SIGN = "p_next = p + h*q; q_next = q + h*p"


@pytest.mark.parametrize(
    ("text", "scheme", "h", "steps", "start"),
    [(HARMONIC, WRONG_SIGN, "0.01", 2000, PLANE), (HENON_HEILES, "euler", "0.1", 600, DEGREES)],
    ids=["plane", "degrees"],
)
def test_a_scheme_that_leaves_is_to_blame_and_not_before_it_has_left(
    text: str, scheme: str, h: str, steps: int, start: tuple[Any, ...]
) -> None:
    left = judged(text, scheme, h, steps, *start)
    assert left.kind == "unstable: scheme"
    assert left.step is not None
    assert judged(text, scheme, h, 100, *start).kind != "unstable: scheme"


# -- rounding -------------------------------------------------------------------------------------


def test_at_the_top_of_the_pendulum_float64_is_to_blame() -> None:
    found = judged(PENDULUM, "stormer-verlet", "0.02", 3000, PI - Fraction(1, 10**16))
    assert found.kind == "unstable: arithmetic"
    assert found.step is not None
    assert 1000 < found.step < 3000
    assert "cannot tell z0 from an equilibrium, which is 1.0e-16 away" in found.detail


def test_farther_from_the_top_it_is_not() -> None:
    found = judged(PENDULUM, "stormer-verlet", "0.02", 6000, PI - Fraction(1, 10**3))
    assert found.kind == "stable"


def test_the_equilibrium_that_is_near_is_found_and_no_other() -> None:
    near = nearest_equilibrium(case(PENDULUM, "lie1", "1", 1, PI - Fraction(1, 10**30)))
    assert near is not None
    assert abs(near[1] - PI) < Fraction(1, 10**70)
    assert nearest_equilibrium(case(PENDULUM, "lie1", "1", 1, "3")) is None
    assert nearest_equilibrium(case("p**2/2 + q", "lie1", "1", 1, "3")) is None


# -- the exact solution ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "h", "steps", "fewer", "start", "detail"),
    [
        (CUBIC, "0.01", 1000, 100, ("3/2",), "blows up at t = 3.14159"),
        (INVERTED, "0.1", 400, 10, (["1", "0"], ["0", "1"]),
         "is 1e+06 times as far out as z0 at t = 40"),
    ],
    ids=["plane", "degrees"],
)  # fmt: skip
def test_an_exact_solution_that_leaves_is_nobodys_fault(
    text: str, h: str, steps: int, fewer: int, start: tuple[Any, ...], detail: str
) -> None:
    left = judged(text, "stormer-verlet", h, steps, *start)
    assert (left.kind, left.detail) == ("escapes", f"the exact solution {detail}")
    assert judged(text, "stormer-verlet", h, fewer, *start).kind == "stable"


def test_a_scheme_that_leaves_a_well_is_not_excused_by_the_escape_beyond_it() -> None:
    assert judged(CUBIC, "lie2", "1", 50, "1/2").kind == "unstable: scheme"


# -- range ----------------------------------------------------------------------------------------


def test_a_force_beyond_float64_overflows_where_the_scheme_stays() -> None:
    found = judged(EXPONENTIAL, "stormer-verlet", "1e-160", 2000, "720")  # e^720 = 10^312
    assert (found.kind, found.step) == ("overflow", 1)
    assert judged(EXPONENTIAL, "stormer-verlet", "1e-67", 2000, "300").kind == "stable"


def test_where_the_scheme_leaves_as_well_an_overflow_is_no_excuse() -> None:
    found = judged(EXPONENTIAL, "stormer-verlet", "0.01", 2000, "720")
    assert found.kind == "unstable: scheme"
    assert "float64 is out of its range from step 1 on" in found.detail


def test_a_force_that_vanishes_in_float64_underflows() -> None:
    found = judged(QUARTIC, "stormer-verlet", "0.01", 1000, "1e-150")  # q³ = 10^−450
    assert found.kind == "underflow"
    assert "all of p vanishes" in found.detail
    assert judged(QUARTIC, "stormer-verlet", "0.01", 1000, "1e-50").kind == "stable"


@pytest.mark.parametrize("size", ["1e-300", "1e150"])
def test_a_linear_problem_is_the_same_at_any_size(size: str) -> None:
    assert judged(HARMONIC, "stormer-verlet", "0.1", 2000, size).kind == "stable"
    assert judged(HARMONIC, "stormer-verlet", "2.1", 2000, size).kind == "unstable: scheme"


# -- drift ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(("scheme", "sign"), [("lie2", 1), ("lie3", -1), ("lie4", -1)])
def test_the_rate_of_a_drift_is_that_of_the_determinant(scheme: str, sign: int) -> None:
    # On the harmonic oscillator H is multiplied by det J at every step.
    found = judged(HARMONIC, scheme, "0.1", 2000, "1")
    coefficient = {"lie2": Fraction(1, 4), "lie3": Fraction(-1, 12), "lie4": Fraction(-1, 72)}
    power = {"lie2": 3, "lie3": 3, "lie4": 5}[scheme]
    expected = coefficient[scheme] * Fraction(1, 10**power) / 2
    assert found.kind == "drifts"
    assert found.rate is not None
    assert found.rate * sign > 0
    assert abs(found.rate / expected - 1) < Fraction(1, 10)


@pytest.mark.sample(4)
@pytest.mark.parametrize("scheme", ["symplectic-euler", "stormer-verlet", "yoshida4"])
@pytest.mark.parametrize("text", [HARMONIC, DUFFING, PENDULUM])
def test_what_only_swings_does_not_drift(text: str, scheme: str) -> None:
    for h in ("0.01", "0.037", "0.1", "0.25", "1/2", "1"):
        assert judged(text, scheme, h, 1000, "1").kind in ("stable", "unstable: scheme"), h


def test_a_periodic_orbit_of_the_scheme_is_no_motion_that_died() -> None:
    assert judged(DUFFING, "stormer-verlet", "1", 1000, "1").kind == "stable"


@pytest.mark.parametrize(
    ("text", "scheme", "h", "steps", "start"),
    [(HARMONIC, "lie3", "1", 2000, PLANE), (HENON_HEILES, "lie4", "0.1", 1000, DEGREES)],
    ids=["plane", "degrees"],
)
def test_a_motion_that_loses_energy_on_and_on_drifts(
    text: str, scheme: str, h: str, steps: int, start: tuple[Any, ...]
) -> None:
    """The first dies, the other is still near the exact one."""
    lossy = judged(text, scheme, h, steps, *start)
    assert lossy.kind == "drifts"
    assert lossy.rate is not None
    assert lossy.rate < 0


# -- nothing --------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", ["0*p", "p**2/2 + p**4/4", "sin(q)", "p*0 + 3"])
def test_what_cannot_go_wrong_is_stable(text: str) -> None:
    assert judged(text, "lie2", "0.1", 500, "1", "1").kind == "stable"


def test_where_h_is_not_defined_there_is_a_verdict_and_no_traceback() -> None:
    found = judged("p**2/2 + 1/q", "lie2", "0.1", 100, "0", "1")
    assert found.kind == "undecided"
    assert "not defined" in found.detail


def test_high_precision_that_does_not_settle_is_undecided(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(blame, "_MOST_DIGITS", 0)
    found = judged(PENDULUM, "stormer-verlet", "0.02", 3000, PI - Fraction(1, 10**16))
    assert found.kind == "undecided"


def test_a_chaotic_run_that_parts_by_rounding_is_not_called_underflow() -> None:
    # 53 bits keep with 40 digits here to the end, by chance; no number is small.
    found = judged(DUFFING, "symplectic-euler", "1.4", 4000, "0.5", "0.1")
    assert found.kind == "unstable: arithmetic"


def test_a_scheme_that_comes_back_to_one_point_is_seen_at_the_others_too() -> None:
    # It turns by π − π/32 a step: after every 64th it is at z0, between them 20 times as far out.
    found = judged(HARMONIC, "stormer-verlet", "1.997590912410", 12800, "0", "1")
    assert found.kind == "unstable: scheme"
    # And here by π/2: after every fourth.
    for steps in (400, 4096):
        found = judged(HARMONIC, "stormer-verlet", "1.414213562373095", steps, "0", "1")
        assert found.kind == "stable"
        assert found.energy_error is not None
        assert found.energy_error > Fraction(1, 10)


def test_a_step_whose_equations_have_no_solution_is_told_as_that() -> None:
    found = judged("p**2/2 + q**2/2 + p**2*q**2", "gauss4", "0.5", 10, "1", "2")
    assert found.kind == "unstable: scheme"
    assert "the scheme finds no solution of its equations at step 1," in found.detail
    assert found.detail.endswith("float64 goes no further from step 1 on")
    beyond = judged(HARMONIC, "stormer-verlet", "2.1", 4000, "1")
    assert "the scheme leaves the bounds at step" in beyond.detail
    assert "float64 is out of its range from step" in beyond.detail


def test_a_run_too_short_to_show_a_drift_says_so() -> None:
    told = "too few times to tell a drift"
    for steps, shown in ((200, False), (1000, False), (4000, True)):  # 0.3, 1.6 and 6 periods
        found = judged(HARMONIC, "lie1", "0.01", steps, "1")
        assert (found.kind, told in found.detail) == (
            ("drifts", False) if shown else ("stable", True)
        )
    long = judged(HARMONIC, "stormer-verlet", "0.01", 4000, "1")
    assert told not in long.detail


def test_what_more_digits_agree_on_is_held_against_the_bounds_too(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    top = PENDULUM, "stormer-verlet", "0.02", 2000, PI - Fraction(1, 10**16)
    assert judged(*top).kind == "unstable: arithmetic"

    def elsewhere(case: StabilityRun, digits: int) -> object:
        return follow_precisely(replace(case, state=(case.state[0], 1000 * case.state[1])), digits)

    monkeypatch.setattr(blame, "follow_precisely", elsewhere)  # 80 digits and more
    assert judged(*top).kind == "unstable: scheme"
