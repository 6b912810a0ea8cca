"""One step map iterated on many points at once, in any number system.

In float64 and in fixed point, points are stepped in lanes, on several threads. Float64 kernels that
solve equations step one point after another, on several threads too; other number systems do so on
one thread.

In float64 the states that points have reached are cached, and a longer run starts from them: a
region is drawn at several times, mostly with the same points. m steps and then n have the same bits
as m + n.
"""

import contextlib
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from functools import cached_property, lru_cache, partial
from typing import Any

import numpy as np

from verify.arithmetic.compiled.doubles import POINTS_PER_CALL, on_points
from verify.arithmetic.number_system import Arithmetic, SystemNumber, UnsupportedError
from verify.arithmetic.systems import float64
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import Kernel, clock_inputs, initial_remainder, kernel_for
from verify.kernels.stepping import KernelRun, limits
from verify.lockstep import run_alone, run_together

_MAX_CACHED_NUMBERS = 1 << 16  # for one kernel with its inputs; some 10 MB
_MIN_CACHED_STEPS = 500  # a lookup takes as long as so many steps
Advance = Callable[[int, np.ndarray], np.ndarray]  # (steps, columns of carried numbers)


@lru_cache(maxsize=12)  # for the maps of a region, each with observables and without
def waypoints_of(kernel: Kernel, inputs: tuple[float, ...]) -> "Waypoints":
    """Return the cache for a kernel with these inputs."""
    return Waypoints("k == 0" not in kernel.source)


class Waypoints:
    """A cache: bytes of a point's initial state → the number of steps made from it, and the state
    after them."""

    def __init__(self, in_parts: bool) -> None:
        """`in_parts`: m steps and then n are the same as m + n; else nothing is cached."""
        self._in_parts = in_parts
        self._states: dict[bytes, tuple[int, bytes]] = {}

    def advance_points(self, values: np.ndarray, steps: int, advance: Advance) -> np.ndarray:
        """Return the carried numbers of all points, a column each, after `steps` steps."""
        if steps < _MIN_CACHED_STEPS or not self._in_parts:
            return advance(steps, values)
        starts = _by_point(values)
        steps_left = np.full(len(starts), steps)
        end_values = values.copy()
        for i, start in enumerate(starts):
            done, state = self._states.get(start, (0, b""))
            if 0 < done <= steps:
                steps_left[i] -= done
                end_values[:, i] = np.frombuffer(state)
        # Points with the same number of steps left are advanced in one call, for full lanes.
        for count in set(steps_left.tolist()) - {0}:
            selected = steps_left == count
            end_values[:, selected] = advance(count, end_values[:, selected])
        self._keep(starts, steps, end_values)
        return end_values

    def _keep(self, starts: list[bytes], steps: int, end_values: np.ndarray) -> None:
        """Cache the latest state of each point, for as many points as there is room for."""
        room = _MAX_CACHED_NUMBERS // len(end_values)
        for start, end in zip(starts, _by_point(end_values), strict=True):
            previous = self._states.get(start)
            if (previous is None and len(self._states) < room) or (
                previous and previous[0] < steps
            ):
                self._states[start] = steps, end


def _by_point(values: np.ndarray) -> list[bytes]:
    """Return the numbers that each point carries, a column, as bytes."""
    return [column.tobytes() for column in np.ascontiguousarray(values.T)]


_ZERO = Fraction(0)
_POINTS_PER_TASK = 32  # a thread takes so many points at a time: some milliseconds or more
# Sequences of numbers, arrays or lists, by name: the coordinates and what else is carried.
Values = Mapping[str, Any]


class LeftRangeError(Exception):
    """A point left the range of the number system or of H; the message says which point."""


