"""One step map iterated on many points at once, in any number system.

In float64 and in fixed point points are stepped in lanes, and threads share them. Float64 kernels
that solve equations take point after point, on threads too; so do other number systems, on one.

Where points have got to in float64, so that a longer way goes on from there.

A region is looked at after several times, and mostly by the same points: those that were followed
for a while are taken up where they are. Steps in two parts are the same steps, bit for bit.
"""

import contextlib
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from functools import cached_property, lru_cache, partial
from typing import Any

import numpy as np

from verify.arithmetic.compiled.doubles import POINTS, on_points
from verify.arithmetic.number import Number
from verify.arithmetic.number_system import Arithmetic, UnsupportedError
from verify.arithmetic.systems import float64
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.clock import clock_inputs, first_rest
from verify.kernels.kernel import Kernel, kernel_for
from verify.kernels.stepping import KernelRun, limits
from verify.lockstep import alone, together

_MOST = 1 << 16  # numbers that are kept of one kernel with its inputs: some 10 MB
_WORTH = 500  # steps: fewer are taken again as soon as looked up
Advance = Callable[[int, np.ndarray], np.ndarray]  # so many steps of what is carried, a column each


@lru_cache(maxsize=12)  # a region's maps, each with observables, and without
def waypoints(kernel: Kernel, inputs: tuple[float, ...]) -> "Waypoints":
    """Those of a kernel with these inputs."""
    return Waypoints("k == 0" not in kernel.source)


class Waypoints:
    """By what each point carried at its start: for how many steps it was followed, and where to."""

    def __init__(self, in_parts: bool) -> None:
        """`in_parts`: m steps and then n are m + n, which a first step of its own makes untrue."""
        self._in_parts = in_parts
        self._reached: dict[bytes, tuple[int, bytes]] = {}

    def followed(self, carried: np.ndarray, steps: int, advance: Advance) -> np.ndarray:
        """What is carried after so many steps of all points."""
        if steps < _WORTH or not self._in_parts:
            return advance(steps, carried)
        starts = _by_point(carried)
        left = np.full(len(starts), steps)
        found = carried.copy()
        for i, start in enumerate(starts):
            done, state = self._reached.get(start, (0, b""))
            if 0 < done <= steps:
                left[i] -= done
                found[:, i] = np.frombuffer(state)
        for more in set(left.tolist()) - {0}:
            those = left == more
            found[:, those] = advance(more, found[:, those])
        self._keep(starts, steps, found)
        return found

    def _keep(self, starts: list[bytes], steps: int, found: np.ndarray) -> None:
        """The farthest of each point, of as many points as there is room for."""
        room = _MOST // len(found)
        for start, end in zip(starts, _by_point(found), strict=True):
            known = self._reached.get(start)
            if (known is None and len(self._reached) < room) or (known and known[0] < steps):
                self._reached[start] = steps, end


def _by_point(carried: np.ndarray) -> list[bytes]:
    """What each point carries, a column, as bytes."""
    return [column.tobytes() for column in np.ascontiguousarray(carried.T)]


_ZERO = Fraction(0)
_SHARE = 32  # points that a thread takes at a time: some milliseconds and more
# Sequences of numbers, arrays or lists, by name: the coordinates and what else is carried.
Values = Mapping[str, Any]


class LeftRangeError(Exception):
    """A point left the range of the number system or of H; the message says which point."""


