"""Passes of a surface by orbits, of a scheme in many digits or of the exact flow in long double.

The states of a scheme are z_0, z_1, …; if the surface lies between z_k and z_(k+1) = Φ_h(z_k) the
orbit is taken to pass it at Φ_θ(z_k), the scheme's own step of length θ ≤ h that ends on it. θ is
computed to all digits but three: nothing is interpolated. If an orbit crosses the surface and comes
back within one step, that is not seen.

Orbits of the exact flow are extrapolated in common steps (`verify.flows.extrapolation_of_many`),
which are long. A pass within a step is detected by a cubic through its ends, sampled at 33 points,
and then computed by Newton's iteration on the length of the step itself. If an orbit crosses the
surface and comes back between two of these points, that is not seen.
"""

import contextlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain, pairwise
from typing import Any

from verify.arithmetic.float_context import WIDE
from verify.arithmetic.systems import mpfr
from verify.flows.extrapolation import NoFlowError
from verify.flows.extrapolation_of_many import CommonSteps, slopes_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import kernel_for
from verify.kernels.stepping import KernelRun
from verify.lockstep import run_alone

State = Sequence[Any]  # the numbers of p1 … pn, q1 … qn
Array = Any  # numpy.ndarray, which is imported where it is used
# For a scheme:
_BLOCK = 1000  # steps that are done at once
_MAX_TRIES = 200  # values of θ; regula falsi with Illinois's halving takes some twelve
_SPARE_DIGITS = 3  # the last digits, to which θ is not computed
# For the exact flow:
_PARTS = 32  # parts of a step, at whose ends the cubic's sign is examined
_NEWTON_STEPS = 8
_HEIGHT_TOLERANCE = 1e-15  # relative to the greatest |coordinate|, or 1


@dataclass(frozen=True)
class Surface:
    """The surface `coordinate` = `value` among the coordinates `names`.

    Passes count at which the coordinate grows if `rising`, else those at which it falls.
    """

    names: tuple[str, ...]
    coordinate: str
    value: Fraction
    rising: bool

    @property
    def index(self) -> int:
        """The index of the coordinate among all."""
        return self.names.index(self.coordinate)

    def height(self, z: State, value: Any) -> Any:
        """Return z's signed distance from the surface, which grows at the passes that count.

        `value`: that of the surface, as a number of z's arithmetic.
        """
        distance = z[self.index] - value
        return distance if self.rising else -distance


@dataclass(frozen=True)
class Passes:
    """States of an orbit at its passes, in their order; `left`: it ended before its time."""

    states: Sequence[Mapping[str, Fraction]]
    left: bool = False


def count_agreeing(
    first: Sequence[Mapping[str, Fraction]],
    second: Sequence[Mapping[str, Fraction]],
    tolerance: Fraction,
) -> tuple[int, Fraction]:
    """Return how many states agree within `tolerance` up to the first that does not.

    With the number is returned their greatest difference.
    """
    largest = Fraction(0)
    for k, (x, y) in enumerate(zip(first, second, strict=False)):
        difference = max(abs(x[name] - y[name]) for name in x)
        if difference > tolerance:
            return k, largest
        largest = max(largest, difference)
    return min(len(first), len(second)), largest


class OutOfRangeError(Exception):
    """A step that leaves the domain of H."""


def find_passes_of_scheme(
    hamiltonian: Hamiltonian,
    scheme: str,
    start: Mapping[str, Fraction],
    surface: Surface,
    *,
    step_size: Fraction,
    steps: int,
    digits: int,
) -> Passes:
    """Find all passes within so many steps from the start, p1 … qn by names, with these digits."""
    scheme_steps = _SchemeSteps(hamiltonian, scheme, step_size, digits)
    arithmetic = scheme_steps.arithmetic
    z = [arithmetic.number(start[name]) for name in surface.names]
    value, states, done = arithmetic.number(surface.value), [], 0
    with arithmetic.context(), contextlib.suppress(OutOfRangeError):
        for before, after in pairwise(chain([z], scheme_steps.walk(z, steps))):
            done += 1
            # A state on the surface counts with the step that ends there, not with the next one.
            if surface.height(before, value) < 0 <= surface.height(after, value):
                state = scheme_steps.solve_on_surface(before, surface, value)
                states.append(
                    {n: arithmetic.exact(x) for n, x in zip(surface.names, state, strict=True)}
                )
    return Passes(states, left=done < steps)


