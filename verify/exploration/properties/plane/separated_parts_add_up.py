"""Truncation and the kinds of rounding add up exactly to the Λ that float64 gives.

That Λ is, bit for bit, what the float64 kernel gives without the separation; of an H in time where
float64's own clock, t ← t + h, rounds nothing, as the kernel's is t₀ + k h. The truncation part is
the Λ that balls enclose, with the input part it is that at inputs rounded to float64, and with the
clock part that at the times of float64's own clock.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from verify.arithmetic.arb import Ball, around, rational_ball, shown
from verify.arithmetic.exact import decimal
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.oracles.ball_steps import BITS, ball_steps, stepped
from verify.exploration.property import Silent, Violation, only_if, silent_at
from verify.exploration.sample import Sample
from verify.lockstep import alone
from verify.studies.separation.chain import Chain
from verify.studies.separation.links import separated_chains
from verify.studies.separation.stepper.run import Stopped
from verify.studies.separation.ways.determinants import WORKING

_DIGITS = 8


def holds(sample: Sample) -> None:
    only_if(sample.is_turn(one_in=2) and sample.short)
    with silent_at(Stopped):
        chains = alone(separated_chains(*sample.kernel_inputs, _DIGITS))
    wanted = _lambda_by_balls(sample)
    for chain in (*chains.plain, *(chains.closed_form or ())):
        _must_add_up(chain)
        for count, true in enumerate(wanted, start=1):
            _must_reach(chain, ("truncation", *chain.parts)[:count], true)
    if sample.timed and not _clock_is_exact(sample):
        return
    bare = sample.run("float64", 17, *WORKING).values["lambda_plain"]
    beside = chains.plain[0].final("lambda_working")[0]
    one, other = float(bare), float(beside)  # the program's last subtraction, of 1, rounds
    if one != other:
        raise Violation(f"float64 gives {one!r}, and beside exact numbers {other!r}")


def _must_add_up(chain: Chain) -> None:
    parts = [chain.trail(name)[0] for name in ("truncation", *chain.parts)]
    for k, whole in enumerate(chain.trail("lambda_working")[0]):
        if sum(part[k] for part in parts) != whole:
            raise Violation(f"the parts do not add up after {chain.marks[k]} steps")


def _lambda_by_balls(sample: Sample) -> list[Ball | None]:
    """Λ by balls, of the sample's numbers, of the nearest float64s, and of these with float64's own
    clock, where H depends on time."""
    exact, values = sample.hamiltonian, dict(sample.hamiltonian.values)
    nearest = {name: _nearest(x) for name, x in values.items()}
    rounded = replace(
        sample,
        hamiltonian=exact if nearest == values else exact.with_values(nearest),
        step_size=_nearest(sample.step_size),
        t0=_nearest(sample.t0),
        place=tuple(map(_nearest, sample.place)),
    )
    errors = [_area_error(sample), _area_error(rounded)]
    return [*errors, _by_own_clock(rounded)] if sample.timed else errors


def _by_own_clock(sample: Sample) -> Ball | None:
    """Λ where each step is made at the time of t ← t + h in float64."""
    t, h = float(sample.t0), float(sample.step_size)
    try:
        state = ball_steps(sample.step_map, sample.start, 0)[0]
        with working_precision(BITS):
            for _ in range(sample.steps):
                at = replace(state, point={**state.point, "t": rational_ball(Fraction(t))})
                state, t = stepped(sample.step_map, at, rational_ball(sample.step_size)), t + h
            return state.sharp().product - 1
    except Silent:
        return None


def _clock_is_exact(sample: Sample) -> bool:
    t, h = _nearest(sample.t0), _nearest(sample.step_size)
    passed = [k * h for k in range(sample.steps)]
    return all(_nearest(x) == x for x in (*passed, *(t + x for x in passed)))


def _nearest(x: Fraction) -> Fraction:
    return Fraction(float(x))


def _area_error(sample: Sample) -> Ball | None:
    """Λ of the sample's steps; None where balls do not know it."""
    try:
        last = ball_steps(sample.step_map, sample.start, sample.steps)[-1].sharp()
    except Silent:
        return None
    with working_precision(BITS):
        return last.product - 1


def _must_reach(chain: Chain, names: Sequence[str], wanted: Ball | None) -> None:
    """Violation where these parts together do not lie within their bounds of what balls enclose."""
    finals = [chain.final(name) for name in names]
    value, bound = (sum(x, Fraction()) for x in zip(*finals, strict=True))
    with working_precision(BITS):
        there = around(value, bound)
    if wanted is not None and not there.overlaps(wanted):
        given = f"{decimal(value, 12)} ± {decimal(bound, 3)}"
        raise Violation(f"{' + '.join(names)} is {given}, and truly {shown(wanted, 12)}")
