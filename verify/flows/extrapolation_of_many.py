"""The numerical flow of many points at once, in arrays of floats: Gragg's method, extrapolated.

`verify.flows.extrapolation` follows one point with any number of digits. Here all points take the
same steps, whose length the least accurate point decides. The arrays are of the C compiler's long
double, which is not much slower here; in float64 the error grows with the time to 10⁻¹⁰ and more.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import nullcontext
from dataclasses import replace
from fractions import Fraction
from typing import Any

from verify.arithmetic.float_context import WIDE
from verify.arithmetic.number_system import Arithmetic, interpret
from verify.arithmetic.systems import float64
from verify.flows.compiled_functions import functions_at
from verify.flows.extrapolation import LOST, NoFlowError
from verify.functions import in_rings
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian

Array = Any  # numpy.ndarray, which is imported where it is used
Slopes = Callable[..., tuple[Array, ...]]  # takes the coordinates and t
_ZERO = Fraction(0)

# The largest difference of the last two extrapolated values, in roundings of the orbit so far.
_TOLERANCE_IN_ROUNDINGS = 4096
_GROWTH_THRESHOLD = 1e-2  # a step with an error below this part of the tolerance is made longer
_GROWTH_FACTOR, _CUT_FACTOR = 1.25, 0.7
_SHORTEST_PART = 2.0**-60  # the shortest step allowed, in parts of the first
_MOST_STEPS = 100_000
_STEP_BITS = 12  # bits of a step's mantissa: so few that times are sums without rounding


def follow(
    hamiltonian: Hamiltonian,
    points: Sequence[Array] | Array,
    times: Sequence[Fraction],
    columns: int,
    t0: Fraction = _ZERO,
) -> Array:
    """Return φ_t of all points, p and q or p1 … qn: an array (coordinate, time, point).

    Times may have either sign; where H depends on time they are counted from t0.

    `columns`: the number of columns of the extrapolation; results of two different numbers have
    different errors. Raises NoFlowError, naming a point, if one cannot be followed.
    """
    import numpy as np

    start = np.array(points, dtype=WIDE.type)
    states = np.empty((len(start), len(times), start.shape[1]))
    with np.errstate(all="ignore"):
        slopes = slopes_of(hamiltonian)
        for sign in (1, -1):
            walk = CommonSteps(slopes, start, sign, columns, WIDE.rational(t0))
            order = sorted((t for t in set(times) if sign * t > 0 or t == 0), key=abs)
            for time in order:
                walk.advance_to(WIDE.rational(abs(time)))
                for k in (k for k, t in enumerate(times) if t == time):
                    states[:, k] = walk.z
    return states


def slopes_of(hamiltonian: Hamiltonian) -> Slopes:
    """Return f as a function of the coordinates and t; without time in H it ignores t."""
    field, _ = canonical_field(hamiltonian)
    elements = [(field.ring, x) for x in field.slopes]
    names = hamiltonian.coordinates
    if hamiltonian.time_dependent:
        return functions_at(arrays(), elements, (*names, "t"))
    still = functions_at(arrays(), elements, names)
    return lambda *z: still(*z[:-1])


def arrays() -> Arithmetic:
    """Return the arithmetic of arrays of long doubles."""
    import numpy as np

    def root(x: Array, n: int) -> Array:
        y = np.power(x, 1 / n)
        # One step of Newton's method corrects the rounding of 1/n in the exponent.
        return y - np.where(y > 0, (y**n - x) / (n * y ** (n - 1)), 0.0)

    functions = {
        **{name: getattr(np, f.numpy) for name, f in in_rings().items()},
        "sqrt": np.sqrt,
        "root": root,
        "pi": WIDE.pi,
    }
    return replace(
        float64.make(17), name="arrays", bits=WIDE.prec, number=WIDE.rational,
        functions=functions, compile=interpret, context=nullcontext,
    )  # fmt: skip


def _short(step: float) -> float:
    """Round a step down to `_STEP_BITS` bits, so that sums of steps are exact."""
    mantissa, exponent = math.frexp(step)
    return math.ldexp(math.floor(math.ldexp(mantissa, _STEP_BITS)), exponent - _STEP_BITS)


class CommonSteps:
    """A walk of all points along their orbits, by steps common to all."""

    def __init__(self, slopes: Slopes, start: Array, sign: int, columns: int, t0: Any) -> None:
        import numpy as np

        self.z, self._t0 = start, t0
        self.slopes = slopes
        self._sign = sign
        self._columns = columns
        self._done = WIDE.mpf(0)
        self._tolerance = _TOLERANCE_IN_ROUNDINGS * float(WIDE.eps)
        self._scale = np.max(np.abs(start), axis=0)  # the largest |coordinate| of each orbit so far
        start_slopes = np.broadcast_arrays(*slopes(*start, t0), start[0])[:-1]
        speed = np.max(abs(np.array(start_slopes)), axis=0)
        # A point at 0 has no scale of its own; 1 stands for it.
        size = np.where(self._scale > 0, self._scale, 1.0)
        fastest = float(np.max(speed / size, initial=0.0))
        self._step = _short(1.0 / (1.0 + fastest)) if np.isfinite(fastest) else 1.0
        self._least = self._step * _SHORTEST_PART

    def advance_to(self, goal: Any) -> None:
        """Advance all points to this time since the start. Raises NoFlowError."""
        for _ in self.steps_to(goal):
            pass

    def steps_to(self, goal: Any) -> Iterator[tuple[Array, Any]]:
        """Take steps up to this time; yield after each the points before it, and its length."""
        import numpy as np

        for _ in range(_MOST_STEPS):
            if self._done >= goal:
                return
            last = self._done + self._step >= goal
            step = goal - self._done if last else self._step
            change, error = self._extrapolate(self.z, self._sign * step)
            # An orbit's scale never falls, so that one that passes 0 does not stall.
            size = np.maximum(self._scale, np.max(np.abs(self.z + change), axis=0))
            ratio = error / np.where(size > 0, size, 1.0)
            worst = float(ratio.max(initial=0.0))
            if worst <= self._tolerance:
                before, self.z, self._scale = self.z, self.z + change, size
                self._done = goal if last else self._done + step
                yield before, step
                if worst <= _GROWTH_THRESHOLD * self._tolerance and not last:
                    self._step = _short(self._step * _GROWTH_FACTOR)
                continue
            self._step = _short(float(step) * _CUT_FACTOR)
            if self._step < self._least or self._done + self._step == self._done:
                raise NoFlowError(self._describe_failure(ratio))
        raise NoFlowError(f"{_MOST_STEPS} steps lead only to t = `{self._sign * self._done:.6g}`")

    def _describe_failure(self, ratio: Array) -> str:
        import numpy as np

        i = int(np.argmax(np.where(np.isfinite(ratio), ratio, np.inf)))
        return f"point {i}: {LOST}, at about t = `{self._sign * self._done:.6g}`"

    def change_over(self, z: Array, time: Array) -> Array:
        """Return by how much points change in one step, each with its own time.

        No time may be longer than an accurate step, and H must not depend on time.
        """
        return self._extrapolate(z, time)[0]

    def _extrapolate(self, z: Array, time: Any) -> tuple[Array, Array]:
        """Return the change of the points by the Aitken–Neville scheme, and its estimated error."""
        import numpy as np

        t = self._t0 + self._sign * self._done
        first = np.empty_like(z)  # the slopes at z, with which every rule below begins
        _fill(first, self.slopes(*z, t))
        above: list[Array] = []
        for j in range(1, self._columns + 1):
            row = [self._midpoint(z, first, t, time, 2 * j)]
            # Aitken and Neville in (1/n_j)² with n_j = 2 j: differences are divided by
            # (n_j / n_{j−k})² − 1.
            for k, before in enumerate(above, start=1):
                row.append(row[-1] + (row[-1] - before) * (j - k) ** 2 / (j**2 - (j - k) ** 2))
            above = row
        return above[-1], np.max(np.abs(above[-1] - above[-2]), axis=0)

    def _midpoint(self, z: Array, first: Array, t: Any, time: Any, count: int) -> Array:
        """Return the change of z by Gragg's rule with `count` steps, smoothed at its end.

        `first`: the slopes at z and t.
        """
        import numpy as np

        h = WIDE.mpf(time) / count
        twice = 2 * h
        before, current = np.zeros_like(z), first * h
        midpoint, change = np.empty_like(z), np.empty_like(z)  # buffers that every step reuses
        for k in range(1, count):
            _fill(change, self.slopes(*np.add(z, current, out=midpoint), t + k * h))
            change *= twice
            change += before
            before, current, change = current, change, before
        _fill(change, self.slopes(*np.add(z, current, out=midpoint), t + time))
        change *= h
        current += before
        current += change
        current /= 2
        return current


def _fill(rows: Array, values: Sequence[Array]) -> None:
    """Write each value into its row; a value may be one number for all points."""
    for k, value in enumerate(values):
        rows[k] = value
