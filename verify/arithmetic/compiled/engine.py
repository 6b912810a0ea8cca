"""Kernels in fixed point as native functions: one orbit at a time, or several in lanes.

Orbits under way in a kernel: their words in memory, and where they stop on the way.
"""

import ctypes
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache, partial
from itertools import count
from operator import itemgetter
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from verify.arithmetic.compiled import native, paths
from verify.arithmetic.compiled.translation import Fixed as Fixed
from verify.arithmetic.compiled.translation import Layout, Source, Word
from verify.arithmetic.processor import LANES
from verify.lockstep import Pending

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


Names = tuple[tuple[str, Any], ...]
_LEAST_IN_LANES = 3 if LANES > 4 else 4  # fewer take longer together than one after the other
_MOST_IN_LANES = 496  # fraction bits; beyond that LLVM takes seconds
_WORTH_COMPILING = 5_000_000  # steps in all: what lanes save then is about what LLVM takes


def compiled(source: str, fraction: int, names: Mapping[str, Any]) -> "NativeFunction":
    """The function that the source defines (see `verify.arithmetic.wide.translate`).

    It is compiled once, and linked when it is first called, since not every kernel that is made is
    run. It takes and gives `Fixed`, int and float. Raises OverflowError where an argument is
    outside the format, and ValueError where a function had no value outside a loop.
    """
    return _compiled(source, fraction, tuple(sorted(names.items(), key=itemgetter(0))))


@lru_cache(maxsize=256)
def _compiled(source: str, fraction: int, names: Names) -> "NativeFunction":
    return NativeFunction(Source(source, fraction, names))


class NativeFunction:
    """A function of one orbit, and of several at once, with the same bits.

    Where it is a kernel it is a work too (see `verify.lockstep`), of which a `Walk` is asked: its
    first argument is a number of steps, its results are the steps done and what its last arguments
    have become.
    """

    def __init__(self, source: Source, *, anew: bool = False) -> None:
        """`anew`: not from what is kept on disk."""
        self.source = source
        self.layout, self._one = source.compiled(anew=anew)
        self._expected = 0  # steps

    def __call__(self, *arguments: Word) -> object:
        return self.layout.unpacked(self._run_one(self.layout.packed(arguments)))

    def _run_one(self, packed: bytes) -> bytes:
        result = ctypes.create_string_buffer(sum(self.layout.result_sizes) + 8)
        self._one()(packed, result)
        return result.raw

    # -- several ------------------------------------------------------------------------------

    @cached_property
    def lanes(self) -> "Callable[[Words], Words] | None":
        """As `one`, of so many orbits as there are lanes; None where one by one is better."""
        if self._in_lanes is None:
            return None
        _, linked = self._in_lanes.compiled()
        return partial(_called, linked(), sum(self.layout.result_sizes) // 8 + 1)

    @cached_property
    def _in_lanes(self) -> Source | None:
        path = paths.chosen()
        if path is None or self.source.fraction > _MOST_IN_LANES:
            return None
        return replace(self.source, target=f"lanes, {path.name}", make=path.target)

    def expect(self, steps: int) -> None:
        """Said before: so many steps will be asked for, of one orbit or of many."""
        self._expected += steps

    @cached_property
    def _no_need_to_compile(self) -> bool:
        """Lanes that are kept from earlier, or asked for, are used for short work too."""
        return bool(paths.forced()) or (self._in_lanes is not None and self._in_lanes.kept)

    @cached_property
    def one(self) -> "Callable[[Words], Words]":
        """The results' words of the arguments' words, which are rows with an orbit a column."""
        return partial(_called, self._one(), sum(self.layout.result_sizes) // 8 + 1)

    def advance(self, pending: Sequence[Pending]) -> None:
        """Walks that several orbits ask for, until one of them is at its end."""
        for each in pending:
            if each.state is None:
                try:
                    each.state = Orbit.begun(self.layout, each.asked)
                except OverflowError as error:
                    each.end(None, error)
                    return
        # Who waits longest, so that nobody is left behind, and of the others those with the
        # longest way to go: then few are left to go alone at the end.
        longest = sorted(pending[1:], key=lambda each: -each.state.steps_left)
        chosen = [pending[0], *longest]
        chosen = (chosen if self.in_parts else _as_far_as_the_first(chosen))[:LANES]
        worth = self._expected >= _WORTH_COMPILING or self._no_need_to_compile
        lanes = self.lanes if worth and len(chosen) >= _LEAST_IN_LANES else None
        if lanes is None:
            chosen = chosen[:1]
        kernel, orbits = lanes or self.one, [each.state for each in chosen]
        begun = time.perf_counter()  # it is compiled now
        step_together(orbits, kernel, LANES if lanes else 1)
        share = (time.perf_counter() - begun) / len(chosen)
        for each in chosen:
            each.seconds += share
            if each.state.ended:
                each.end(each.state.states)

    @cached_property
    def in_parts(self) -> bool:
        """Whether m steps and then n are m + n, which a first step of its own makes untrue."""
        return "k == 0" not in self.source.text


def _as_far_as_the_first(pending: Sequence[Pending]) -> list[Pending]:
    """Those as far from their next stop; all stand at a stop, and so they stay alike."""
    left = pending[0].state.left
    return [each for each in pending if each.state.left == left]


def _called(linked: native.Native, size: int, given: Words) -> Words:
    found = np.empty((size, given.shape[1]), dtype=np.uint64)
    linked(given.ctypes.data, found.ctypes.data)
    return found
