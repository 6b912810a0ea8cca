"""Whole periods of H are taken off a large t in fixed point, and nothing of the result is lost."""

import math
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from mpmath.ctx_mp import MPContext

from verify import arithmetic
from verify.execution.keeper import Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.periods import period_in
from verify.kernels import run_inputs as module
from verify.kernels.many_points import PointMap
from verify.kernels.run_inputs import Turns, turns_of
from verify.runs.requested_run import run
from verify.scenes.results.run import RunResult

DRIVEN = Hamiltonian.parse("p**2/2 - (1 + cos(5*t)/10)*cos(q)")
TWO = Hamiltonian.parse("p**2/2 + q**2*(3 - cos(2*t + 1/3) + sin(3*t)/7)/2")
TURNED = Hamiltonian.parse("p**2/2 + q**2*(3 - cos(2*pi*t/3))/2")
H = Fraction(1, 10)
HUGE = Fraction(-123456789123456789, 7)


def ran(hamiltonian: Hamiltonian, name: str, t0: Fraction, steps: int, **more: Any) -> RunResult:
    return run(
        hamiltonian, "lie2", q=Fraction(1, 2), p=0, step_size=H, steps=steps, t0=t0,
        arithmetic=name, digits=30, observables=("lambda", "mse"), **more,
    )  # fmt: skip


def same(fixed: RunResult, other: RunResult) -> bool:
    """In fixed point as in the other, within what both say."""
    return fixed.arithmetic == "fixed" and all(
        abs(Fraction(x.value) - Fraction(other.values[n].value))
        <= Fraction(x.bound) + Fraction(other.values[n].bound)
        for n, x in fixed.values.items()
    )


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("t0", [Fraction(10**6), HUGE, Fraction(1, 3)])
@pytest.mark.parametrize("hamiltonian", [DRIVEN, TWO, TURNED])
def test_from_a_large_t_on_it_is_the_run_of_floating_point(
    hamiltonian: Hamiltonian, t0: Fraction
) -> None:
    assert same(ran(hamiltonian, "fixed", t0, 300), ran(hamiltonian, "mpfr", t0, 300))


def test_a_long_run_is_told_the_time_again_and_again() -> None:
    steps = 50_000
    turns = turns_of(DRIVEN, (Fraction(0), steps * H), H)
    assert turns is not None
    assert steps > 10 * turns.steps
    fixed, other = (ran(DRIVEN, name, Fraction(0), steps) for name in ("fixed", "mpfr"))
    assert same(fixed, other)
    assert fixed.error_kind == "enclosed"


def test_a_wrong_period_would_be_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "period_in", lambda *_: period_in(DRIVEN, "t") * 3 / 2)
    assert not same(
        ran(DRIVEN, "fixed", Fraction(10**6), 300), ran(DRIVEN, "mpfr", Fraction(10**6), 300)
    )


@pytest.mark.parametrize("digits", [19, 33, 72])
@pytest.mark.parametrize("t", [Fraction(10**6), HUGE, Fraction(10**40, 3), Fraction(-5, 7)])
def test_what_is_left_of_t_is_known_beyond_the_format(t: Fraction, digits: int) -> None:
    own = MPContext()
    own.prec = 600
    fixed = arithmetic.get("fixed", digits)
    left = Turns(Fraction(2, 5), 1, 1, (t, t)).time(t, fixed)
    period = 2 * own.pi / 5
    gone = (
        own.mpf(t.numerator) / t.denominator - own.mpf(left.numerator) / left.denominator
    ) / period
    assert abs(gone - own.nint(gone)) * period < own.mpf(2) ** (-fixed.bits - 20)
    assert abs(left) < 1


def test_points_of_a_region_start_late_too() -> None:
    systems = [arithmetic.get(name, 25) for name in ("fixed", "mpfr")]
    ends = []
    for system in systems:
        step = PointMap(
            DRIVEN, "lie2", step_size=H, steps=40, arithmetic=system, t0=Fraction(10**6)
        )
        p, q = ([system.number(Fraction(x, 7)) for x in z] for z in ((1, 2), (3, 4)))
        found = step(p=p, q=q)
        ends.append([system.exact(x) for n in ("p", "q") for x in found[n]])
    assert all(abs(x - y) < Fraction(1, 10**24) for x, y in zip(*ends, strict=True))


def test_an_interrupted_run_goes_on_at_its_time(tmp_path: Path) -> None:
    class Interrupting:
        left = 20

        def __call__(self, done: int) -> None:
            self.left -= 1
            if self.left == 0:
                raise KeyboardInterrupt

    keeper, steps = Keeper(tmp_path, "task"), 50_000
    with pytest.raises(KeyboardInterrupt):
        ran(DRIVEN, "fixed", Fraction(7), steps, progress=Interrupting(), keeper=keeper)
    again = ran(DRIVEN, "fixed", Fraction(7), steps, keeper=keeper)
    assert again.values == ran(DRIVEN, "fixed", Fraction(7), steps).values


@pytest.mark.parametrize(
    "formula",
    [
        "p**2/2 + q*cos(t**2)",
        "p**2/2 + q*t",
        "p**2/2 + q*(cos(t) + cos(pi*t))",
        "p**2/2 + q*exp(t)",
    ],
)
def test_no_period_is_made_up(formula: str) -> None:
    assert turns_of(Hamiltonian.parse(formula), (Fraction(0), Fraction(10**6)), H) is None


def test_where_t_is_small_nothing_is_taken_off() -> None:
    assert turns_of(DRIVEN, (Fraction(0), Fraction(100)), H) is None
    assert turns_of(DRIVEN, (Fraction(-5000), Fraction(0)), H) is not None


@pytest.mark.parametrize(
    ("hamiltonian", "period"), [(DRIVEN, 2 * math.pi / 5), (TURNED, 3), (TWO, 2 * math.pi)]
)
def test_a_loops_times_are_those_of_a_period_and_its_steps_and_hardly_more(
    hamiltonian: Hamiltonian, period: float
) -> None:
    found = turns_of(hamiltonian, (Fraction(0), Fraction(10**6)), H)
    assert found is not None
    first, last = found.times
    assert period <= -first < 1.001 * period
    assert last == found.steps * H - first
