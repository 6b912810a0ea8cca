"""Whose fault it is where H depends on time: the drive's, the scheme's, float64's, or nobody's."""

from fractions import Fraction

import mpmath
import pytest

import verify
from verify.arithmetic.exact import rational
from verify.flows import orbit_search as orbits
from verify.flows.exact_orbit import exact_orbit
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.studies.stability.run_motion import RunMotion
from verify.studies.stability.trail import StabilityRun
from verify.studies.stability.verdict_on_run import RunJudgement, judge
from verify.studies.stability.verdict_results import largest_step, stability_map

FORCED = "p**2/2 + q**2/2 - q*cos(2*t)"
DUFFING = "p**2/2 + q**2/2 + q**4/4 - q*cos(7*t/5)/2"
PENDULUM = "p**2/2 - (1 + cos(3*t/2)/2)*cos(q)"
SOFTENING = "p**2/2 + (1 + 100/(1 + t**2))*q**2/2"
ZERO, ONE = Fraction(0), Fraction(1)


def case(
    text: str, scheme: str, h: str, steps: int, q: str = "1", p: str = "0", t0: str = "0"
) -> StabilityRun:
    exact = Hamiltonian.parse(text)
    return StabilityRun(exact, scheme, rational(h), (rational(p), rational(q)), steps, rational(t0))


def judged(*given: str | int, **more: str) -> RunJudgement:
    return judge(RunMotion(case(*given, **more)))  # type: ignore[arg-type]


@pytest.mark.parametrize("scheme", ["lie2", "lie4", "stormer-verlet", "implicit-midpoint", "rk4"])
def test_what_keeps_to_the_driven_motion_is_stable(scheme: str) -> None:
    found = judged(DUFFING, scheme, "0.05", 1000)
    assert found.kind == "stable"
    assert "not looked at for a drift" in str(found.detail)
    assert found.energy_error is found.rate is None


def test_the_step_at_which_the_scheme_leaves_is_that_of_exact_arithmetic() -> None:
    """Störmer–Verlet beyond h = 2, by a loop of one's own; the orbit's reach in closed form."""
    h, found = mpmath.mpf("2.5"), judged(FORCED, "stormer-verlet", "2.5", 100)
    assert found.kind == "unstable: scheme"

    def q_at(t: float) -> float:  # q'' + q = cos 2t from (1, 0)
        return float(4 * mpmath.cos(t) / 3 - mpmath.cos(2 * t) / 3)

    orbit = exact_orbit(Hamiltonian.parse(FORCED), ZERO, ONE, Fraction(250))
    seen = [q_at(k / 50) for k in range(12_500)]
    (_, centre), (_, reach) = orbit.centre, orbit.reach
    assert float(reach) == pytest.approx((max(seen) - min(seen)) / 2, rel=0.02)
    p, q, step = mpmath.mpf(0), mpmath.mpf(1), 0
    while abs(q - float(centre)) <= 10 * float(reach) and abs(
        p - float(orbit.centre[0])
    ) <= 10 * float(orbit.reach[0]):
        p = p + h / 2 * (mpmath.cos(2 * step * h) - q)
        q = q + h * p
        step += 1
        p = p + h / 2 * (mpmath.cos(2 * step * h) - q)
    assert found.step == step


def test_a_force_read_from_another_system_is_the_schemes_fault() -> None:
    pushing = "p_next = p + h*q; q_next = q + h*p"
    assert judged(FORCED, pushing, "0.01", 2000).kind == "unstable: scheme"


def test_it_counts_when_a_run_starts() -> None:
    """ω is 10 at t = 0 and 1 at t = 1000: a step of 1/2 is too long at first only."""
    assert judged(SOFTENING, "stormer-verlet", "0.5", 100).kind == "unstable: scheme"
    assert judged(SOFTENING, "stormer-verlet", "0.5", 100, t0="1000").kind == "stable"


@pytest.mark.parametrize("scheme", ["lie2", "stormer-verlet"])
def test_a_shift_of_t0_and_of_h_together_changes_no_verdict(scheme: str) -> None:
    shifted = SOFTENING.replace("t**2", "(t - 3)**2")
    one = judged(SOFTENING, scheme, "0.5", 100)
    other = judged(shifted, scheme, "0.5", 100, t0="3")
    assert (one.kind, one.step) == (other.kind, other.step)


