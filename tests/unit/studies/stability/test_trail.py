"""Trails, and the step at which something happens; against plain loops in Python."""

from dataclasses import replace
from fractions import Fraction

import pytest

from verify import arithmetic
from verify.arithmetic.systems import mpfr
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun
from verify.studies.stability import trail as trails
from verify.studies.stability.trail import (
    StabilityRun,
    TrailPoint,
    find_first_apart,
    find_first_step,
    follow,
    follow_precisely,
)

FLOAT = arithmetic.get("float64", 17)
GROWING = StabilityRun(
    Hamiltonian.parse("p**2/2 + q**2/2"), "lie1", Fraction(1, 10), (Fraction(0), Fraction(1)), 3000
)


def stepped(case: StabilityRun, steps: int) -> tuple[float, float]:
    """lie1 on the harmonic oscillator, in float64."""
    p, q, h = *map(float, case.state), float(case.step_size)
    for _ in range(steps):
        p, q = p + -h * q, q + h * p
    return p, q


def test_a_trail_has_the_states_of_a_plain_loop() -> None:
    trail = follow(GROWING, FLOAT)
    assert trail.is_finished
    assert trail.points[0] == TrailPoint(0, (Fraction(0), Fraction(1)))
    assert trail.points[-1].step == GROWING.steps
    assert len(trail.points) > 100
    for point in trail.points[:: len(trail.points) // 5]:
        assert tuple(map(float, point.state)) == pytest.approx(stepped(GROWING, point.step))


@pytest.mark.parametrize("name", ["float64", "mpfr", "fixed"])
@pytest.mark.parametrize("text", ["p**2/2 + q**2/2 + q**4/4", "p**2/2 + q**2/2 - q*cos(2*t)"])
def test_its_points_are_the_exact_numbers_that_the_run_notes(name: str, text: str) -> None:
    made = arithmetic.get(name, 30)
    case = StabilityRun(
        Hamiltonian.parse(text), "lie2", Fraction(1, 30), (Fraction(0), Fraction(1, 3)), 700
    )
    trail, every = follow(case, made), 7
    noted = KernelRun(
        case.hamiltonian, "lie2", {**case.start}, 700, frozenset(), 0, sections=100
    ).run(made)
    assert [point.step for point in trail.points] == [every * k for k in range(101)]
    assert [point.state for point in trail.points[1:]] == [(x["p"], x["q"]) for x in noted.trail]
    assert trail.points[0].state == (0, Fraction(1, 3))
    assert [trail.point(k) for k in (0, 5, -1)] == [trail.points[k] for k in (0, 5, -1)]
    later = trail.onwards(trail.point(5), 1).run
    assert (later.state, {type(x) for x in later.state}) == (trail.points[5].state, {Fraction})


@pytest.mark.parametrize("size", [2, 100, 10**5])
def test_the_first_step_is_found_exactly(size: int) -> None:
    def far(point: TrailPoint) -> bool:
        return sum(x**2 for x in point.state) > size

    # The square of the radius grows by 1 + h² at each step.
    expected = next(n for n in range(1, 10**4) if Fraction(101, 100) ** n > size)
    trail = follow(GROWING, FLOAT)
    assert find_first_step(trail, far) == expected


def test_what_does_not_happen_has_no_step() -> None:
    trail = follow(GROWING, FLOAT)
    assert find_first_step(trail, lambda point: False) is None


def test_leaving_the_range_happens_at_the_step_after_the_last() -> None:
    case = replace(GROWING, step_size=Fraction(10**30), steps=200)
    trail = follow(case, FLOAT)
    assert not trail.is_finished
    found = find_first_step(trail, lambda point: False)
    assert found == trail.done + 1
    assert max(abs(x) for x in stepped(case, trail.done)) < float("inf")


def test_something_within_the_last_unfinished_stretch_is_found() -> None:
    case = replace(GROWING, step_size=Fraction(10**30), steps=200_000)
    trail = follow(case, FLOAT)
    assert len(trail.points) == 1  # the first stretch is not finished
    assert find_first_step(trail, lambda point: abs(point.state[1]) > 10**59) == 2


def test_two_runs_part_where_a_plain_comparison_says() -> None:
    coarse, fine = mpfr.at_bits(20), mpfr.at_bits(80)
    case = replace(GROWING, steps=2500)
    one, other = follow(case, coarse), follow(case, fine)

    def apart(x: TrailPoint, y: TrailPoint) -> bool:
        return abs(x.state[0] - y.state[0]) > Fraction(1, 10)

    found = find_first_apart(one, other, apart)
    assert found is not None
    for steps, expected in ((found - 1, False), (found, True)):
        pair = (follow(replace(case, steps=steps), a).points[-1] for a in (coarse, fine))
        assert apart(*pair) is expected


def test_two_runs_that_stay_together_part_nowhere() -> None:
    fine = mpfr.at_bits(80)
    trail = follow(GROWING, fine)
    assert find_first_apart(trail, trail, lambda x, y: abs(x.state[0] - y.state[0]) > 0) is None


def test_without_a_compiler_only_so_many_steps_are_done_and_it_says_so(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(trails, "MOST_INTERPRETED", 3000)
    hamiltonian = Hamiltonian.parse("p**2/2 + q*atan(q)")  # which fixed has not
    case = StabilityRun(
        hamiltonian, "lie1", Fraction(1, 10**6), (Fraction(0), Fraction(1)), 400_000
    )
    trail = follow_precisely(case, 30)
    assert trail.arithmetic.name == "mpfr"
    assert trail.is_finished
    assert trail.steps == 3000


def test_long_runs_are_compiled() -> None:
    case = replace(GROWING, step_size=Fraction(1, 10**6), steps=100_000)
    trail = follow_precisely(case, 30)
    assert trail.arithmetic.name == "fixed"
    assert trail.steps == case.steps
