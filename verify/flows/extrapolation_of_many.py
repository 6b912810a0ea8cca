"""The numerical flow of many points at once, in arrays of floats: Gragg's method, extrapolated.

As `verify.flows.extrapolation` follows one point with any number of digits; here all take the same
steps, as long as the least accurate of them allows. They are in the C compiler's long double, which
is not much slower here: in float64 what is lost grows with the time to 10⁻¹⁰ and more.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import nullcontext
from dataclasses import replace
from fractions import Fraction
from typing import Any

from verify.arithmetic.float_context import WIDE
from verify.arithmetic.number_system import Arithmetic, interpreted
from verify.arithmetic.systems import float64
from verify.flows.extrapolation import LOST, NoFlowError
from verify.flows.functions import functions_at
from verify.functions import in_rings
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian

Array = Any  # numpy.ndarray, which is imported where it is used
Slopes = Callable[..., tuple[Array, ...]]  # of the coordinates and t
_ZERO = Fraction(0)

_TOLERANCE = 4096  # roundings: of the last two extrapolated values, relative to the orbit so far
_EASY = 1e-2  # of the tolerance, below which a longer step is tried
_LONGER, _SHORTER = 1.25, 0.7
_SHORTEST = 2.0**-60  # of the first step
_MOST_STEPS = 100_000
_STEP_BITS = 12  # of a step, so that times are sums without rounding


def follow(
    hamiltonian: Hamiltonian,
    points: Sequence[Array] | Array,
    times: Sequence[Fraction],
    columns: int,
    t0: Fraction = _ZERO,
) -> Array:
    """φ_t of all points, p and q or p1 … qn: an array (coordinate, time, point). Times may have
    either sign, and are those since t0, where H depends on time.

    `columns` of the extrapolation: two different numbers of them give independent errors. Raises
    NoFlowError, naming a point, where one cannot be followed.
    """
    import numpy as np

    start = np.array(points, dtype=WIDE.type)
    found = np.empty((len(start), len(times), start.shape[1]))
    with np.errstate(all="ignore"):
        slopes = slopes_of(hamiltonian)
        for sign in (1, -1):
            walk = CommonSteps(slopes, start, sign, columns, WIDE.rational(t0))
            order = sorted((t for t in set(times) if sign * t > 0 or t == 0), key=abs)
            for time in order:
                walk.to(WIDE.rational(abs(time)))
                for k in (k for k, t in enumerate(times) if t == time):
                    found[:, k] = walk.z
    return found


def slopes_of(hamiltonian: Hamiltonian) -> Slopes:
    """f at the coordinates and a t, which an H without time does not look at."""
    field, _ = canonical_field(hamiltonian)
    elements = [(field.ring, x) for x in field.slopes]
    names = hamiltonian.coordinates
    if hamiltonian.time_dependent:
        return functions_at(arrays(), elements, (*names, "t"))
    still = functions_at(arrays(), elements, names)
    return lambda *z: still(*z[:-1])


def arrays() -> Arithmetic:
    """Long double over arrays."""
    import numpy as np

    def root(x: Array, n: int) -> Array:
        y = np.power(x, 1 / n)
        return y - np.where(y > 0, (y**n - x) / (n * y ** (n - 1)), 0.0)  # 1/n is rounded

    functions = {
        **{name: getattr(np, f.numpy) for name, f in in_rings().items()},
        "sqrt": np.sqrt,
        "root": root,
        "pi": WIDE.pi,
    }
    return replace(
        float64.make(17), name="arrays", bits=WIDE.prec, number=WIDE.rational,
        functions=functions, compile=interpreted, context=nullcontext,
    )  # fmt: skip


def _short(step: float) -> float:
    mantissa, exponent = math.frexp(step)
    return math.ldexp(math.floor(math.ldexp(mantissa, _STEP_BITS)), exponent - _STEP_BITS)


class CommonSteps:
    """All points on their way, by common steps."""

    def __init__(self, slopes: Slopes, start: Array, sign: int, columns: int, t0: Any) -> None:
        import numpy as np

        self.z, self._t0 = start, t0
        self.slopes = slopes
        self._sign = sign
        self._columns = columns
        self._done = WIDE.mpf(0)
        self._tolerance = _TOLERANCE * float(WIDE.eps)
        self._scale = np.max(np.abs(start), axis=0)  # of each orbit, as far as it is known
        at = np.broadcast_arrays(*slopes(*start, t0), start[0])[:-1]
        speed = np.max(abs(np.array(at)), axis=0)
        size = np.where(self._scale > 0, self._scale, 1.0)
        fastest = float(np.max(speed / size, initial=0.0))
        self._step = _short(1.0 / (1.0 + fastest)) if np.isfinite(fastest) else 1.0
        self._least = self._step * _SHORTEST

    def to(self, goal: Any) -> None:
        """To this time since the start. Raises NoFlowError."""
        for _ in self.steps_to(goal):
            pass

    def steps_to(self, goal: Any) -> Iterator[tuple[Array, Any]]:
        """After each step, where the points were before it, and its length."""
        import numpy as np

        for _ in range(_MOST_STEPS):
            if self._done >= goal:
                return
            last = self._done + self._step >= goal
            step = goal - self._done if last else self._step
            moved, error = self._extrapolated(self.z, self._sign * step)
            size = np.maximum(self._scale, np.max(np.abs(self.z + moved), axis=0))
            ratio = error / np.where(size > 0, size, 1.0)
            worst = float(ratio.max(initial=0.0))
            if worst <= self._tolerance:
                before, self.z, self._scale = self.z, self.z + moved, size
                self._done = goal if last else self._done + step
                yield before, step
                if worst <= _EASY * self._tolerance and not last:
                    self._step = _short(self._step * _LONGER)
                continue
            self._step = _short(float(step) * _SHORTER)
            if self._step < self._least or self._done + self._step == self._done:
                raise NoFlowError(self._lost(ratio))
        raise NoFlowError(f"{_MOST_STEPS} steps lead only to t = `{self._sign * self._done:.6g}`")

    def _lost(self, ratio: Array) -> str:
        import numpy as np

        i = int(np.argmax(np.where(np.isfinite(ratio), ratio, np.inf)))
        return f"point {i}: {LOST}, at about t = `{self._sign * self._done:.6g}`"

    def moved(self, z: Array, time: Array) -> Array:
        """How far points move in a time each, of a step's length or less, of an H without time."""
        return self._extrapolated(z, time)[0]

    def _extrapolated(self, z: Array, time: Any) -> tuple[Array, Array]:
        """How far the points move by Aitken and Neville's scheme, and its estimated error."""
        import numpy as np

        t = self._t0 + self._sign * self._done
        first = np.empty_like(z)  # of all these rules
        _fill(first, self.slopes(*z, t))
        above: list[Array] = []
        for j in range(1, self._columns + 1):
            row = [self._midpoint(z, first, t, time, 2 * j)]
            for k, before in enumerate(above, start=1):
                row.append(row[-1] + (row[-1] - before) * (j - k) ** 2 / (j**2 - (j - k) ** 2))
            above = row
        return above[-1], np.max(np.abs(above[-1] - above[-2]), axis=0)

    def _midpoint(self, z: Array, first: Array, t: Any, time: Any, count: int) -> Array:
        """Gragg's rule with so many steps, smoothed at its end: what is added to z.

        `first`: the slopes at z and t.
        """
        import numpy as np

        h = WIDE.mpf(time) / count
        twice = 2 * h
        before, at = np.zeros_like(z), first * h
        place, change = np.empty_like(z), np.empty_like(z)  # one array each for all steps
        for k in range(1, count):
            _fill(change, self.slopes(*np.add(z, at, out=place), t + k * h))
            change *= twice
            change += before
            before, at, change = at, change, before
        _fill(change, self.slopes(*np.add(z, at, out=place), t + time))
        change *= h
        at += before
        at += change
        at /= 2
        return at


def _fill(rows: Array, values: Sequence[Array]) -> None:
    """A row may be one number for all points."""
    for k, value in enumerate(values):
        rows[k] = value
