"""Error against run time: errors against closed forms, orders, what limits a point, failed runs."""

import ast
import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import mpmath
import pytest

from tests.helpers.constructed.work import work_task
from verify import schemes
from verify.arithmetic.arb import slope
from verify.errors import InputError
from verify.execution.execute import compute_task
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.run import run
from verify.scenes.results.work_precision import WorkPoint, WorkPrecisionResult
from verify.studies.work_precision.lines import error_slope, lambda_slope, log10_of
from verify.studies.work_precision.measure import _digits_of_state
from verify.studies.work_precision.runs import ROUNDING_SHARE, Ladder, Problem, reference

HARMONIC = Hamiltonian.parse("p**2/2 + q**2/2")
DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4", {"delta": 1})
PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")


def problem(hamiltonian: Hamiltonian, q: str = "1", time: Fraction | int = 1) -> Problem:
    start = Fraction(0), Fraction(q)
    point = dict(zip("pq", start, strict=True))
    exact = reference(hamiltonian, point, Fraction(time), Fraction(0))
    return Problem(hamiltonian, point, Fraction(time), Fraction(0), exact)


def points(of: Problem, scheme: str, steps: Sequence[int]) -> list[WorkPoint]:
    ladder = Ladder(of, scheme)
    return [ladder.point(of.time / n) for n in steps]


def number(value: Any) -> Fraction:
    return Fraction(value.value)


# -- errors ---------------------------------------------------------------------------------------


def test_where_h_does_not_divide_the_time_the_error_is_that_where_the_steps_end() -> None:
    h = Fraction(3, 10)
    rounded, whole = Ladder(problem(PENDULUM), "rk4"), problem(PENDULUM, time=Fraction(9, 10))
    point, same = rounded.point(h), Ladder(whole, "rk4").point(h)
    assert point.steps == same.steps == 3
    assert (point.error, point.truncation) == (same.error, same.truncation)
    at_the_time = rounded.problem.error(tuple(whole.solution.point.values()))[0]
    assert at_the_time > 100 * number(point.error)  # what it would be from z(T)


def test_the_error_and_its_parts_are_those_of_closed_forms() -> None:
    """Symplectic Euler for the oscillator in Fractions and in Python's floats; z(1) by mpmath."""
    h, n = Fraction(1, 10), 10
    (point,) = points(problem(HARMONIC), "symplectic-euler", [n])
    exact, floats = (Fraction(0), Fraction(1)), (0.0, 1.0)
    for _ in range(n):
        p, q = exact
        p = p - h * q
        exact = p, q + h * p
        p_, q_ = floats
        p_ = p_ + (-(0.1 * q_))
        floats = p_, q_ + 0.1 * p_
    with mpmath.workdps(40):
        true = -mpmath.sin(1), mpmath.cos(1)
        size = mpmath.hypot(*(mpmath.mpf(x.numerator) / x.denominator - t
                              for x, t in zip(exact, true, strict=True)))  # fmt: skip
        assert point.truncation is not None
        gap = abs(mpmath.mpf(point.truncation.value) - size)
        assert gap <= mpmath.mpf(point.truncation.bound)
    energy = abs(sum(Fraction(x) ** 2 for x in floats) / 2 - Fraction(1, 2))
    assert point.energy is not None
    assert abs(number(point.energy) - energy) <= Fraction(point.energy.bound) + Fraction(1, 2**50)
    apart = math.hypot(*(float(Fraction(a) - b) for a, b in zip(floats, exact, strict=True)))
    assert point.rounding is not None
    assert float(number(point.rounding)) == pytest.approx(apart, rel=0.5)


@pytest.mark.parametrize("scheme", ["lie2", "rk4", "stormer-verlet"])
def test_error_truncation_and_rounding_keep_the_triangle_inequality(scheme: str) -> None:
    for point in points(problem(DUFFING), scheme, [4, 64, 1024]):
        assert point.error
        assert point.truncation
        assert point.rounding
        gap = abs(number(point.error) - number(point.truncation))
        bounds = (point.error, point.truncation, point.rounding)
        assert gap <= number(point.rounding) + sum(Fraction(v.bound) for v in bounds)
        small = number(point.rounding) < ROUNDING_SHARE * number(point.error)
        assert (point.limited_by == "truncation") is small


def test_area_is_preserved_exactly_by_proof_and_what_floats_show_is_called_rounding() -> None:
    (kept,) = points(problem(PENDULUM), "stormer-verlet", [100])
    assert kept.lam is not None
    assert (kept.lam.value, kept.lam.bound, kept.lambda_limited_by) == ("0", "0", "rounding")
    assert kept.lam_plain is not None
    assert 0 < abs(number(kept.lam_plain)) < Fraction(1, 10**12)
    (lost,) = points(problem(PENDULUM), "lie2", [100])
    assert lost.lambda_limited_by == "truncation"
    assert lost.lam is not None
    assert abs(number(lost.lam)) > Fraction(1, 10**9)


