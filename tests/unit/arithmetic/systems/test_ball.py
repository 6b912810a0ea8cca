"""Runs in ball arithmetic: every true value lies within its bound.

The true values come from exact Fractions, from `tests/data/vectors.json`, or from mpmath at many
more digits than the orbit can lose.
"""

import dataclasses
import math
from fractions import Fraction
from itertools import islice
from typing import Any

import flint
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.paths import vectors
from tests.unit.runs.test_run_range import duffing_steps
from verify import arithmetic
from verify.arithmetic.arb import midpoint_and_radius
from verify.arithmetic.systems import ball
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import kernel_for
from verify.kernels.stepping import KernelRun
from verify.runs import digits_on_demand
from verify.runs.requested_run import run
from verify.scenes.observables import CLOSED_FORM, REPORTED
from verify.scenes.results.run import RunResult

VECTORS = vectors()
DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + q**4/4")
PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
VALUES = (*REPORTED, "q", "p")


def unit_of(value: str) -> Fraction:
    """The unit of the last printed digit."""
    mantissa, _, exponent = value.partition("e")
    return Fraction(10) ** (int(exponent) - len(mantissa.partition(".")[2]))


def error_of(found: RunResult, name: str, true: Fraction) -> Fraction:
    """How far beyond its bound a value is; not positive where it is enclosed."""
    value = found.values[name]
    return abs(Fraction(value.value) - true) - Fraction(value.bound)


# -- enclosures -----------------------------------------------------------------------------------


@pytest.mark.sample(6)
@pytest.mark.parametrize("digits", [5, 17, 50, 120])
@pytest.mark.parametrize("case", VECTORS, ids=["duffing-lie2", "pendulum", "duffing-lie3"])
def test_the_vectors_are_enclosed_with_the_digits_asked_for(
    case: dict[str, Any], digits: int
) -> None:
    found = run(Hamiltonian.parse(case["hamiltonian"], case["parameters"]), case["scheme"],
                q=case["q0"], p=case["p0"], step_size=case["step_size"], steps=case["steps"],
                arithmetic="ball", digits=digits, observables=REPORTED)  # fmt: skip
    assert (found.status, found.error_kind) == ("finished", "enclosed")
    for name in VALUES:
        true = case["lambda" if name == "lambda_plain" else name]
        assert error_of(found, name, Fraction(true)) <= unit_of(true), name
        assert len(found.values[name].value.partition("e")[0].strip("-")) >= digits, name
        assert Fraction(found.values[name].bound) <= unit_of(found.values[name].value), name


rationals = st.fractions(-2, 2, max_denominator=1000)


@drawn(150)
@given(
    q=rationals,
    p=rationals,
    h=st.fractions("1/100", "1/2", max_denominator=100),
    steps=st.integers(1, 6),
    bits=st.integers(8, 60),
)
def test_balls_hold_the_exact_values_however_few_bits_they_have(
    q: Fraction, p: Fraction, h: Fraction, steps: int, bits: int
) -> None:
    kernel_run = KernelRun(DUFFING, "lie2", {"q": q, "p": p, "h": h}, steps, frozenset(REPORTED), 0)
    found = kernel_run.run(ball.at_bits(bits))
    if found.done < steps:
        return  # so few bits that nothing is known, which is said
    orbit = list(islice(duffing_steps(q, p, h), steps))
    all_dj = [dj for _, _, dj in orbit]
    lam = math.prod((1 + dj for dj in all_dj), start=Fraction(1)) - 1
    true = {"p": orbit[-1][0], "q": orbit[-1][1], "lambda": lam, "lambda_plain": lam,
            "mse": sum(dj**2 for dj in all_dj) / steps,
            "delta_j_max": max(map(abs, all_dj))}  # fmt: skip
    for name in VALUES:
        assert abs(found.values[name] - true[name]) <= found.radii[name], name


def test_the_exact_input_is_enclosed_where_no_number_is_it() -> None:
    """1/3 and 1/70 are no binary numbers: the runs from what they are rounded to differ."""
    at: dict[str, Any] = {"q": "1/3", "p": "1/7", "step_size": "1/70", "steps": 100}
    fine = run(DUFFING, "lie3", **at, arithmetic="mpmath", digits=60)
    found = run(DUFFING, "lie3", **at, arithmetic="ball", digits=20)
    for name in ("p", "q", *CLOSED_FORM):
        assert error_of(found, name, Fraction(fine.values[name].value)) <= 0, name