class PointMap:
    """The map z ↦ z_N by N steps of one scheme in one arithmetic."""

    def __init__(
        self,
        hamiltonian: Hamiltonian,
        scheme: str,
        *,
        step_size: Fraction,
        steps: int,
        arithmetic: Arithmetic,
        t0: Fraction = _ZERO,
        observables: frozenset[str] = frozenset(),
        compensated: bool = False,
    ) -> None:
        """`t0`: the time of the first step, if H depends on time.

        Raises UnsupportedError if the arithmetic lacks something that the scheme needs.
        """
        self.arithmetic, self.steps = arithmetic, steps
        start = {"h": step_size, "t": t0} | dict.fromkeys(hamiltonian.coordinates, _ZERO)
        self.kernel_run = KernelRun(hamiltonian, scheme, start, steps, observables, 0)
        self.kernel = kernel_for(
            self.kernel_run.hamiltonian, scheme, arithmetic, observables, compensated
        )
        if self.kernel.scales or self.kernel.tangent:
            raise UnsupportedError(f"{arithmetic.name} carries no observables for many points")
        turns = self.kernel_run.turns(arithmetic)
        self._t0 = turns.time(t0, arithmetic) if turns else t0

    def __call__(self, **points: Any) -> Values:
        """Return the carried numbers of all points after the steps, by name.

        `points`: for each coordinate, p and q or p1 … qn, a sequence of the arithmetic's numbers;
        all are of one length. Raises LeftRangeError.
        """
        columns: Any
        coordinates = [points[name] for name in self.kernel.coordinates]
        if self.arithmetic.name == float64.NAME:
            z = np.array(coordinates, dtype=np.float64)
            columns = self._carried_with_waypoints(z)
            # float64 has no guard: a point that left the range has infinities or NaN in its last
            # state.
            escaped = np.flatnonzero(~np.all(np.isfinite(columns), axis=0))
            if escaped.size:
                raise self._range_error(z[:, escaped[0]].tolist())
        else:
            columns = self._run_one_by_one(coordinates)
        return dict(zip(self.kernel.state_names, columns, strict=True))

    def _inputs(self, extra: Sequence[Fraction] = ()) -> list[SystemNumber]:
        values = [*self.kernel_run.inputs(self.kernel, 0).values(), *extra]
        if self.kernel.timed:
            values += clock_inputs(self.arithmetic, self.kernel_run.start).values()
        return [self.arithmetic.number(x) for x in values]

    @cached_property
    def _floats(self) -> np.ndarray:
        return np.array(self._inputs(), dtype=np.float64)

    @property
    def _extra_start(self) -> list[SystemNumber]:
        """The initial values of the numbers carried besides the coordinates."""
        start = self.kernel_run.start
        if self.kernel.timed:
            start = start | {"t": self._t0} | initial_remainder(self.arithmetic, self._t0)
        values = (start[x] if isinstance(x, str) else Fraction(x) for x in self.kernel.start)
        return [self.arithmetic.number(x) for x in values]

    def carried_after(self, points: np.ndarray) -> np.ndarray:
        """Return the carried numbers after the steps, a row each, in float64.

        `points` has the shape (coordinates, points). A point that has left the range has numbers
        that are not finite.
        """
        return self._advance(self.steps, self._start_values(points))

    def _carried_with_waypoints(self, points: np.ndarray) -> np.ndarray:
        """Return the same as `carried_after`, from the states that are cached."""
        cache = waypoints_of(self.kernel, tuple(self._floats.tolist()))
        return cache.advance_points(self._start_values(points), self.steps, self._advance)

    def _start_values(self, points: np.ndarray) -> np.ndarray:
        """Return the initial carried numbers, a row each."""
        extra = [np.full(points.shape[1], x, dtype=np.float64) for x in self._extra_start]
        return np.array([*points, *extra])

    def _advance(self, steps: int, values: np.ndarray) -> np.ndarray:
        run, share = _stepper(self.kernel)
        count = values.shape[1]
        # The kernel takes `share` columns at a time; copies of the last point fill the last call.
        padded = np.pad(values, ((0, 0), (0, -count % share)), "edge")

        def advance(first: int) -> None:
            run(steps, self._floats, padded[:, first : first + share])

        with ThreadPoolExecutor(os.cpu_count()) as threads:
            list(threads.map(advance, range(0, count, share)))
        return padded[:, :count]

    def _run_one_by_one(
        self, coordinates: Sequence[Sequence[SystemNumber]]
    ) -> list[list[SystemNumber]]:
        arithmetic = self.arithmetic
        inputs = self._inputs(self._limits(coordinates)[: len(self.kernel.limits)])
        extra = self._extra_start
        points = [(*z, *extra) for z in zip(*coordinates, strict=True)]
        end_states: list[Sequence[SystemNumber]] = []
        for z, states in zip(points, self._last_states(inputs, points), strict=True):
            if not states:
                raise self._range_error([float(arithmetic.exact(x)) for x in z[: len(coordinates)]])
            end_states += states
        return [list(column) for column in zip(*end_states, strict=True)]

    def _range_error(self, point: Sequence[float]) -> LeftRangeError:
        values = dict(zip(self.kernel.coordinates, point, strict=True))
        names = sorted(values, key=lambda name: name[0] != "q")
        coordinates = ", ".join(f"{values[name]:.6g}" for name in names)
        point_text = f"({', '.join(names)}) = ({coordinates})"
        return LeftRangeError(
            f"the point {point_text} leaves the range of {self.arithmetic.name}, or of H"
        )

    def _last_states(
        self, inputs: Sequence[SystemNumber], points: Sequence[Sequence[SystemNumber]]
    ) -> Iterator[list[Sequence[SystemNumber]]]:
        """Yield for each point a list with its last state, which is empty if it left the range."""
        kernel, states = self.kernel.function, self.arithmetic.states
        calls = [partial(states, kernel, self.steps, 1, inputs, z) for z in points]
        if self.arithmetic.walk is None:
            yield from (run_alone(call()) for call in calls)
            return

        self.arithmetic.expect(kernel, self.steps * len(points))

        def advance(first: int) -> list[list[Sequence[SystemNumber]]]:
            share = calls[first : first + _POINTS_PER_TASK]
            results = dict(run_together((call() for call in share), len(share)))
            return [results[k].result() for k in range(len(share))]

        with ThreadPoolExecutor(os.cpu_count()) as threads:  # native code runs beside Python
            for part in threads.map(advance, range(0, len(calls), _POINTS_PER_TASK)):
                yield from part

    def _limits(self, coordinates: Sequence[Sequence[SystemNumber]]) -> tuple[Fraction, ...]:
        """Return the limits of a fixed-point kernel that hold for all points; empty if the kernel
        has none."""
        if not self.kernel.limits:
            return ()
        to_fraction = self.arithmetic.exact
        pairs = zip(self.kernel.coordinates, coordinates, strict=True)
        farthest = {name: max(abs(to_fraction(x)) for x in z) for name, z in pairs}
        run = self.kernel_run
        last_time = self._t0 + self.steps * run.start["h"]
        times = (self._t0, last_time) if self.kernel.timed else None
        bounds = limits(self.kernel, run.inputs(self.kernel, 0), run.start | farthest, times)
        if bounds is None:
            raise UnsupportedError(f"no box around the points is safe in {self.arithmetic.name}")
        return bounds


@lru_cache(maxsize=64)
def _stepper(kernel: Kernel) -> tuple[Callable[[int, np.ndarray, np.ndarray], None], int]:
    """Return `run(steps, inputs, points)`, which works in place, and the number of columns that it
    takes at a time."""
    with contextlib.suppress(NotImplementedError):
        return on_points(kernel.source, kernel.names, len(kernel.state_names)), POINTS_PER_CALL
    one = float64.compiled_at_once().compile(kernel.source, "kernel", kernel.names)

    def run(steps: int, inputs: np.ndarray, points: np.ndarray) -> None:
        for column, point in enumerate(points.T.tolist()):
            points[:, column] = one(steps, *inputs, *point)[1:]

    return run, _POINTS_PER_TASK
