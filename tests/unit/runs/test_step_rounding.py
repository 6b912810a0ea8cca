"""What one step of a run loses is what its formulas say, and no number loses more."""

import random
from collections.abc import Callable
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import flint
import pytest

from tests.helpers.exact_orbits import case
from tests.helpers.run_bounds import CLOSE, ball, ctx, number
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number_system import Arithmetic
from verify.arithmetic.systems import fixed, mpfr, mpmath
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import bound_time_error
from verify.kernels.rounding import PRECISION_BITS, RoundedValue
from verify.kernels.step.lowering import Lowering
from verify.kernels.step.operations import StepProgram
from verify.kernels.stepping import KernelRun
from verify.runs.a_posteriori_bound import certify
from verify.runs.step_bounds import StepRounding

SEEDS = range(30)


def drawing(name: str) -> Callable[[], Any]:
    """Numbers of every size from 10⁻⁶ to 10³, of mpmath's."""
    draw = random.Random(name)  # noqa: S311 - sizes, no secret
    return lambda: ctx.mpf(10) ** ctx.mpf(draw.uniform(-6, 3))


def bare(**attributes: Any) -> StepRounding:
    """One of which only this is looked at."""
    made = object.__new__(StepRounding)
    vars(made).update(attributes)
    return made


@pytest.mark.parametrize("absolute", [True, False], ids=["fixed", "floating"])
def test_an_addition_loses_half_a_unit_of_a_sum_of_which_either_part_may_be_the_larger(
    absolute: bool,
) -> None:
    for seed in SEEDS:
        some = drawing(f"adding {seed}")
        size, inside, error, unit = some(), some(), some(), some()
        with working_precision(PRECISION_BITS):
            made = bare(arithmetic=SimpleNamespace(absolute=absolute), unit=ball(unit))
            found = made.error_of_addition(ball(size), RoundedValue(ball(-inside), ball(error)))
        true = error if absolute else error + (size + inside + error) * unit
        assert abs(number(found) / true - 1) < CLOSE


@pytest.mark.parametrize("size", [2, 4, 6])
def test_a_step_of_the_tangent_map_loses_what_its_products_and_sums_do(size: int) -> None:
    """Of entries of A − 1 that are read, each in float64 and off by what it was before."""
    unit = ctx.ldexp(1, -52)
    for seed in SEEDS:
        some = drawing(f"tangent {size} {seed}")
        program, entries = StepProgram(), size * size
        change = [program.input(f"approx(v{k})", static=False) for k in range(entries)]
        read = [(some(), some() * ctx.ldexp(1, -45)) for _ in range(entries)]
        tangent = SimpleNamespace(
            program=program, change=change, main_values=list(range(entries)),
            lowering=Lowering(program, (), "t"),
        )  # fmt: skip
        made = bare(kernel=SimpleNamespace(tangent=tangent), names=range(size))
        with working_precision(PRECISION_BITS):
            main = {k: RoundedValue(ball(x), ball(lost)) for k, (x, lost) in enumerate(read)}
            found = made.tangent_error(main)
            assert found is not None
        errors = [lost + (x + lost) * unit + ctx.ldexp(1, -96) for x, lost in read]
        error = ctx.sqrt(sum(e * e for e in errors))
        norm = ctx.sqrt(sum((x + e) ** 2 for (x, _), e in zip(read, errors, strict=True)))
        # A row times a column, 2n products and their sum, and its sum with the rest: n + 1 units.
        roundings = size // 2 + 1
        least = error + roundings * unit * norm
        assert least <= number(found) <= least + 2 * unit * (norm + error) + unit
        exact = (error + (roundings + 1) * unit * norm) * (1 + unit) + unit**2
        assert abs(number(found) / exact - 1) < CLOSE


def orbit(arithmetic: Arithmetic, **start: Fraction) -> tuple[KernelRun, StepRounding, Any]:
    """A run of H = p²/2 + c q³ − q t in time, and what is counted of it."""
    h = Hamiltonian.parse("p**2/2 + c*q**3 - q*t", {"c": Fraction(1, 3)})
    run = KernelRun(h, "lie2", start, 7, frozenset({"mse"}), 0)
    outcome = run.run(arithmetic, tangent=True)
    return run, StepRounding(run, arithmetic, outcome, -1), outcome