def test_the_greatest_of_balls_that_overlap_holds_the_greatest_of_the_true_values() -> None:
    """Balls of initial values: whichever orbit is followed, its max |ΔJ| is in the last ball."""
    made = ball.at_bits(60)
    functions = {n: f for n, f in made.functions.items() if n not in ("minimum", "maximum")}
    # Another name, since kernels are kept by name and precision.
    naive = dataclasses.replace(made, name="naive", functions=functions)
    h, around, wide = Fraction(1, 10), Fraction(1, 20), flint.arb(0, 0.05)

    def misses(made: Any, q: Fraction, p: Fraction) -> bool:
        kernel = kernel_for(DUFFING, "lie2", made, frozenset({"delta_j_max"}))
        with made.context():
            start = made.number(p) + wide, made.number(q) + wide
            top = kernel.function(5, made.number(h), *start, made.number(Fraction(0)))[-1]
        ends = [
            max(abs(dj) for _, _, dj in islice(duffing_steps(q + a, p + b, h), 5))
            for a in (-around, 0, around)
            for b in (-around, 0, around)
        ]
        return any(abs(made.exact(top) - true) > made.radius(top) for true in ends)

    starts = [(Fraction(q, 5), Fraction(p, 5)) for q in range(-10, 11, 4) for p in (-4, 0, 4)]
    assert not any(misses(made, *at) for at in starts)
    assert any(misses(naive, *at) for at in starts), "the twin: an order that is not certain"


def test_a_series_holds_the_extremes_of_the_true_values() -> None:
    at: dict[str, Any] = {"q": "3/2", "p": 0, "step_size": "1/20", "steps": 700, "points": 30}
    fine = run(DUFFING, "lie2", **at, arithmetic="mpmath", digits=40)
    found = run(DUFFING, "lie2", **at, arithmetic="ball", digits=10)
    assert found.series == fine.series, "to the seven digits that are shown"


# -- where balls grow too wide --------------------------------------------------------------------

CHAOTIC: dict[str, Any] = {"q": "2/7", "p": "-1/9", "step_size": 2}  # the standard map, K = 4


def test_precision_is_raised_until_the_digits_asked_for_are_known() -> None:
    found = run(PENDULUM, "symplectic-euler", **CHAOTIC, steps=300, arithmetic="ball", digits=10)
    true = run(PENDULUM, "symplectic-euler", **CHAOTIC, steps=300, arithmetic="mpmath", digits=300)
    assert (found.status, found.error_kind) == ("finished", "enclosed")
    for name in "qp":
        assert error_of(found, name, Fraction(true.values[name].value)) <= 0
        assert len(found.values[name].value.partition("e")[0].strip("-")) == 11
    assert int(found.error_method.split()[-2]) > 100, "digits enough to lose a hundred"


def test_what_would_need_too_many_digits_is_given_none_and_says_how_many() -> None:
    found = run(PENDULUM, "symplectic-euler", **CHAOTIC, steps=8000, arithmetic="ball", digits=5)
    assert (found.status, found.error_kind, found.values) == ("unresolved", "estimated", {})
    assert "too wide" in found.error_method
    wanted = int(found.error_method.split(";")[1].split()[0])
    assert 3000 < wanted < 9000, "K = 4 costs log10(2) to log10(6) digits a step"


def test_the_number_of_attempts_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(digits_on_demand, "_BALL_ATTEMPTS", 1)
    found = run(PENDULUM, "symplectic-euler", **CHAOTIC, steps=300, arithmetic="ball", digits=10)
    assert found.status == "unresolved"
    easy = run(PENDULUM, "symplectic-euler", **CHAOTIC, steps=3, arithmetic="ball", digits=10)
    assert easy.status == "finished"


def test_a_run_that_is_given_up_early_costs_no_more_than_its_digits_last() -> None:
    """Balls are looked at often: 10⁹ steps are not done with balls that hold everything."""
    found = run(PENDULUM, "symplectic-euler", **CHAOTIC, steps=10**9, arithmetic="ball", digits=5)
    assert found.status == "unresolved"
    assert found.seconds < 10


def test_a_product_that_may_be_exactly_one_is_known_by_how_near_it_is() -> None:
    found = run(PENDULUM, "symplectic-euler", q=1, p=0, step_size="0.1", steps=100,
                arithmetic="ball", digits=30, observables=REPORTED)  # fmt: skip
    assert found.values["lambda_plain"].value == "0"
    assert 0 < Fraction(found.values["lambda_plain"].bound) < Fraction(1, 10**30)
    assert found.values["lambda"].bound == "0", "this one is proved"


