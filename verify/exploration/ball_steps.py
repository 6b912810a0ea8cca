"""Steps of a map in ball arithmetic, term by term from the ring's own elements.

No kernel is written for them: an oracle for the number systems that shares no code with those, and
rigorous. ΔJ is taken from the four entries of J, not from its closed form.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import flint

from verify.algebra.enclosure import enclose_all
from verify.arithmetic.arb import Ball, rational_ball, shown
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.property import known, only_if
from verify.schemes.step_map import StepMap

BITS = 320
_SHARP = 120  # bits that a ball must know to be worth comparing


@dataclass(frozen=True)
class BallState:
    """After so many steps: p, q, Π det J_k over the steps done, and t where H depends on it."""

    p: Ball
    q: Ball
    product: Ball
    t: Ball | None = None

    @property
    def point(self) -> dict[str, Ball]:
        """p and q, and t, by name."""
        found = {"p": self.p, "q": self.q}
        return found if self.t is None else found | {"t": self.t}

    def sharp(self) -> "BallState":
        """The same; Silent where one of the three is too wide to tell numbers apart."""
        only_if(all(map(sharp, (self.p, self.q, self.product))))
        return self


def ball_steps(
    step_map: StepMap, start: Mapping[str, Fraction], steps: int, bits: int = BITS
) -> Sequence[BallState]:
    """The states after 0, 1, … steps; Silent where the map solves equations, or is not defined.

    `start`: p, q, h, which may be negative, and t where H depends on it.
    """
    only_if(not step_map.implicit)
    with working_precision(bits):
        first = {name: rational_ball(x) for name, x in start.items()}
        size = first.pop("h")
        states = [BallState(**first, product=flint.arb(1))]
        for _ in range(steps):
            states.append(stepped(step_map, states[-1], size))
    return states


def stepped(step_map: StepMap, state: BallState, h: Ball) -> BallState:
    """One step from a state, in flint's present precision; Silent where it is not defined."""
    box, product = state.point | {"h": h}, state.product
    for step in step_map.substeps:
        wanted = step.p_next, step.q_next, *step.jacobian
        found = known(enclose_all(step.ring, wanted, box))
        only_if(all(x.is_finite() for x in found))
        box["p"], box["q"], a, b, c, d = found
        product = product * (a * d - b * c)
    after = None if state.t is None else state.t + h
    return BallState(box["p"], box["q"], product, after)


def unlike(found: Ball, wanted: Ball) -> str:
    """`found` and what it should be, with their difference, which 12 digits may not show."""
    with working_precision(BITS):
        difference = found - wanted
    given = f"{shown(found, 12)}, and should be {shown(wanted, 12)}"
    return f"{given} (too large by {shown(difference, 3)})"


def sharp(x: Ball) -> bool:
    """Whether a ball is narrow: relative to numbers beyond 1, and absolute below."""
    return bool(x.is_finite()) and x.rad() * 2**_SHARP < 1 + x.abs_lower()
