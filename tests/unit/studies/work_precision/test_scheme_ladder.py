"""One scheme over step sizes: errors against closed forms, orders, what limits a point, costs."""

import ast
import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import mpmath
import pytest

import verify
from tests.helpers.constructed.work import reference_problem
from verify import schemes
from verify.arithmetic.arb import slope
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.systems import get
from verify.scenes.results.work_precision import WorkPoint
from verify.studies.work_precision.ladder import ROUNDING_SHARE, SchemeLadder
from verify.studies.work_precision.problem import ReferenceProblem
from verify.studies.work_precision.work_lines import error_slope, lambda_slope, log10_of

HARMONIC = Hamiltonian.parse("p**2/2 + q**2/2")
DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4", {"delta": 1})
PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
HENON, KEPLER = get("henon-heiles").hamiltonian(), get("kepler").hamiltonian({"mu": 1})
STARTS: dict[Hamiltonian, dict[str, Any]] = {
    HENON: {"q": [0, "0.1"], "p": ["0.4", 0]}, KEPLER: {"q": ["2/5", 0], "p": [0, 2]},
}  # fmt: skip


def problem(hamiltonian: Hamiltonian, q: str = "1", time: Fraction | int = 1) -> ReferenceProblem:
    """From (q, 0) in the plane."""
    start = STARTS.get(hamiltonian, {"q": q, "p": 0})
    return reference_problem(hamiltonian, Fraction(time), **start)


def points(of: ReferenceProblem, scheme: str, steps: Sequence[int]) -> list[WorkPoint]:
    ladder = SchemeLadder(of, scheme)
    return [ladder.point(of.time / n) for n in steps]


def number(value: Any) -> Fraction:
    return Fraction(value.value)


# -- errors ---------------------------------------------------------------------------------------


def test_where_h_does_not_divide_the_time_the_error_is_that_where_the_steps_end() -> None:
    h = Fraction(3, 10)
    rounded, whole = SchemeLadder(problem(PENDULUM), "rk4"), problem(PENDULUM, time=Fraction(9, 10))
    point, same = rounded.point(h), SchemeLadder(whole, "rk4").point(h)
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


def test_the_error_on_keplers_ellipse_is_that_from_its_closed_form() -> None:
    of = problem(KEPLER, time=3)
    assert "ellipse" in of.solution.method
    (fine,) = points(of, "yoshida4", [3000])
    assert number(fine.error) < Fraction(1, 10**6)
    assert number(fine.energy) < Fraction(1, 10**8)


def test_w_and_lambda_of_a_point_are_those_of_a_run() -> None:
    (point,) = points(problem(HENON, time=2), "lie2", [20])
    run = verify.run(HENON, "lie2", **STARTS[HENON], step_size="0.1", steps=20, digits=20)
    exact = Fraction(run.values["symplectic_defect"].value)
    assert abs(number(point.symplectic_defect) - exact) < Fraction(1, 10**12)
    assert abs(number(point.lam) - Fraction(run.values["lambda"].value)) < Fraction(1, 10**12)


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
        order = error_slope(points(of, name, steps if claimed < 5 else [8, 16, 32, 64]))
        assert order.value is not None, (name, order)
        assert abs(float(order.value) - claimed) < 0.1, (name, order)


# The exact series to second order for the oscillator, and with one coefficient wrong.
SECOND = "p_next = p - h*q - h**2/2*p; q_next = q + h*p - h**2/2*q"


@pytest.mark.parametrize(
    ("scheme", "order"), [(SECOND, 2), (SECOND.replace("h**2/2*p", "h**2/3*p"), 1)]
)
def test_a_wrong_coefficient_shows_in_the_order(scheme: str, order: int) -> None:
    measured = error_slope(points(problem(HARMONIC), scheme, [64, 128, 256, 512]))
    assert measured.value is not None
    assert abs(float(measured.value) - order) < 0.1


def test_points_limited_by_rounding_are_recognised_and_kept_out_of_the_slope() -> None:
    ladder = points(problem(DUFFING), "rk4", [16, 32, 64, 128, 256, 4096, 8192, 16384])
    assert [p.limited_by for p in ladder] == ["truncation"] * 5 + ["rounding"] * 3
    value = error_slope(ladder).value
    assert value is not None
    assert abs(float(value) - 4) < 0.1
    every = [(log10_of(p.step_size or ""), log10_of(p.error.value)) for p in ladder if p.error]
    assert slope(every)[0] < 3.5, "without the exclusion the order is wrong"


