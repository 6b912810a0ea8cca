"""Truncation and the kinds of rounding add up exactly to the Λ that float64 gives.

This Λ is, bit for bit, that of the float64 kernel without the separation. If H depends on time,
this holds only if the clock t ← t + h of the separation rounds nothing, as the kernel's is
t₀ + k h. The truncation part is the Λ that balls enclose; together with the input part it is Λ at
inputs rounded to float64, and with the clock part Λ at the times of float64's own clock.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from verify.arithmetic.arb import Ball, format_ball, make_ball, rational_ball
from verify.arithmetic.exact import decimal
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.property import Silent, Violation, only_if, silent_at
from verify.exploration.reference_steps import BITS, ball_steps, take_step
from verify.exploration.sample import Sample
from verify.lockstep import run_alone
from verify.studies.separation.chain import Chain
from verify.studies.separation.determinants import WORKING
from verify.studies.separation.links import separate_chains
from verify.studies.separation.mixed_run import Stopped

_DIGITS = 8


def holds(sample: Sample) -> None:
    only_if(sample.is_turn(one_in=2) and sample.short)
    with silent_at(Stopped):
        chains = run_alone(separate_chains(*sample.kernel_inputs, _DIGITS))
    expected = _lambda_by_balls(sample)
    for chain in (*chains.plain, *(chains.closed_form or ())):
        _must_add_up(chain)
        # `true` is Λ of the sample's numbers, of their float64 neighbours, and by float64's clock:
        # each includes one more part.
        for count, true in enumerate(expected, start=1):
            _must_reach(chain, ("truncation", *chain.parts)[:count], true)
    if sample.depends_on_time and not _clock_is_exact(sample):
        return
    bare = sample.run("float64", 17, *WORKING).values["lambda_plain"]
    working_value = chains.plain[0].final("lambda_working")[0]
    # The program's last subtraction, of 1, rounds.
    alone, beside = float(bare), float(working_value)
    if alone != beside:
        raise Violation(f"float64 gives {alone!r}, and beside exact numbers {beside!r}")


def _must_add_up(chain: Chain) -> None:
    parts = [chain.trail(name)[0] for name in ("truncation", *chain.parts)]
    for k, whole in enumerate(chain.trail("lambda_working")[0]):
        if sum(part[k] for part in parts) != whole:
            raise Violation(f"the parts do not add up after {chain.marks[k]} steps")


def _lambda_by_balls(sample: Sample) -> list[Ball | None]:
    """Return Λ by balls, for the sample's numbers, for the nearest float64s, and for these with
    float64's own clock, if H depends on time."""
    hamiltonian, values = sample.hamiltonian, dict(sample.hamiltonian.values)
    nearest = {name: _nearest(x) for name, x in values.items()}
    rounded_sample = replace(
        sample,
        hamiltonian=hamiltonian if nearest == values else hamiltonian.with_values(nearest),
        step_size=_nearest(sample.step_size),
        t0=_nearest(sample.t0),
        place=tuple(map(_nearest, sample.place)),
    )
    errors = [_area_error(sample), _area_error(rounded_sample)]
    return [*errors, _lambda_by_float_clock(rounded_sample)] if sample.depends_on_time else errors


def _lambda_by_float_clock(sample: Sample) -> Ball | None:
    """Return Λ with each step taken at the time of t ← t + h in float64."""
    t, h = float(sample.t0), float(sample.step_size)
    try:
        state = ball_steps(sample.step_map, sample.start, 0)[0]
        with working_precision(BITS):
            for _ in range(sample.steps):
                clocked_state = replace(
                    state, point={**state.point, "t": rational_ball(Fraction(t))}
                )
                state, t = (
                    take_step(sample.step_map, clocked_state, rational_ball(sample.step_size)),
                    t + h,
                )
            return state.sharp().product - 1
    except Silent:
        return None


def _clock_is_exact(sample: Sample) -> bool:
    t, h = _nearest(sample.t0), _nearest(sample.step_size)
    elapsed_times = [k * h for k in range(sample.steps)]
    return all(_nearest(x) == x for x in (*elapsed_times, *(t + x for x in elapsed_times)))


def _nearest(x: Fraction) -> Fraction:
    return Fraction(float(x))


def _area_error(sample: Sample) -> Ball | None:
    """Return Λ of the sample's steps; None if its ball is not sharp."""
    try:
        last = ball_steps(sample.step_map, sample.start, sample.steps)[-1].sharp()
    except Silent:
        return None
    with working_precision(BITS):
        return last.product - 1


def _must_reach(chain: Chain, names: Sequence[str], expected: Ball | None) -> None:
    """Raise Violation if the sum of the parts, within its bounds, misses the enclosure."""
    finals = [chain.final(name) for name in names]
    value, bound = (sum(x, Fraction()) for x in zip(*finals, strict=True))
    with working_precision(BITS):
        enclosure = make_ball(value, bound)
    if expected is not None and not enclosure.overlaps(expected):
        message = f"{decimal(value, 12)} ± {decimal(bound, 3)}"
        raise Violation(f"{' + '.join(names)} is {message}, and truly {format_ball(expected, 12)}")