# -- orders ---------------------------------------------------------------------------------------


EXPLICIT = [name for name in schemes.names() if schemes.get(name).explicit]


@pytest.mark.left_to_ci
@pytest.mark.parametrize("hamiltonian", [DUFFING, PENDULUM], ids=["duffing", "pendulum"])
def test_every_scheme_has_the_order_that_it_claims(hamiltonian: Hamiltonian) -> None:
    of = problem(hamiltonian)
    assert len(EXPLICIT) >= 11
    for name in EXPLICIT[hamiltonian is PENDULUM :: 2]:  # each for one of the two
        claimed = schemes.get(name).order
        steps = [64, 128, 256, 512, 1024] if claimed < 4 else [16, 32, 64, 128, 256]
        found = error_slope(points(of, name, steps if claimed < 5 else [8, 16, 32, 64]))
        assert found.value is not None, (name, found)
        assert abs(float(found.value) - claimed) < 0.1, (name, found)


# The exact series to second order for the oscillator, and with one coefficient wrong.
SECOND = "p_next = p - h*q - h**2/2*p; q_next = q + h*p - h**2/2*q"


@pytest.mark.parametrize(
    ("scheme", "order"), [(SECOND, 2), (SECOND.replace("h**2/2*p", "h**2/3*p"), 1)]
)
def test_a_wrong_coefficient_shows_in_the_order(scheme: str, order: int) -> None:
    found = error_slope(points(problem(HARMONIC), scheme, [64, 128, 256, 512]))
    assert found.value is not None
    assert abs(float(found.value) - order) < 0.1


def test_points_limited_by_rounding_are_recognised_and_kept_out_of_the_slope() -> None:
    found = points(problem(DUFFING), "rk4", [16, 32, 64, 128, 256, 4096, 8192, 16384])
    assert [p.limited_by for p in found] == ["truncation"] * 5 + ["rounding"] * 3
    value = error_slope(found).value
    assert value is not None
    assert abs(float(value) - 4) < 0.1
    every = [(log10_of(p.step_size or ""), log10_of(p.error.value)) for p in found if p.error]
    assert slope(every)[0] < 3.5, "without the exclusion the order is wrong"


def test_too_few_points_have_no_slope_and_say_so() -> None:
    found = error_slope(points(problem(DUFFING), "lie2", [64, 128]))
    assert found.value is None
    assert "2 points" in found.reason


def test_a_slope_that_has_not_settled_is_not_given() -> None:
    steep = points(problem(DUFFING, q="3", time=20), "lie4", [200, 400, 800])
    found = error_slope(steep)
    assert found.value is None
    assert "settled" in found.reason


def test_runs_whose_error_is_larger_than_the_orbit_have_no_order() -> None:
    # Pushed off a wall at once, every one goes with the speed of its first kick, which is as h.
    lost = problem(Hamiltonian.parse("p**2/2 + 1/q"), q="1/10000", time=1)
    found = points(lost, "stormer-verlet", [2, 4, 8])
    near_alone = error_slope(found, lost.scale)
    assert near_alone.value is None
    assert "with 3 more the error is larger than the orbit" in near_alone.reason
    assert error_slope(found).value is not None, "without the exclusion there is one"


def test_the_order_of_the_area_error_is_measured_or_told_to_be_none() -> None:
    of = problem(PENDULUM)
    found = lambda_slope(points(of, "lie3", [64, 128, 256, 512]), False)
    assert found.value is not None
    assert abs(float(found.value) - 3) < 0.1
    kept = lambda_slope(points(of, "stormer-verlet", [4, 8, 16]), True)
    assert kept.value is None
    assert "proved" in kept.reason


# -- failed runs ----------------------------------------------------------------------------------


def test_a_failed_run_stands_with_the_step_at_which_it_failed() -> None:
    h, at = 1.0, None
    p, q = 0.0, 20.0
    for k in range(1, 40):
        p, q = p + h * -(q + q**3 if abs(q) < 1e100 else math.inf), q + h * p
        if not (math.isfinite(p) and math.isfinite(q)):
            at = k
            break
    (bad,) = points(problem(DUFFING, q="20", time=40), "lie1", [40])
    (good,) = points(problem(DUFFING, q="2"), "lie1", [40])
    assert bad.limited_by == "failed"
    assert bad.failed_step is not None
    assert at is not None
    assert abs(bad.failed_step - at) <= 1
    assert bad.error is bad.seconds_min is None
    assert good.limited_by != "failed"


# -- operations -----------------------------------------------------------------------------------


