"""Certified runs contain the true values, and lose no more digits than a table says.

The true values: exact rationals for a few steps of a polynomial H; balls for windows, our own ones
and those of `verify.arithmetic.systems.ball`; runs with 64 more bits for 10⁵ to 10⁶ steps; and
values that were computed elsewhere. Random orbits are in
`tests/property/runs/test_a_posteriori.py`, and lies in `test_a_posteriori_controls.py`.
"""

from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.exact_orbits import (
    OBSERVABLES,
    Case,
    True_,
    assert_contained,
    case,
    enclosed_finely,
    exact,
)
from tests.paths import vectors
from verify.arithmetic.exact import magnitude
from verify.arithmetic.number_system import Arithmetic
from verify.arithmetic.systems import ball, fixed, mpfr, mpmath
from verify.kernels.stepping import KernelRun, RunOutcome
from verify.runs.a_posteriori_bound import certify

VECTORS = vectors()
DUFFING, PENDULUM = "p**2/2 + q**2/2 + delta*q**4/4", "p**2/2 - cos(q)"
SYSTEMS = [fixed.at_bits(112), mpfr.at_bits(24), mpfr.at_bits(120), mpmath.at_bits(60)]
systems = pytest.mark.parametrize("arithmetic", SYSTEMS, ids=lambda a: f"{a.name}-{a.bits}")


def certified(
    kernel_run: KernelRun, arithmetic: Arithmetic
) -> tuple[RunOutcome, dict[str, Fraction]]:
    """A run to its end, and its certificate."""
    run = kernel_run.run(arithmetic, tangent=True)
    assert run.done == kernel_run.steps
    errors = certify(kernel_run, arithmetic, run)
    assert errors is not None
    return run, errors


def digits(value: Fraction, error: Fraction) -> int:
    """How many digits are known: 10 for 1 ± 10⁻¹⁰."""
    return magnitude(value) - magnitude(error)


# -- a few steps, exactly -------------------------------------------------------------------------

EXACTLY = {
    "duffing-lie2": case(DUFFING, "lie2", "3/2", "1/3", "1/70", 4, delta="7/3"),
    "duffing-lie3": case(DUFFING, "lie3", "1.1", "0.7", "0.1", 3, delta=1),
    "duffing-lie5": case(DUFFING, "lie5", "0.9", "-1/3", "1/7", 2, delta=1),
    "duffing-euler": case(DUFFING, "symplectic-euler", "3/2", "1/3", "1/7", 6, delta="1/3"),
    "henon-lie1": case("p**2/2 + q**2/2 - q**3/3", "lie1", "1/7", "-1/3", "1/2", 6),
    "mixed-lie4": case("p**2*q - p*q**2/3", "lie4", "1/7", "-1/3", "1/2", 2),
    "a-map": case("p**2", "p_next = p/2 + h*q**2; q_next = q - h*p_next**2/3", "1/7", "0.3", 1, 5),
}


@pytest.mark.sample(7)
@systems
@pytest.mark.parametrize("name", EXACTLY)
def test_a_few_steps_contain_what_rational_numbers_give(name: str, arithmetic: Arithmetic) -> None:
    at = EXACTLY[name]
    run, errors = certified(at.kernel_run(), arithmetic)
    assert set(errors) == {"p", "q", *OBSERVABLES}
    assert_contained(run.values, errors, exact(at), at)


@pytest.mark.parametrize("name", EXACTLY)
def test_our_balls_contain_what_rational_numbers_give(name: str) -> None:
    """The oracle of longer orbits, against that of the short ones."""
    at = EXACTLY[name]
    balls = enclosed_finely(at, dict.fromkeys(OBSERVABLES, Fraction(1, 10**30)))
    for value, (true, _) in exact(at).items():
        middle, radius = balls[value]
        assert abs(middle - true) <= radius <= Fraction(1, 10**33)


# -- windows, by balls ----------------------------------------------------------------------------