def test_too_few_points_have_no_slope_and_say_so() -> None:
    order = error_slope(points(problem(DUFFING), "lie2", [64, 128]))
    assert order.value is None
    assert "2 points" in order.reason


def test_a_slope_that_has_not_settled_is_not_given() -> None:
    steep = points(problem(DUFFING, q="3", time=20), "lie4", [200, 400, 800])
    order = error_slope(steep)
    assert order.value is None
    assert "settled" in order.reason


def test_runs_whose_error_is_larger_than_the_orbit_have_no_order() -> None:
    # Pushed off a wall at once, every one goes with the speed of its first kick, which is as h.
    lost = problem(Hamiltonian.parse("p**2/2 + 1/q"), q="1/10000", time=1)
    ladder = points(lost, "stormer-verlet", [2, 4, 8])
    near_alone = error_slope(ladder, lost.scale)
    assert near_alone.value is None
    assert "with 3 more the error is larger than the orbit" in near_alone.reason
    assert error_slope(ladder).value is not None, "without the exclusion there is one"


AREA, FORM = "ΔJ ≡ 0 is proved: Λ is exactly 0", "S ≡ 0 is proved: W is exactly 0"


@pytest.mark.parametrize(
    ("hamiltonian", "time", "scheme", "steps", "order", "proof"),
    [
        (PENDULUM, 1, "lie3", [64, 128, 256, 512], 3, ""),
        (PENDULUM, 1, "stormer-verlet", [4, 8, 16], 2, AREA),
        (HENON, 3, "lie2", [120, 240, 480], 2, ""),
        (HENON, 3, "rk4", [120, 240, 480], 4, ""),
        (HENON, 3, "yoshida4", [120, 240, 480], 4, FORM),
    ],
    ids=["plane-lie3", "plane-stormer-verlet", "degrees-lie2", "degrees-rk4", "degrees-yoshida4"],
)
def test_a_scheme_loses_the_form_with_its_order_or_keeps_it_by_proof(
    hamiltonian: Hamiltonian, time: int, scheme: str, steps: list[int], order: int, proof: str
) -> None:
    of = problem(hamiltonian, time=time)
    ladder = SchemeLadder(of, scheme)
    runs = [ladder.point(of.time / n) for n in steps]
    assert float(error_slope(runs).value or 0) == pytest.approx(order, abs=0.06)
    assert ladder.preserves_area is bool(proof)
    loss = lambda_slope(runs, bool(proof), structure=hamiltonian.structure)
    assert (loss.value is None, loss.reason) == (bool(proof), proof)
    assert proof or float(loss.value or 0) == pytest.approx(order, abs=0.1)
    for point in runs:
        defect = point.lam if hamiltonian.planar else point.symplectic_defect
        assert (number(defect) == 0) is bool(proof)
        assert (point.lam_plain is None) is not hamiltonian.planar


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
@pytest.mark.parametrize(
    "hamiltonian", [DUFFING, PENDULUM, HENON], ids=["duffing", "pendulum", "henon-heiles"]
)
def test_operations_are_those_in_the_loop_of_the_source(
    scheme: str, hamiltonian: Hamiltonian
) -> None:
    ladder = SchemeLadder(problem(hamiltonian), scheme)
    (loop,) = (x for x in ast.walk(ast.parse(ladder.kernel.source)) if isinstance(x, ast.For))
    operations = [type(x.op) for x in ast.walk(loop) if isinstance(x, ast.BinOp)]
    calls = [x for x in ast.walk(ast.Module(loop.body, [])) if isinstance(x, ast.Call)]
    cost = ladder.cost
    assert cost.additions == operations.count(ast.Add) + operations.count(ast.Sub)
    assert cost.multiplications == operations.count(ast.Mult)
    assert cost.divisions == operations.count(ast.Div)
    assert sum(cost.functions.values()) == len(calls)
    assert cost.additions >= 2 * hamiltonian.degrees, "one of each coordinate at least"


def test_gradients_are_counted_where_a_scheme_is_made_of_them() -> None:
    of = problem(DUFFING)
    assert SchemeLadder(of, "rk4").cost.gradient == {"H_p": 4, "H_q": 4}
    assert SchemeLadder(of, "stormer-verlet").cost.gradient == {"H_p": 1, "H_q": 2}
    assert SchemeLadder(of, "lie2").cost.gradient is None
