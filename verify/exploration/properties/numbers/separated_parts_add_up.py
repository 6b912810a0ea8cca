"""Truncation and the four kinds of rounding add up exactly to the Λ that float64 gives.

That Λ is, bit for bit, what the float64 kernel gives without the separation. The truncation part is
the Λ that balls enclose, and with the input part it is that at inputs rounded to float64.
"""

from collections.abc import Sequence
from fractions import Fraction

from verify.arithmetic.arb import Ball, around, shown
from verify.arithmetic.exact import decimal
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.ball_steps import BITS, ball_steps
from verify.exploration.property import Silent, Violation, only_if, silent_at
from verify.exploration.sample import Sample
from verify.schemes.step_map import StepMap
from verify.studies.separation.chain import PARTS, Chain, separated_chains
from verify.studies.separation.kernel import WORKING
from verify.studies.separation.working import Stopped

_IN = 2  # one in so many samples
_DIGITS = 8


def holds(sample: Sample) -> None:
    only_if(sample.is_turn(_IN) and sample.short)
    with silent_at(Stopped):
        chains = separated_chains(*sample.kernel_inputs, _DIGITS)
    exact, rounded = _lambda_by_balls(sample)
    for chain in (chains.plain, chains.closed_form):
        if chain is not None:
            _must_add_up(chain)
            (truncation, bound), (inputs, more) = (chain.final(n) for n in ("truncation", "input"))
            _must_reach("the truncation part is", truncation, bound, exact)
            both = truncation + inputs, bound + more
            _must_reach("truncation and input together are", *both, rounded)
    bare = sample.run("float64", 17, *WORKING).values["lambda_plain"]
    beside = chains.plain.final("lambda_working")[0]
    alone, other = float(bare), float(beside)  # the program's last subtraction, of 1, rounds
    if alone != other:
        raise Violation(f"float64 gives {alone!r}, and beside exact numbers {other!r}")


def _must_add_up(chain: Chain) -> None:
    parts = [chain.trail(name)[0] for name in ("truncation", *PARTS)]
    for k, whole in enumerate(chain.trail("lambda_working")[0]):
        if sum(part[k] for part in parts) != whole:
            raise Violation(f"the parts do not add up after {chain.marks[k]} steps")


def _lambda_by_balls(sample: Sample) -> tuple[Ball | None, Ball | None]:
    """Λ by balls, of the sample's numbers and of the nearest float64s."""
    start = sample.p, sample.q, sample.step_size
    exact = _area_error(sample, sample.step_map, start)
    rounded = tuple(map(_nearest, start))
    given = {name: _nearest(x) for name, x in sample.hamiltonian.values}
    if given == dict(sample.hamiltonian.values):
        of_it = sample.step_map
    else:
        of_it = sample.scheme.step_map(sample.hamiltonian.with_values(given))
    same = rounded == start and of_it is sample.step_map
    return exact, exact if same else _area_error(sample, of_it, rounded)


def _nearest(x: Fraction) -> Fraction:
    return Fraction(float(x))


def _area_error(sample: Sample, step_map: StepMap, start: Sequence[Fraction]) -> Ball | None:
    """Λ of the sample's steps; None where balls do not know it."""
    p, q, h = start
    try:
        last = ball_steps(step_map, p, q, h, sample.steps)[-1].sharp()
    except Silent:
        return None
    with working_precision(BITS):
        return last.product - 1


def _must_reach(what: str, value: Fraction, bound: Fraction, wanted: Ball | None) -> None:
    """Violation where a value does not lie within its bound of what balls enclose."""
    with working_precision(BITS):
        there = around(value, bound)
    if wanted is not None and not there.overlaps(wanted):
        given = f"{decimal(value, 12)} ± {decimal(bound, 3)}"
        raise Violation(f"{what} {given}, and truly {shown(wanted, 12)}")
