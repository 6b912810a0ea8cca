"""Passes of a surface by orbits of the exact flow, all of them together, in long double.

They take common steps by an extrapolation (`verify.flows.extrapolation_of_many`), which are long. A
pass within a step is detected by a cubic through its ends, sampled in parts, and then found by
Newton's iteration on the length of the step itself. A pass that lasts less than a part is missed.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from verify.arithmetic.float_context import WIDE
from verify.flows.extrapolation import NoFlowError
from verify.flows.extrapolation_of_many import CommonSteps, slopes_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.studies.orbits.passes import Passes, Surface

Array = Any  # numpy.ndarray, which is imported where it is used
_PARTS = 32  # of a step, in which a change of side is looked for
_TRIES = 8  # of Newton's iteration, which begins at a cubic's root
_CLOSE = 1e-15  # to the surface, relative to the orbit so far


def digits() -> int:
    """Return the decimal digits of long double."""
    return int(WIDE.prec) * 3 // 10


def find_all_passes(
    hamiltonian: Hamiltonian,
    starts: Sequence[Mapping[str, Fraction]],
    surface: Surface,
    time: Fraction,
    columns: int,
) -> list[Passes]:
    """Find all passes of each orbit until the time, by so many columns of the extrapolation.

    Two different numbers of columns have independent errors. An orbit that cannot be followed to
    the end ends the common steps; then each is followed alone.
    """
    import numpy as np

    z = np.array([[WIDE.rational(s[n]) for s in starts] for n in surface.names], dtype=WIDE.type)
    states_of: list[list[Mapping[str, Fraction]]] = [[] for _ in starts]
    with np.errstate(all="ignore"):
        walk = CommonSteps(slopes_of(hamiltonian), z, 1, columns, WIDE.mpf(0))
        watch = _Watch(walk, surface)
        try:
            for before, step in walk.steps_to(WIDE.rational(time)):
                for orbit, state in watch.find_passes(before, step):
                    states_of[orbit].append(state)
        except NoFlowError:
            if len(starts) == 1:
                return [Passes(states_of[0], left=True)]
            alone = (find_all_passes(hamiltonian, [s], surface, time, columns) for s in starts)
            return [passes for (passes,) in alone]
    return [Passes(states) for states in states_of]


class _Watch:
    """A search for passes in each step."""

    def __init__(self, walk: CommonSteps, surface: Surface) -> None:
        self.walk, self.surface = walk, surface
        self.value = WIDE.rational(surface.value)
        self.sign = 1 if surface.rising else -1

    def heights(self, z: Array) -> tuple[Array, Array]:
        """Return the heights of all points above the surface, and their rates of change."""
        import numpy as np

        place = self.surface.place
        slope = self.walk.slopes(*z, 0)[place]
        return self.surface.height(z, self.value), self.sign * (slope + np.zeros_like(z[place]))

    def find_passes(self, before: Array, step: Any) -> list[tuple[int, Mapping[str, Fraction]]]:
        """Return each pass in the step from `before`: the orbit, and the state on the surface."""
        import numpy as np

        part = np.arange(_PARTS + 1, dtype=WIDE.type)[:, None] / _PARTS
        ends = (*self.heights(before), *self.heights(self.walk.z))
        cubic = _cubic(part, step, *ends)
        cubic[0], cubic[-1] = ends[0], ends[2]  # neighbouring steps agree on the side
        parts, orbits = np.nonzero((cubic[:-1] < 0) & (cubic[1:] >= 0))
        if not len(orbits):
            return []
        low, high = cubic[parts, orbits], cubic[parts + 1, orbits]
        # The cubic's crossing by linear interpolation: the start of Newton's iteration.
        first = (part[parts, 0] - low / (high - low) / _PARTS) * step
        z, good = self.solve_on_surface(before[:, orbits], first, step)
        order = np.lexsort((parts, orbits))
        return [(int(orbits[k]), self._state(z[:, k])) for k in order if good[k]]

    def solve_on_surface(self, before: Array, time: Array, step: Any) -> tuple[Array, Array]:
        """Return the points on the surface, each after its own time near `time`.

        With them is returned which of them Newton's iteration has brought there.
        """
        import numpy as np

        for _ in range(_TRIES):
            z = before + self.walk.change_over(before, time)
            height, speed = self.heights(z)
            last, time = time, time - height / speed
            if np.array_equal(time, last):  # the other tries would give the same
                break
        size = np.maximum(np.abs(z).max(axis=0), WIDE.mpf(1))
        # Newton's iteration may leave the step by a rounding or more; beyond one part the pass
        # belongs to another step.
        room = step / _PARTS
        good = (np.abs(height) <= _CLOSE * size) & (time >= -room) & (time <= step + room)
        return z, good

    def _state(self, z: Array) -> Mapping[str, Fraction]:
        exact = (Fraction(*x.as_integer_ratio()) for x in z)
        return dict(zip(self.surface.names, exact, strict=True))


def _cubic(s: Array, step: Any, f: Array, df: Array, g: Array, dg: Array) -> Array:
    """Evaluate Hermite's cubic on 0 ≤ s ≤ 1 by values and slopes at its ends."""
    away, gap = 1 - s, g - f
    bend = s * away * (away * (df * step - gap) + s * (gap - dg * step))
    return away * f + s * g + bend
