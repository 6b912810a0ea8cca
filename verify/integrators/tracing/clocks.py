"""Which mistake the clock of a traced step looks like.

With t held still at a moment s of the step, H(p, q, s) is autonomous. A step that reads its force
at one moment is a scheme for that H of an order that it may not have for the motion in time.
"""

from collections.abc import Sequence
from fractions import Fraction

from verify.algebra.formula import symbol
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.tracing.misread import misread
from verify.integrators.tracing.trace import Node, written
from verify.proof.order import convergence_of
from verify.schemes.step_map import StepMap

_MOST_WRITTEN = 3000  # operations of p' and q' as trees
MOMENTS = {"t": Fraction(0), "t + h": Fraction(1), "t + h/2": Fraction(1, 2)}  # as parts of h
_STILL = symbol("still")


def clock_mistakes(hamiltonian: Hamiltonian, roots: Sequence[Node], order: int | None) -> list[str]:
    """One sentence, where the step of these p' and q' has a higher order than `order` with the
    force held still, or with H read at other times."""
    if order is None or not hamiltonian.time_dependent or "still" in hamiltonian.parameters:
        return []
    p_next, q_next = roots
    still = _still(hamiltonian, p_next, q_next, order)
    return still or misread(hamiltonian, p_next, q_next, order)


def _still(hamiltonian: Hamiltonian, p_next: Node, q_next: Node, order: int) -> list[str]:
    t, h = symbol("t"), symbol("h")
    still = Hamiltonian(hamiltonian.exact.subs(t, _STILL))
    for words, part in MOMENTS.items():
        made = written((p_next, q_next), _MOST_WRITTEN, {"t": _STILL - part * h})
        if made is None:
            return []
        try:
            step = StepMap.from_expressions(still, *made)
            found = convergence_of(step).order
        except InputError:  # too long, or not smooth
            continue
        if found is None or found > order:
            return [stands_still("exact" if found is None else f"of order {found}", words)]
    return []


def stands_still(reached: str, words: str) -> str:
    """What is said of such a clock: `reached` is what the step then is, `words` the moment."""
    return (
        f"it is {reached} as if the force were read at {words} in every stage: its clock stands "
        "still"
    )
