"""The way back in the code's own numbers: a step, the state turned or h negative, the same step.

In exact arithmetic a reversible step leads back to where it began. In floats it may do so bit for
bit, or lose some units of the last place of the state.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial

from verify.arithmetic.exact import fraction
from verify.integrators.measures.measured_values import evaluate
from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.places.wrap_periods import Periods, unwrap
from verify.integrators.user_code.step import unless_it_fails
from verify.integrators.user_code.user_map import UserMap
from verify.prose import Prose, read_prose
from verify.structures.reversible import Reversible
from verify.structures.symmetric import Symmetric

_MOST_PLACES = 6
_STEP_DIVISOR = 8  # of a place's largest step


@dataclass(frozen=True)
class WayBack:
    """The loss on the way back, at most, in units of the last place of the state.

    `count`: the number of places. `ignores_sign`: True if steps of −h are those of h everywhere.
    """

    units: float
    count: int
    ignores_sign: bool = False

    @property
    def text(self) -> Prose:
        """The sentence on it."""
        places = f"at {self.count} place" + ("s" if self.count != 1 else "")
        if not self.units:
            return read_prose(f"in its own numbers it leads back bit for bit, {places}")
        size = f"{self.units:.2g}" if self.units < 100 else f"`{self.units:.1e}`"
        return read_prose(
            f"in its own numbers the way back loses up to {size} units of the last place, {places}"
        )


def go_back(
    step: UserMap,
    structure: Reversible | Symmetric,
    places: Sequence[TrialPlace],
    periods: Periods = (),
) -> WayBack | None:
    """Go forth and back at a few places; None if the code fails at all of them."""
    losses, signs = list[float](), list[bool]()
    for place in places[:_MOST_PLACES]:
        loss = unless_it_fails(partial(_lose, step, structure, place, periods))
        if loss is not None:
            losses.append(loss[0])
            signs.append(loss[1])
    return WayBack(max(losses), len(losses), all(signs)) if losses else None


def _lose(
    step: UserMap, structure: Reversible | Symmetric, place: TrialPlace, periods: Periods
) -> tuple[float, bool]:
    """Return the loss at one place, and True if a step of −h moves the state as that of h does."""
    nearest, t = step.numbers.round_number, place.t
    h, turned = nearest(place.step / _STEP_DIVISOR), isinstance(structure, Reversible)
    z = list(place.with_rounded_state(nearest).z)
    (end,) = step.exactly([z], h, t)
    later = t + h if step.time_dependent else t
    reflection = structure.reflection if isinstance(structure, Reversible) else ()

    def turn(state: Sequence[Fraction]) -> list[Fraction]:
        if not reflection:
            return list(state)
        zeros = [0.0] * len(state)
        images = (evaluate(x, step.names, state, t, h, zeros)[0] for x in reflection)
        return [nearest(fraction(x)) for x in images]

    (back,) = step.exactly([turn(end)], h if turned else -h, later)
    back = turn(back)
    if periods:
        back = list(map(unwrap, back, z, periods))
    bits = step.numbers.bits
    units = [math.ldexp(1.0, math.frexp(float(max(abs(x), abs(y))))[1] - bits)
             for x, y in zip(z, end, strict=True)]  # fmt: skip
    loss = max(float(abs(x - y)) / u for x, y, u in zip(z, back, units, strict=True))
    ignores = not turned and end != z and step.exactly([z], -h, t)[0] == end
    return loss, ignores
