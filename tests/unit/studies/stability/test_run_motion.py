"""What is seen of a run as a whole, against the same asked of each of its points in Fractions."""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest

from verify.arithmetic.exact import fraction
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.studies.stability import run_motion
from verify.studies.stability.run_motion import RunMotion
from verify.studies.stability.trail import RunTrail, StabilityRun, TrailPoint

DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + q**4/4")
CASE = StabilityRun(DUFFING, "lie2", Fraction(1, 20), (Fraction(-1, 7), Fraction(2, 3)), 700)
EXACT = Fraction(1, 10**75)


def states(trail: RunTrail) -> list[tuple[Fraction, ...]]:
    return [tuple(map(fraction, point.state)) for point in trail.points]


def energy(p: Fraction, q: Fraction) -> Fraction:
    return p**2 / 2 + q**2 / 2 + q**4 / 4


def changed(trail: RunTrail, index: int, k: int, x: Any) -> RunTrail:
    """The trail with another number at one place, for p where k = 0."""
    columns = [list(column) for column in trail.columns]
    columns[k][index] = x
    return replace(trail, columns=tuple(map(tuple, columns)))


@pytest.fixture(scope="module")
def motion() -> RunMotion:
    return RunMotion(CASE)


def test_energy_errors_are_those_of_h_in_fractions(motion: RunMotion) -> None:
    first, scale = energy(*CASE.state), motion.orbit.scale
    for trail in (motion.float64, motion.precise):
        expected = [(energy(*z) - first) / scale for z in states(trail)]
        found = list(map(fraction, motion.energy_errors(trail)))
        assert max(abs(x - y) for x, y in zip(found, expected, strict=True)) < EXACT
        worst = motion.worst(trail)
        assert isinstance(worst, Fraction)
        assert worst == max(map(abs, found))


def test_the_worst_error_is_the_greatest_on_either_side(motion: RunMotion) -> None:
    for x in (Fraction(2), Fraction(0)):  # H is far greater, and far smaller, than at the start
        trail = changed(changed(motion.precise, 3, 0, x), 3, 1, x)
        worst = motion.worst(trail)
        assert worst is not None
        assert worst * motion.orbit.scale == pytest.approx(abs(energy(x, x) - energy(*CASE.state)))


def ends(motion: RunMotion, k: int) -> Sequence[Fraction]:
    """The bounds of a coordinate, as the module's text has them."""
    centre, reach = motion.orbit.centre[k], motion.orbit.reach[k]
    return centre - 10 * reach, centre + 10 * reach


@pytest.mark.parametrize("k", [0, 1])
@pytest.mark.parametrize("end", [0, 1])
def test_one_point_beyond_a_bound_is_enough_and_one_on_it_is_not(
    motion: RunMotion, k: int, end: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("verify.studies.stability.run_motion._ENERGY_FACTOR", 10**9)
    for trail in (motion.float64, motion.precise):
        on, away = ends(motion, k)[end], (-1, 1)[end] * Fraction(1, 10**40)
        assert motion.stays(changed(trail, 20, k, on))
        assert not motion.stays(changed(trail, 20, k, on + away))
        assert not motion.stays(replace(changed(trail, 20, k, on), done=trail.done - 1))


def test_one_point_with_too_much_energy_is_enough(motion: RunMotion) -> None:
    high = fraction(motion.precise.points[20].state[1]) + 9 * motion.orbit.reach[1]
    assert motion.stays(motion.precise)
    assert not motion.stays(changed(motion.precise, 20, 1, high))
    assert not motion.is_outside(TrailPoint(0, (Fraction(0), high)))


@pytest.mark.parametrize("k", [0, 1])
def test_runs_are_together_up_to_a_tenth_of_the_reach_at_every_point(
    motion: RunMotion, k: int
) -> None:
    own, other = motion.float64, motion.precise
    assert motion.stay_together(own, other)
    for side in (-1, 1):
        on = states(other)[20][k] + side * motion.orbit.reach[k] / 10
        assert motion.stay_together(changed(own, 20, k, on), other)
        assert not motion.stay_together(changed(own, 20, k, on + side * EXACT), other)
        assert not motion.stay_together(other, changed(own, 20, k, on + side * EXACT))
    assert not motion.stay_together(replace(own, done=own.done - 1), other)


def test_where_h_has_no_value_at_a_point_the_run_does_not_stay() -> None:
    pole = Hamiltonian.parse("p**2/2 + q**2/2 + 1/q")
    start = Fraction(0), Fraction(3, 2)
    well = RunMotion(StabilityRun(pole, "lie2", Fraction(1, 50), start, 200))
    assert well.stays(well.precise)
    undefined = changed(well.precise, 20, 1, Fraction(0))
    assert not well.is_outside(undefined.points[20])
    assert not well.stays(undefined)
    assert well.energy_errors(undefined).count(None) == 1
    assert well.worst(undefined) is not None


DYING = "p**2/2 + q**2/2", "lie3", "1", 2000, "1"
# Once around, to the pendulum's top, where it hardly moves for a long time.
RESTING = "p**2/2 - cos(q)", "stormer-verlet", "0.2", 230, "3.1415"


@pytest.mark.parametrize(("case", "died"), [(DYING, True), (RESTING, False)])
def test_a_motion_that_rests_for_a_few_steps_only_has_not_died(
    case: tuple[str, str, str, int, str], died: bool
) -> None:
    text, scheme, h, steps, q = case
    motion = RunMotion(
        StabilityRun(
            Hamiltonian.parse(text), scheme, Fraction(h), (Fraction(0), Fraction(q)), steps
        )
    )
    trail, period = motion.precise, motion.orbit.period
    assert period is not None
    assert run_motion.is_at_rest(motion, trail.onwards(trail.point(-1), run_motion._FEW_STEPS))
    assert run_motion.has_died(motion, trail, period) is died