class _SchemeSteps:
    """Steps of a scheme from any state, in mpfr, which has every range."""

    def __init__(self, hamiltonian: Hamiltonian, scheme: str, h: Fraction, digits: int) -> None:
        self.arithmetic, self.digits = mpfr.make(digits), digits
        start_values = {"h": h} | dict.fromkeys(hamiltonian.coordinates, Fraction(0))
        run = KernelRun(hamiltonian, scheme, start_values, 1, frozenset(), 0)
        self.kernel = kernel_for(run.hamiltonian, scheme, self.arithmetic, frozenset())
        self.inputs = [self.arithmetic.number(x) for x in run.inputs(self.kernel, 0).values()]

    def walk(self, z: State, steps: int) -> Iterator[State]:
        """Yield the states after 1, 2, … steps; fewer where one leaves the domain of H."""
        while steps > 0:
            count = min(_BLOCK, steps)
            states = run_alone(
                self.arithmetic.states(self.kernel.function, 1, count, self.inputs, tuple(z))
            )
            yield from states
            if len(states) < count:
                return
            z, steps = states[-1], steps - count

    def step_from(self, z: State, time: Any) -> State:
        """Return Φ_time(z). Raises OutOfRangeError."""
        arguments = [time, *self.inputs[1:]]
        states = run_alone(self.arithmetic.states(self.kernel.function, 1, 1, arguments, tuple(z)))
        if not states:
            raise OutOfRangeError
        return states[0]

    def solve_on_surface(self, z: State, surface: Surface, value: Any) -> State:
        """Return Φ_θ(z) on the surface, which lies between z and the end of its step."""
        low, high = self.arithmetic.number(Fraction(0)), self.inputs[0]
        near = high * self.arithmetic.number(Fraction(1, 10 ** (self.digits - _SPARE_DIGITS)))
        end = self.step_from(z, high)
        below, above = surface.height(z, value), surface.height(end, value)
        # The side, −1 or 1, of the end that was replaced last. If the same end is replaced twice,
        # the other end's height is halved (Illinois), lest that end stay for ever.
        last_side = 0
        for _ in range(_MAX_TRIES):
            time = high - above * (high - low) / (above - below)
            state = self.step_from(z, time)
            height = surface.height(state, value)
            if height < 0:
                low, below, above = time, height, above / 2 if last_side > 0 else above
                last_side = 1
            else:
                high, above, below, end = time, height, below / 2 if last_side < 0 else below, state
                last_side = -1
            if height == 0 or high - low <= near:
                return state
        return end


def long_double_digits() -> int:
    """Return the decimal digits of long double."""
    return int(WIDE.prec) * 3 // 10


def find_passes_of_exact_flow(
    hamiltonian: Hamiltonian,
    starts: Sequence[Mapping[str, Fraction]],
    surface: Surface,
    time: Fraction,
    columns: int,
) -> list[Passes]:
    """Find all passes of each orbit until the time, by so many columns of the extrapolation.

    The errors of two numbers of columns are taken to be independent. If one orbit cannot be
    followed to the end, each is followed alone.
    """
    import numpy as np

    z = np.array([[WIDE.rational(s[n]) for s in starts] for n in surface.names], dtype=WIDE.type)
    states_of: list[list[Mapping[str, Fraction]]] = [[] for _ in starts]
    with np.errstate(all="ignore"):
        walk = CommonSteps(slopes_of(hamiltonian), z, 1, columns, WIDE.mpf(0))
        watch = _StepWatch(walk, surface)
        try:
            for before, step in walk.steps_to(WIDE.rational(time)):
                for orbit, state in watch.find_passes(before, step):
                    states_of[orbit].append(state)
        except NoFlowError:
            if len(starts) == 1:
                return [Passes(states_of[0], left=True)]
            alone = (
                find_passes_of_exact_flow(hamiltonian, [s], surface, time, columns) for s in starts
            )
            return [passes for (passes,) in alone]
    return [Passes(states) for states in states_of]


class _StepWatch:
    """A search for passes in each step."""

    def __init__(self, walk: CommonSteps, surface: Surface) -> None:
        self.walk, self.surface = walk, surface
        self.value = WIDE.rational(surface.value)
        self.sign = 1 if surface.rising else -1

    def heights(self, z: Array) -> tuple[Array, Array]:
        """Return the heights of all points above the surface, and their rates of change."""
        import numpy as np

        index = self.surface.index
        slope = self.walk.slopes(*z, 0)[index]
        return self.surface.height(z, self.value), self.sign * (slope + np.zeros_like(z[index]))

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
        """Return the states on the surface, each after its own time near `time`.

        With the states is returned, for each of them, if Newton's iteration has converged.
        """
        import numpy as np

        for _ in range(_NEWTON_STEPS):
            z = before + self.walk.change_over(before, time)
            height, speed = self.heights(z)
            last, time = time, time - height / speed
            if np.array_equal(time, last):  # further iterations would change nothing
                break
        size = np.maximum(np.abs(z).max(axis=0), WIDE.mpf(1))
        # Newton's iteration may leave the step by rounding; beyond one part of it the pass belongs
        # to another step.
        room = step / _PARTS
        good = (
            (np.abs(height) <= _HEIGHT_TOLERANCE * size) & (time >= -room) & (time <= step + room)
        )
        return z, good

    def _state(self, z: Array) -> Mapping[str, Fraction]:
        rationals = (Fraction(*x.as_integer_ratio()) for x in z)
        return dict(zip(self.surface.names, rationals, strict=True))


def _cubic(s: Array, step: Any, f: Array, df: Array, g: Array, dg: Array) -> Array:
    """Evaluate Hermite's cubic on 0 ≤ s ≤ 1 by values and slopes at its ends."""
    away, gap = 1 - s, g - f
    bend = s * away * (away * (df * step - gap) + s * (gap - dg * step))
    return away * f + s * g + bend