@pytest.mark.parametrize("scheme", ["lie3", "rk4", "stormer-verlet", "symplectic-euler"])
@pytest.mark.parametrize("hamiltonian", [DUFFING, PENDULUM], ids=["duffing", "pendulum"])
def test_operations_are_those_in_the_loop_of_the_source(
    scheme: str, hamiltonian: Hamiltonian
) -> None:
    ladder = Ladder(problem(hamiltonian), scheme)
    (loop,) = (x for x in ast.walk(ast.parse(ladder.kernel.source)) if isinstance(x, ast.For))
    found = [type(x.op) for x in ast.walk(loop) if isinstance(x, ast.BinOp)]
    calls = [x for x in ast.walk(ast.Module(loop.body, [])) if isinstance(x, ast.Call)]
    cost = ladder.cost
    assert cost.additions == found.count(ast.Add) + found.count(ast.Sub)
    assert cost.multiplications == found.count(ast.Mult)
    assert cost.divisions == found.count(ast.Div)
    assert sum(cost.functions.values()) == len(calls)


def test_gradients_are_counted_where_a_scheme_is_made_of_them() -> None:
    of = problem(DUFFING)
    assert Ladder(of, "rk4").cost.gradient == {"H_p": 4, "H_q": 4}
    assert Ladder(of, "stormer-verlet").cost.gradient == {"H_p": 1, "H_q": 2}
    assert Ladder(of, "lie2").cost.gradient is None


# -- the whole ------------------------------------------------------------------------------------


def done(**changes: Any) -> WorkPrecisionResult:
    found = compute_task(work_task(**changes))
    assert isinstance(found, WorkPrecisionResult)
    return found


def test_every_finished_point_has_its_run_times_and_the_result_survives_json() -> None:
    found = done()
    for line in found.lines:
        for point in line.points:
            assert point.seconds_min is not None
            assert point.seconds_median is not None
            assert 0 < point.seconds_min <= point.seconds_median
    (compared,) = found.comparisons
    assert (compared.one, compared.other) == ("lie2", "stormer-verlet")
    assert WorkPrecisionResult.model_validate_json(found.model_dump_json()) == found


def test_an_orbit_that_does_not_reach_the_time_is_bad_input() -> None:
    with pytest.raises(InputError, match=r"work_precision\.time=20"):
        done(hamiltonian="p**2/2 - q**4", time=20, step_sizes=("0.5", "0.25"),
             number_systems_step_size="0.5")  # fmt: skip


def test_number_systems_give_the_digits_that_were_asked_for() -> None:
    found = done(
        schemes=("lie2",), step_sizes=("0.1", "0.05"), number_systems=("float64", "mpfr", "ball"),
        digits=(20, 40), number_systems_step_size="0.1",
    ).systems  # fmt: skip
    assert [(s.arithmetic, s.digits) for s in found] == [
        ("float64", 17), ("mpfr", 20), ("mpfr", 40), ("ball", 20), ("ball", 40),
    ]  # fmt: skip
    for system in found:
        assert system.certified is not None
        least = 14 if system.arithmetic == "float64" else system.digits - 1
        assert least < float(system.certified) < system.digits + 1


@pytest.mark.parametrize("name", ["DOP853", "Taylor (heyoka)"])
def test_a_peer_is_held_against_the_same_exact_solution(name: str) -> None:
    pytest.importorskip({"DOP853": "scipy"}.get(name, "heyoka"))
    line = done(schemes=("lie2",), peers=(name,)).lines[-1]
    assert (line.name, line.peer, line.cost) == (name, True, None)
    errors = [float(p.error.value) for p in line.points if p.error]
    assert len(errors) == len(line.points)
    assert errors[-1] < 1e-12 < errors[0] < 1e-1
    assert all(p.step_size is None and p.tolerance and p.limited_by == "tolerance"
               for p in line.points)  # fmt: skip
    assert line.error_slope.value is None


def test_heyoka_takes_numbers_that_are_no_binary_fractions() -> None:
    pytest.importorskip("heyoka")
    found = done(
        hamiltonian="p**2/2 + delta*(1 + q**2)**(1/3)", parameters={"delta": "7/3"},
        schemes=("lie2",), peers=("Taylor (heyoka)",),
    )  # fmt: skip
    last = found.lines[-1].points[-1]
    assert last.error is not None, last.reason
    assert float(last.error.value) < 1e-13


def test_digits_beyond_the_range_of_float_are_told() -> None:
    found = run(
        PENDULUM, "lie2", q=Fraction(1), p=Fraction(0),
        step_size=Fraction(1, 4), steps=4, arithmetic="mpfr", digits=350, observables=(),
    )  # fmt: skip
    digits = _digits_of_state(found)
    assert digits is not None
    assert 345 < float(digits) < 370