WINDOWS = {
    "duffing-lie2": case(DUFFING, "lie2", "3/2", 0, "1/1000", 1500, delta=1),
    "duffing-lie4": case(DUFFING, "lie4", "0.5", "0.25", "1/50", 300, delta="7/3"),
    "pendulum-lie2": case(PENDULUM, "lie2", "3/2", "3/2", "1/100", 1500),
    "pendulum-euler": case(PENDULUM, "symplectic-euler", "3/2", "1/2", "1/10", 500),
    "roots": case("sqrt(1 + p**2) + log(2 + q**2)", "lie2", "1.2", "0.3", "1/20", 200),
    "quotient": case("p**2/(2 + q**2) + q**4/4", "lie1", "0.7", "0.2", "1/50", 200),
}


@pytest.mark.sample(5)
@systems
@pytest.mark.parametrize("name", WINDOWS)
def test_a_window_contains_what_balls_give(name: str, arithmetic: Arithmetic) -> None:
    at = WINDOWS[name]
    kernel_run = at.kernel_run()
    run = kernel_run.run(arithmetic, tangent=True)
    errors = certify(kernel_run, arithmetic, run)
    assert errors is not None or arithmetic.bits == 24, "with 24 bits an error may be too large"
    if errors is not None:
        assert_contained(run.values, errors, enclosed_finely(at, errors), at)