class PointMap:
    """z ↦ z_N by N steps of one scheme in one arithmetic."""

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
        """From t0 on, where H depends on time.

        Raises UnsupportedError where the arithmetic lacks what the scheme needs.
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
        """All that is carried, for points by their coordinates, p and q or p1 … qn: sequences of
        the arithmetic's numbers, of one length.

        Raises LeftRangeError.
        """
        found: Any
        given = [points[name] for name in self.kernel.coordinates]
        if self.arithmetic.name == float64.NAME:
            z = np.array(given, dtype=np.float64)
            found = self._remembered(z)
            lost = np.flatnonzero(~np.all(np.isfinite(found), axis=0))
            if lost.size:
                raise self._out_of_range(z[:, lost[0]].tolist())
        else:
            found = self._one_by_one(given)
        return dict(zip(self.kernel.state_names, found, strict=True))

    def _inputs(self, extra: Sequence[Fraction] = ()) -> list[Number]:
        given = [*self.kernel_run.inputs(self.kernel, 0).values(), *extra]
        if self.kernel.timed:
            given += clock_inputs(self.arithmetic, self.kernel_run.start).values()
        return [self.arithmetic.number(x) for x in given]

    @cached_property
    def _floats(self) -> np.ndarray:
        return np.array(self._inputs(), dtype=np.float64)

    @property
    def _rest(self) -> list[Number]:
        """What is carried beside the coordinates, at the start."""
        start = self.kernel_run.start
        if self.kernel.timed:
            start = start | {"t": self._t0} | first_rest(self.arithmetic, self._t0)
        exact = (start[x] if isinstance(x, str) else Fraction(x) for x in self.kernel.start)
        return [self.arithmetic.number(x) for x in exact]

    def followed(self, given: np.ndarray) -> np.ndarray:
        """All that is carried, in float64, of points (coordinates, points): a row each, and no
        finite number where a point has left the range."""
        return self._advanced(self.steps, self._carried(given))

    def _remembered(self, given: np.ndarray) -> np.ndarray:
        """The same; points that were followed for fewer steps go on from there."""
        known = waypoints(self.kernel, tuple(self._floats.tolist()))
        return known.followed(self._carried(given), self.steps, self._advanced)

    def _carried(self, given: np.ndarray) -> np.ndarray:
        """What is carried at the start."""
        rest = [np.full(given.shape[1], x, dtype=np.float64) for x in self._rest]
        return np.array([*given, *rest])

    def _advanced(self, steps: int, carried: np.ndarray) -> np.ndarray:
        run, share = _stepper(self.kernel)
        count = carried.shape[1]
        # A point more than once, where a call takes so many.
        every = np.pad(carried, ((0, 0), (0, -count % share)), "edge")

        def advance(first: int) -> None:
            run(steps, self._floats, every[:, first : first + share])

        with ThreadPoolExecutor(os.cpu_count()) as threads:
            list(threads.map(advance, range(0, count, share)))
        return every[:, :count]

    def _one_by_one(self, given: Sequence[Sequence[Number]]) -> list[list[Number]]:
        made = self.arithmetic
        inputs = self._inputs(self._limits(given)[: len(self.kernel.limits)])
        rest = self._rest
        points = [(*z, *rest) for z in zip(*given, strict=True)]
        found: list[Sequence[Number]] = []
        for z, states in zip(points, self._last_states(inputs, points), strict=True):
            if not states:
                raise self._out_of_range([float(made.exact(x)) for x in z[: len(given)]])
            found += states
        return [list(column) for column in zip(*found, strict=True)]

    def _out_of_range(self, point: Sequence[float]) -> LeftRangeError:
        at = dict(zip(self.kernel.coordinates, point, strict=True))
        names = sorted(at, key=lambda name: name[0] != "q")
        shown = ", ".join(f"{at[name]:.6g}" for name in names)
        where = f"({', '.join(names)}) = ({shown})"
        return LeftRangeError(
            f"the point {where} leaves the range of {self.arithmetic.name}, or of H"
        )

    def _last_states(
        self, inputs: Sequence[Number], points: Sequence[Sequence[Number]]
    ) -> Iterator[list[Sequence[Number]]]:
        """Of each point its last state, or none where it left the range."""
        kernel, states = self.kernel.function, self.arithmetic.states
        calls = [partial(states, kernel, self.steps, 1, inputs, z) for z in points]
        if self.arithmetic.walk is None:
            yield from (alone(call()) for call in calls)
            return

        self.arithmetic.expect(kernel, self.steps * len(points))

        def advance(first: int) -> list[list[Sequence[Number]]]:
            share = calls[first : first + _SHARE]
            ended = dict(together((call() for call in share), len(share)))
            return [ended[k].result() for k in range(len(share))]

        with ThreadPoolExecutor(os.cpu_count()) as threads:  # native code runs beside Python
            for part in threads.map(advance, range(0, len(calls), _SHARE)):
                yield from part

    def _limits(self, given: Sequence[Sequence[Number]]) -> tuple[Fraction, ...]:
        """Those of a fixed-point kernel, for all points together."""
        if not self.kernel.limits:
            return ()
        exact = self.arithmetic.exact
        pairs = zip(self.kernel.coordinates, given, strict=True)
        far = {name: max(abs(exact(x)) for x in z) for name, z in pairs}
        run = self.kernel_run
        last = self._t0 + self.steps * run.start["h"]
        times = (self._t0, last) if self.kernel.timed else None
        found = limits(self.kernel, run.inputs(self.kernel, 0), run.start | far, times)
        if found is None:
            raise UnsupportedError(f"no box around the points is safe in {self.arithmetic.name}")
        return found


@lru_cache(maxsize=64)
def _stepper(kernel: Kernel) -> tuple[Callable[[int, np.ndarray, np.ndarray], None], int]:
    """`run(steps, inputs, rows)`, in place, and how many columns it takes at a time."""
    with contextlib.suppress(NotImplementedError):
        return on_points(kernel.source, kernel.names, len(kernel.state_names)), POINTS
    one = float64.compiled_at_once().compile(kernel.source, "kernel", kernel.names)

    def run(steps: int, inputs: np.ndarray, points: np.ndarray) -> None:
        for at, point in enumerate(points.T.tolist()):
            points[:, at] = one(steps, *inputs, *point)[1:]

    return run, _SHARE
