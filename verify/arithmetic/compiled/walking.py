"""Orbits under way in a kernel: their words in memory, and where they stop on the way."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import count
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from verify.arithmetic.compiled.translation import Layout, Word

Words: TypeAlias = npt.NDArray[np.uint64]


class Walk(NamedTuple):
    """What is asked of a kernel: `stops` states, `every` steps apart, from a state.

    `fixed`: the kernel's arguments between the number of steps and the state. `beyond`: so many
    steps will be asked for after these.
    """

    every: int
    stops: int
    fixed: Sequence[Word]
    state: Sequence[Word]
    beyond: int = 0


class State(Sequence[Word]):
    """What a kernel carries, at one stop; each number is read where it is looked at."""

    __slots__ = ("_layout", "_pieces", "_raw")

    def __init__(self, layout: Layout, raw: bytes) -> None:
        self._layout, self._raw = layout, raw
        self._pieces = layout.pieces.unpack_from(raw)  # the number of steps is the first

    def __len__(self) -> int:
        return len(self._pieces) - 1

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            return tuple(self[k] for k in range(*index.indices(len(self))))
        at = index + 1 if index >= 0 else index + len(self._pieces)
        piece = self._pieces[at]
        return piece if piece.__class__ is float else self._layout.result(piece, at)

    def __iter__(self) -> Iterator[Word]:
        return map(self._layout.result, self._pieces[1:], count(1))

    def words(self) -> bytes:
        """All that is carried, as it lies in memory."""
        return self._raw[8 : self._layout.result_at[-1]]


@dataclass
class Orbit:
    """One orbit's words, its stops so far, and how far it is from the next."""

    layout: Layout
    walk: Walk
    words: Words  # the arguments
    left: int  # steps to the next stop
    states: list[State]

    @classmethod
    def begun(cls, layout: Layout, walk: Walk) -> "Orbit":
        """OverflowError where a number is outside the format."""
        head = layout.packed((walk.every, *walk.fixed))
        known = walk.state
        tail = known.words() if isinstance(known, State) else layout.packed_state(known)
        return cls(layout, walk, np.frombuffer(head + tail, dtype=np.uint64).copy(), walk.every, [])

    @property
    def steps_left(self) -> int:
        """Steps to the end of its run."""
        walk = self.walk
        return self.left + (walk.stops - len(self.states) - 1) * walk.every + walk.beyond

    @property
    def ended(self) -> bool:
        """Whether it is at its last stop, or has left its range before that: then there are
        fewer states."""
        return self.left == 0

    def take(self, result: Words, steps: int) -> None:
        """The results of so many steps."""
        if int(result[0]) < steps or not result[-1]:
            self.left = 0
            return
        self.left -= steps
        if self.left == 0:
            self.states.append(State(self.layout, result.tobytes()))
            self.left = self.walk.every if len(self.states) < self.walk.stops else 0


def step_together(orbits: Sequence[Orbit], kernel: Callable[[Words], Words], lanes: int) -> None:
    """Steps orbits, as many as there are lanes or fewer, until one of them has ended.

    Where the kernel is not called for a part of the way to a stop, all have the same way to each.
    """
    spare = [orbits[0].words] * (lanes - len(orbits))
    words = np.stack([*(orbit.words for orbit in orbits), *spare], axis=1)
    carried = slice(len(words) - sum(orbits[0].layout.result_sizes[1:]) // 8, None)
    going = True
    while going:
        steps = min(orbit.left for orbit in orbits)
        words[0] = steps
        found = kernel(words)
        words[carried] = found[1:-1]
        for orbit, result in zip(orbits, found.T, strict=False):
            orbit.take(result, steps)
        going = not any(orbit.ended for orbit in orbits)
    for orbit, column in zip(orbits, words.T, strict=False):
        orbit.words = column.copy()
