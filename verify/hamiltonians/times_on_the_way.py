"""Smoothness of H at all times of a run, as far as that depends on the time alone.

A step may pass over a pole in t and never see it. So the conditions that have no p and q in them
are enclosed over the time of the run, which is halved where the enclosure does not decide, down to
parts of a step.
"""

from fractions import Fraction

import flint

from verify.algebra.domain import holds
from verify.algebra.embedding import embed
from verify.algebra.enclosure import enclose_over
from verify.algebra.requirement import Relation
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.arb import rational_ball
from verify.arithmetic.exact import text
from verify.arithmetic.flint_precision import working_precision
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian

_BITS = 96
_MOST = 20_000  # enclosures, beyond which it is left to the run
_PARTS = 64  # of a step


def check_times(hamiltonian: Hamiltonian, t0: Fraction, step_size: Fraction, steps: int) -> None:
    """Raise InputError, which names the step, where H is not smooth at some time on the way.

    >>> opened = Hamiltonian.parse("p**2/2 + q**2/(1 - t)")
    >>> check_times(opened, Fraction(0), Fraction(2), 9)
    Traceback (most recent call last):
    verify.errors.InputError: t0=0: at step 1, t = 0 … 2, H is not smooth; it is where t - 1 ≠ 0
    """
    step, words = find_first_fault(hamiltonian, t0, step_size, steps)
    if words:
        begin = t0 + step * step_size
        between = f"t = {text(begin)} … {text(begin + step_size)}"
        problem = f"at step {step + 1}, {between}, H is not smooth; it is where {words}"
        raise InputError("t0", text(t0), problem)


def find_first_fault(
    hamiltonian: Hamiltonian, t0: Fraction, step_size: Fraction, steps: int
) -> tuple[int, str]:
    """Return the first step in whose time H may not be smooth, and the condition that fails.

    0 and "" where there is none. `step_size` may be negative.
    """
    if not hamiltonian.time_dependent:
        return 0, ""
    domain = hamiltonian.domain
    for requirement, words in zip(domain.requirements, domain.requirement_signs, strict=True):
        if {s.name for s in requirement.expression.free_symbols} == {"t"}:
            ring, (x,) = embed([requirement.expression], ("t",))
            search = _Search(ring, x, requirement.relation, t0, step_size)
            step = search.first(0, steps * _PARTS)
            if step is not None:
                return step, words
    return 0, ""


class _Search:
    """The search for the first step in whose time the condition may fail."""

    def __init__(
        self, ring: Ring, x: Poly, relation: Relation, t0: Fraction, step_size: Fraction
    ) -> None:
        self.ring, self.x, self.relation = ring, x, relation
        self.t0, self.part = t0, step_size / _PARTS
        self.budget = _MOST

    def first(self, low: int, high: int) -> int | None:
        """Return the first step among these parts of steps; None where the condition holds in
        all."""
        if self.budget <= 0 or self._holds(low, high):
            return None
        if high - low == 1:
            return low // _PARTS
        middle = (low + high) // 2
        first_half = self.first(low, middle)
        return self.first(middle, high) if first_half is None else first_half

    def _holds(self, low: int, high: int) -> bool:
        """Return True if the condition holds over the whole interval."""
        self.budget -= 1
        with working_precision(_BITS):
            ends = (rational_ball(self.t0 + n * self.part) for n in (low, high))
            # The condition is enclosed over the whole interval of time at once, so no pole is
            # missed.
            over = next(ends).union(next(ends))
            enclosure: flint.arb | None = enclose_over(self.ring, self.x, {"t": over})
            return holds(enclosure, self.relation) is True
