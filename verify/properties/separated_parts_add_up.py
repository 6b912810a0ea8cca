"""Truncation and the four kinds of rounding add up exactly to the Λ that float64 gives.

That Λ is, bit for bit, what the float64 kernel gives without the separation; and the truncation
part is the Λ that balls enclose.
"""

from verify import arithmetic as number_systems
from verify.ball_steps import BITS, ball_steps
from verify.balls import around, shown
from verify.exact import decimal
from verify.example import Example
from verify.precision import working_precision
from verify.property import Violation
from verify.separation_chain import PARTS, Chain, Separation
from verify.separation_kernel import WORKING
from verify.separation_working import Stopped
from verify.stepping import Job

_DIGITS = 8


def holds(example: Example) -> bool:
    if not example.short:
        return False
    given = example.hamiltonian, example.scheme.name, example.start, example.steps
    try:
        chains = Separation(*given).chains(_DIGITS)
    except Stopped:
        return False
    for chain in (chains.plain, chains.closed_form):
        if chain is not None:
            _must_add_up(chain)
            _must_be_true(example, chain)
    job = Job(*given, WORKING, 0)
    bare = job.go(number_systems.get("float64", 17)).values["lambda_plain"]
    beside = chains.plain.final("lambda_working")[0]
    alone, other = float(bare), float(beside)  # the program's last subtraction, of 1, rounds
    if alone != other:
        raise Violation(f"float64 gives {alone!r}, and beside exact numbers {other!r}")
    return True


def _must_add_up(chain: Chain) -> None:
    parts = [chain.trail(name)[0] for name in ("truncation", *PARTS)]
    for k, whole in enumerate(chain.trail("lambda_working")[0]):
        if sum(part[k] for part in parts) != whole:
            raise Violation(f"the parts do not add up after {chain.marks[k]} steps")


def _must_be_true(example: Example, chain: Chain) -> None:
    """The truncation part against balls, where those can be had."""
    start = example.p, example.q, example.step_size
    states = ball_steps(example.step_map, *start, example.steps)
    if states is None:
        return
    with working_precision(BITS):
        wanted = states[-1].product - 1
        value, bound = chain.final("truncation")
        found_there = around(value, bound)
    if not found_there.overlaps(wanted):
        found = f"{decimal(value, 12)} ± {decimal(bound, 3)}"
        raise Violation(f"the truncation part is {found}, and truly {shown(wanted, 12)}")