@pytest.mark.left_to_ci
def test_a_chaotic_run_parts_by_rounding_and_its_neighbour_does_too() -> None:
    found = judged(PENDULUM, "stormer-verlet", "0.05", 3_300, q="3", p="0.2")
    assert found.kind == "unstable: arithmetic"
    assert "the motion is sensitive there" in str(found.detail)
    regular = judged(PENDULUM, "stormer-verlet", "0.05", 3_300, q="0.3")
    assert regular.kind == "stable"


def test_an_orbit_that_goes_round_has_no_bound_in_its_angle() -> None:
    """q reaches 80, and its start is 0; the same without a period in q is bounded."""
    found = judged("p**2/2 - (1 + cos(t)/10)*cos(q)", "stormer-verlet", "0.05", 600, q="0", p="3")
    assert found.kind == "stable"
    exact = Hamiltonian.parse("p**2/2 - (1 + cos(t)/10)*cos(q)")
    assert exact_orbit(exact, Fraction(3), ZERO, Fraction(30)).turns == (False, True)
    assert exact_orbit(exact, ZERO, ONE, Fraction(30)).turns == (False, False)


def test_what_starts_at_rest_in_time_is_followed() -> None:
    """No force acts at t = 0, and one does later; nothing moves where H is 0."""
    pushed = exact_orbit(Hamiltonian.parse("p**2/2 - q*sin(t)"), ZERO, ZERO, Fraction(20))
    assert pushed.kind == "driven"
    assert float(pushed.reach[1]) == pytest.approx(10, rel=0.1)  # q = t − sin t
    assert judged("p**2/2 - q*sin(t)", "lie3", "0.1", 200, q="0").kind == "stable"


def test_h_singular_on_the_way_is_nobodys_fault_and_the_time_is_named() -> None:
    found = judged("p**2/2 + q**2/(2*(3 - t))", "stormer-verlet", "0.02", 400, t0="1")
    assert found.kind == "escapes"
    assert "at t = 3" in str(found.detail)


def test_what_is_not_followed_to_its_end_accuses_nobody(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(orbits, "_MOST_IN_TIME", 20)
    exact_orbit.cache_clear()
    try:
        leaves = judged(FORCED, "stormer-verlet", "2.5", 100)
        stays = judged(FORCED, "stormer-verlet", "0.1", 1000)
    finally:
        exact_orbit.cache_clear()
    assert (leaves.kind, stays.kind) == ("undecided", "stable")
    assert "was followed to t = " in str(leaves.detail)


@pytest.mark.left_to_ci
def test_the_largest_step_of_a_forced_oscillator_is_that_without_the_force() -> None:
    exact = Hamiltonian.parse("p**2/2 + q**2/2 - q*cos(t/5)")
    found = largest_step(
        exact, "stormer-verlet", p=ZERO, q=ONE, time=Fraction(50), t0=Fraction(1, 3)
    )
    assert found.bounded is not None
    assert abs(Fraction(found.bounded) / 2 - 1) < Fraction(1, 50)
    assert (float(found.linear or 0), found.t0) == (2, "1/3")


def test_a_map_has_a_row_for_each_drive() -> None:
    exact = Hamiltonian.parse("p**2/2 + (1 + g*cos(t))*q**2/2", {"g": "0"})
    found = stability_map(
        exact, "stormer-verlet", parameter="g", values=(ZERO, Fraction(1, 10)),
        step_sizes=(Fraction(1, 10), Fraction(5, 2)), steps=60, p=ZERO, q=ONE, t0=ZERO,
    )  # fmt: skip
    assert [[cell.kind for cell in row] for row in found.cells] == [
        ["stable", "unstable: scheme"]
    ] * 2


def test_calls_commands_and_scenes_take_when_it_starts() -> None:
    (found,) = verify.stability(
        SOFTENING, "stormer-verlet", q=1, p=0, step_size="0.5", steps=100, t0=1000
    )
    assert (found.kind, found.t0) == ("stable", "1000")
    (plain,) = verify.stability("duffing", "lie2", parameters={"delta": 1}, q=1, p=0,
                                step_size="0.1", steps=10)  # fmt: skip
    assert plain.t0 is None