@pytest.mark.parametrize("name", WINDOWS)
def test_ball_arithmetic_and_every_checkpoint_of_a_certified_run_overlap(name: str) -> None:
    at, wide = WINDOWS[name], ball.at_bits(1000)
    kernel_run, own = at.kernel_run(), mpfr.at_bits(100)
    run = kernel_run.run(own, tangent=True)
    steps = [int(note["done"]) for note in run.tangents]
    for note in (0, len(steps) // 2, len(steps) - 1):
        errors = certify(kernel_run, own, run, note)
        assert errors is not None
        here = Case(at.text, at.scheme, at.q, at.p, at.h, steps[note], at.parameters)
        true = here.kernel_run().run(wide)
        found: dict[str, True_] = {n: (x, true.radii[n]) for n, x in true.values.items()}
        assert_contained(run.trail[note], errors, found, here)


# -- values from elsewhere ------------------------------------------------------------------------


@pytest.mark.sample(5)
@pytest.mark.parametrize("given", VECTORS, ids=["duffing-lie2", "pendulum", "duffing-lie3"])
@pytest.mark.parametrize("arithmetic", [fixed.at_bits(240), mpfr.at_bits(200), mpmath.at_bits(90)],
                         ids=lambda a: a.name)  # fmt: skip
def test_values_that_were_computed_elsewhere_are_contained(
    given: dict[str, Any], arithmetic: Arithmetic
) -> None:
    at = case(given["hamiltonian"], given["scheme"], given["q0"], given["p0"], given["step_size"],
              given["steps"], **given["parameters"])  # fmt: skip
    run, errors = certified(at.kernel_run(), arithmetic)
    errors = {n: error for n, error in errors.items() if n in given}
    true = {n: (Fraction(given[n]), unit_before_the_last(given[n])) for n in errors}
    assert_contained(run.values, errors, true, at)
    known = min(digits(run.values[n], error) for n, error in errors.items())
    assert known >= {"fixed": 55, "mpfr": 40, "mpmath": 8}[arithmetic.name]


def unit_before_the_last(decimal: str) -> Fraction:
    places = len(decimal.partition("e")[0].partition(".")[2])
    return Fraction(10) ** (int(decimal.partition("e")[2]) - places + 1)


# -- long runs ------------------------------------------------------------------------------------

BITS, MORE = 176, 240
# Digits that fixed-point numbers of 176 bits, which have 52, leave of p, q, Λ, MSE and max |ΔJ|,
# the least of p's and q's; and those of a run five times as long.
LONG = {
    "duffing-lie2": (case(DUFFING, "lie2", "3/2", 0, "1/1000", 200_000, delta=1), 38, 36, 38),
    "duffing-lie2-long": (case(DUFFING, "lie2", "3/2", 0, "1/1000", 10**6, delta=1), 37, 34, 36),
    "duffing-lie3": (case(DUFFING, "lie3", "1/2", "1/4", "1/50", 200_000, delta="7/3"), 38, 37, 37),
    "duffing-lie4": (case(DUFFING, "lie4", "3/2", 0, "1/100", 100_000, delta=1), 36, 33, 35),
    "pendulum-lie2": (case(PENDULUM, "lie2", "3/2", 0, "1/1000", 200_000), 41, 38, 40),
    "pendulum-lie3": (case(PENDULUM, "lie3", "3/2", "3/2", "1/100", 100_000), 36, 35, 34),
    "pendulum-euler": (case(PENDULUM, "symplectic-euler", "3/2", 0, "1/100", 200_000), 39, 0, 0),
}  # fmt: skip


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize("name", LONG)
def test_a_long_run_contains_what_64_more_bits_give_and_keeps_its_digits(name: str) -> None:
    at, state, product, others = LONG[name]
    kernel_run = at.kernel_run() if product else at.kernel_run(frozenset())
    run, errors = certified(kernel_run, fixed.at_bits(BITS))
    finer, finer_errors = certified(kernel_run, fixed.at_bits(MORE))
    true = {n: (x, finer_errors[n]) for n, x in finer.values.items()}
    assert_contained(run.values, errors, true, at)
    expected = {"p": state, "q": state, "lambda": product, "mse": others, "delta_j_max": others}
    for value, least in expected.items():
        if value in errors:
            assert digits(run.values[value], errors[value]) >= least, value


@pytest.mark.parametrize(
    "arithmetic", [mpfr.at_bits(100), fixed.at_bits(112)], ids=lambda a: a.name
)
def test_every_checkpoint_of_a_long_run_contains_what_64_more_bits_give(
    arithmetic: Arithmetic,
) -> None:
    kernel_run = case(PENDULUM, "lie2", "3/2", "3/2", "1/100", 30_000).kernel_run()
    run, finer = (kernel_run.run(a, tangent=True) for a in (arithmetic, fixed.at_bits(BITS)))
    for note, (rough, fine) in enumerate(zip(run.trail, finer.trail, strict=True)):
        errors, small = (
            certify(kernel_run, *pair, note)
            for pair in ((arithmetic, run), (fixed.at_bits(BITS), finer))
        )
        assert errors
        assert small
        assert_contained(rough, errors, {n: (x, small[n]) for n, x in fine.items()}, note)


# -- orbits along which errors grow exponentially -------------------------------------------------

EXPONENTIAL = {
    "saddle": ("p**2/2 - q**2/2", "lie2", Fraction(1, 3), Fraction(1, 7), Fraction(1, 10)),
    "near-the-separatrix": (PENDULUM, "lie2", Fraction(0), 2 - Fraction(1, 10**6), Fraction(1, 10)),
    "at-the-top": (PENDULUM, "lie3", Fraction(22, 7), Fraction(0), Fraction(1, 10)),
    "chaos": (PENDULUM, "symplectic-euler", Fraction(22, 7), Fraction(0), Fraction(3, 2)),
    "henon": ("p**2/2 + q**2/2 - q**3/3", "symplectic-euler", Fraction(1, 100), Fraction(-1, 2),
              Fraction(1)),
}  # fmt: skip


@pytest.mark.left_to_ci
@pytest.mark.sample(5)
@pytest.mark.parametrize("arithmetic", [fixed.at_bits(112), mpfr.at_bits(60), mpmath.at_bits(60)],
                         ids=lambda a: a.name)  # fmt: skip
@pytest.mark.parametrize("name", EXPONENTIAL)
def test_where_errors_grow_exponentially_a_certificate_holds_as_long_as_there_is_one(
    name: str, arithmetic: Arithmetic
) -> None:
    made = 0
    for doublings in range(1, 13):
        at = Case(*EXPONENTIAL[name], 2**doublings)
        kernel_run = at.kernel_run()
        run = kernel_run.run(arithmetic, tangent=True)
        errors = certify(kernel_run, arithmetic, run) if run.done == at.steps else None
        if errors is None:
            break
        assert_contained(run.values, errors, enclosed_finely(at, errors), at)
        made += 1
    assert made >= 1
    assert errors is None or (
        arithmetic.bits > 60 and name in ("near-the-separatrix", "at-the-top")
    )


def test_an_arithmetic_whose_rounding_is_not_known_gets_no_certificate() -> None:
    kernel_run, new = (
        case(PENDULUM, "lie2", "3/2", 0, "1/10", 20).kernel_run(),
        replace(mpfr.at_bits(60), name="new", rounding=None),
    )
    assert certify(kernel_run, new, kernel_run.run(new, tangent=True)) is None
