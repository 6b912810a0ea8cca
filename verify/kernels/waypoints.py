"""Where points have got to in float64, so that a longer way goes on from there.

A region is looked at after several times, and mostly by the same points: those that were followed
for a while are taken up where they are. Steps in two parts are the same steps, bit for bit.
"""

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from verify.kernels.kernel import Kernel

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