# -- where a map is not defined -------------------------------------------------------------------


@pytest.mark.parametrize(
    "text", ["p**2/2 + q*sqrt(q)", "p**2/2 + q*log(q)", "p**2/2 + q**(4/3)", "p**2/2 + 1/q**2 + q"]
)
@pytest.mark.parametrize("p", ["-1", "1/5", "-7/3"])
def test_an_orbit_leaves_the_domain_at_the_step_at_which_it_does_in_mpmath(
    text: str, p: str
) -> None:
    at: dict[str, Any] = {"q": 1, "p": p, "step_size": "1/13", "steps": 60, "digits": 12}
    ours, theirs = (
        run(Hamiltonian.parse(text), "symplectic-euler", **at, arithmetic=n)
        for n in ("ball", "mpmath")
    )
    assert (ours.status, ours.failed_step) == (theirs.status, theirs.failed_step)


@pytest.mark.parametrize(("q", "h"), [(3, 1), (40, "1/8")])
def test_an_orbit_escapes_where_it_or_a_sum_along_it_is_too_large(q: int, h: str) -> None:
    at: dict[str, Any] = {"q": q, "p": 0, "step_size": h, "steps": 2000, "digits": 20}
    theirs = run(DUFFING, "lie2", **at, arithmetic="mpmath", observables=())
    assert theirs.failed_step is not None
    bare = run(DUFFING, "lie2", **at, arithmetic="ball", observables=())
    assert (bare.status, bare.failed_step) == ("left range", theirs.failed_step)
    full = run(DUFFING, "lie2", **at, arithmetic="ball")
    assert full.status == "left range"
    assert full.failed_step in (theirs.failed_step - 1, theirs.failed_step), "ΔJ² is larger than q"


def test_a_step_past_a_pole_is_resolved_where_more_digits_tell_it_from_the_pole() -> None:
    near = Fraction(1, 10**25)
    scheme = "p_next = p; q_next = q + h/(q - 1)"
    found = run(Hamiltonian.parse("p**2/2 + q**2"), scheme, q=1 + near, p=0, step_size=1, steps=1,
                arithmetic="ball", digits=5, observables=())  # fmt: skip
    assert found.status == "finished"
    assert error_of(found, "q", 1 + near + 10**25) <= 0
    assert found.error_method == "ball arithmetic with 34 digits"
    at_it = run(Hamiltonian.parse("p**2/2 + q**2"), scheme, q=1, p=0, step_size=1, steps=1,
                arithmetic="ball", digits=5, observables=())  # fmt: skip
    assert (at_it.status, at_it.failed_step) == ("left range", 1)


def test_the_radius_is_what_flint_says_and_not_less() -> None:
    made = arithmetic.get("ball", 30)
    third = made.number(Fraction(1, 3))
    assert made.radius is not None
    assert abs(made.exact(third) - Fraction(1, 3)) <= made.radius(third)
    assert made.radius(third) <= Fraction(1, 2**made.bits)
    assert math.isclose(float(made.radius(third)), float(third.rad()), rel_tol=1e-9)


def test_a_ball_too_large_is_refused_and_one_too_small_is_around_0() -> None:
    with pytest.raises(OverflowError, match="too large"):
        midpoint_and_radius(flint.arb(2) ** 2**40)
    for tiny in (flint.arb(3) ** -(2**40), -(flint.arb(3) ** -(2**40))):
        middle, radius = midpoint_and_radius(tiny)
        assert middle == 0
        assert 0 < radius < Fraction(1, 2**100_000)
        assert abs(tiny) < flint.arb(2) ** -100_000
    middle, radius = midpoint_and_radius(flint.arb(1, flint.arb(2) ** -(2**40)))
    assert middle == 1
    assert 0 < radius < Fraction(1, 2**100_000)
    assert midpoint_and_radius(flint.arb(2) ** -1000) == (Fraction(1, 2**1000), 0)


def test_a_defect_that_is_next_to_nothing_is_no_crash() -> None:
    """exp(−q²) far out: the least ΔJ of a step is of an exponent that no rational is made of."""
    found = run(Hamiltonian.parse("p**2/2 + exp(-q**2)"), "lie1", q=1, p=1, steps=100, points=1,
                step_size=Fraction(5, 2), arithmetic="ball", digits=1)  # fmt: skip
    assert found.status == "finished"
    low, high = map(Fraction, found.series[0].delta_j)
    assert low < 0 < high
    assert abs(low) < Fraction(1, 10**30_000)