@pytest.mark.parametrize(
    "arithmetic", [fixed.at_bits(112), mpfr.at_bits(40)], ids=["fixed", "mpfr"]
)
def test_a_step_begins_where_the_run_has_been_with_what_its_inputs_are_off(
    arithmetic: Arithmetic,
) -> None:
    start = {"p": Fraction(1, 7), "q": Fraction(-2, 3), "h": Fraction(1, 30), "t": Fraction(5, 3)}
    run, rounding, outcome = orbit(arithmetic, **start)
    seen, margin = outcome.tangents[-1], Fraction(1, 1000)
    with working_precision(PRECISION_BITS):
        box, inputs = rounding.box(ball(ctx.mpf(1) / 1000)), rounding.inputs()
    for name in "pq":
        low, high = (Fraction(seen[f"{name}_{end}"]) for end in ("low", "high"))
        assert low < high
        rounded = Fraction(1, 2**50) * (1 + abs(low) + abs(high))
        ends = low - margin - rounded, high + margin + rounded
        first, last = ends_of(box[name])
        slack = Fraction(1, 2**25)  # a ball's radius has 30 bits
        assert ends[0] - slack < first <= ends[0] < ends[1] <= last < ends[1] + slack
        assert inputs[name].error.is_zero()
        assert inputs[name].interval.overlaps(box[name])
    shift, late = outcome.shift, start["t"] + run.steps * start["h"]
    assert set(inputs) > {"h", "t"}
    for name, exact in run.inputs(outcome.kernel, shift).items():
        off = abs(arithmetic.exact(arithmetic.number(exact)) - exact)
        assert off <= upper(inputs[name].error) <= off * (1 + Fraction(1, 2**60))
    assert upper(inputs["t"].error) >= bound_time_error(arithmetic, late) > 0
    first, last = ends_of(inputs["t"].interval)
    assert first <= start["t"] < late <= last
    assert last - first < Fraction(3, 10)


def ends_of(x: flint.arb) -> tuple[Fraction, Fraction]:
    with working_precision(PRECISION_BITS):
        return tuple(
            Fraction(int(m.p), int(m.q)) for m in (end.fmpq() for end in (x.lower(), x.upper()))
        )  # type: ignore[return-value]


def upper(x: flint.arb) -> Fraction:
    return ends_of(x)[1]


# -- orbits whose increments are larger than their states -----------------------------------------


@pytest.mark.parametrize("bits", [12, 24, 53, 100])
@pytest.mark.parametrize("size", ["1", "1000", "1/3"])
def test_one_step_from_nearly_nothing_is_within_its_bound(bits: int, size: str) -> None:
    """From q = 4.5·10⁻⁸ to 1: what is lost is half a unit of 1, not of what was there before."""
    for start in ("45/1000000000", "1/3000000", "-7/90000000"):
        at = case("p**2/2", f"p_next = p; q_next = q + {size}", start, 0, 1, 1)
        made = mpfr.at_bits(bits)
        found = at.kernel_run().run(made, tangent=True)
        errors = certify(at.kernel_run(), made, found)
        assert errors is not None
        true = at.q + Fraction(size)
        assert abs(found.values["q"] - true) <= errors["q"]
        # and is of the size of the sum's last place.
        assert errors["q"] <= 8 * Fraction(size) / 2**bits


# -- the clock ------------------------------------------------------------------------------------


@pytest.mark.parametrize("system", [fixed, mpfr, mpmath], ids=lambda x: x.NAME)
def test_the_time_at_the_last_step_is_within_what_is_said(system: Any) -> None:
    """A map that makes p the time of its step, of steps that no format holds."""
    bits = 112 if system is fixed else 30
    arithmetic, draw = system.at_bits(bits), random.Random("clock")  # noqa: S311 - no secret
    h_in_time = Hamiltonian.parse("p**2/2 - q*t")
    for _ in range(6):
        h, t0 = Fraction(draw.randint(1, 99), 3000), Fraction(draw.randint(-50, 50), 7)
        steps, zero = draw.randint(2000, 6000), Fraction(0)
        start = {"p": zero, "q": zero, "h": h, "t": t0}
        made = KernelRun(h_in_time, "p_next = t; q_next = q", start, steps, frozenset(), 0)
        found = made.run(arithmetic)
        assert found.done == steps
        off = abs(found.values["p"] - (t0 + (steps - 1) * h))
        latest = abs(t0) + steps * h
        # Adding the increment t − p to p rounds once more, by half a unit of each.
        adding = Fraction(1, 2**bits) * (0 if arithmetic.absolute else 3 * latest)
        assert off <= bound_time_error(arithmetic, latest) + adding
        # A clock that adds up what the format cuts off from h would be off by more than that.
        cut = abs(arithmetic.exact(arithmetic.number(h)) - h)
        if arithmetic.absolute:
            assert steps * cut > 2 * bound_time_error(arithmetic, latest)
