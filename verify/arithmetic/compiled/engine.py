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
from verify.arithmetic.lanes.vectors import LANES
from verify.lockstep import Pending

Words: TypeAlias = npt.NDArray[np.uint64]


class Walk(NamedTuple):
    """A request to a kernel: `stops` states, `every` steps apart, from a state.

    `fixed`: the kernel's arguments between the number of steps and the state. `later_steps`: the
    number of steps that will be requested after these.
    """

    every: int
    stops: int
    fixed: Sequence[Word]
    state: Sequence[Word]
    later_steps: int = 0


class State(Sequence[Word]):
    """The numbers that a kernel carries, at one stop; each is decoded when it is read."""

    __slots__ = ("_layout", "_pieces", "_raw")

    def __init__(self, layout: Layout, raw: bytes) -> None:
        self._layout, self._raw = layout, raw
        self._pieces = layout.pieces.unpack_from(raw)  # the number of steps is the first

    def __len__(self) -> int:
        return len(self._pieces) - 1

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            return tuple(self[k] for k in range(*index.indices(len(self))))
        position = index + 1 if index >= 0 else index + len(self._pieces)
        piece = self._pieces[position]
        return piece if piece.__class__ is float else self._layout.result(piece, position)

    def __iter__(self) -> Iterator[Word]:
        return map(self._layout.result, self._pieces[1:], count(1))

    def words(self) -> bytes:
        """Return all that is carried, as it lies in memory."""
        return self._raw[8 : self._layout.result_at[-1]]


@dataclass
class Orbit:
    """The words of one orbit, its stops so far, and its distance from the next."""

    layout: Layout
    walk: Walk
    words: Words  # the arguments
    steps_to_stop: int  # steps to the next stop
    states: list[State]

    @classmethod
    def from_walk(cls, layout: Layout, walk: Walk) -> "Orbit":
        """Begin an orbit; OverflowError if a number is outside the format."""
        head = layout.pack((walk.every, *walk.fixed))
        state = walk.state
        tail = state.words() if isinstance(state, State) else layout.pack_state(state)
        return cls(layout, walk, np.frombuffer(head + tail, dtype=np.uint64).copy(), walk.every, [])

    @property
    def steps_left(self) -> int:
        """Steps to the end of its run."""
        walk = self.walk
        return (
            self.steps_to_stop + (walk.stops - len(self.states) - 1) * walk.every + walk.later_steps
        )

    @property
    def has_ended(self) -> bool:
        """True at its last stop, or if it has left its range before: then there are fewer
        states."""
        return self.steps_to_stop == 0

    def take(self, result: Words, steps: int) -> None:
        """Take over the results of so many steps."""
        # The first word is the number of steps done, the last one is 0 if a function had no
        # value: in either case the orbit has left the range, and its last state is not one.
        if int(result[0]) < steps or not result[-1]:
            self.steps_to_stop = 0
            return
        self.steps_to_stop -= steps
        if self.steps_to_stop == 0:
            self.states.append(State(self.layout, result.tobytes()))
            self.steps_to_stop = self.walk.every if len(self.states) < self.walk.stops else 0


def step_together(orbits: Sequence[Orbit], kernel: Callable[[Words], Words], lanes: int) -> None:
    """Step orbits, as many as there are lanes or fewer, until one of them has ended.

    If the kernel is not called for a part of the way to a stop, all have the same way to each.
    """
    # Unused lanes repeat the first orbit: its words are valid, so that they cannot slow the loop
    # down by leaving the range.
    spare = [orbits[0].words] * (lanes - len(orbits))
    words = np.stack([*(orbit.words for orbit in orbits), *spare], axis=1)
    state_words = slice(len(words) - sum(orbits[0].layout.result_sizes[1:]) // 8, None)
    going = True
    while going:
        steps = min(orbit.steps_to_stop for orbit in orbits)
        # All lanes make the same number of steps: the smallest distance to a stop.
        words[0] = steps
        results = kernel(words)
        words[state_words] = results[1:-1]
        for orbit, result in zip(orbits, results.T, strict=False):
            orbit.take(result, steps)
        going = not any(orbit.has_ended for orbit in orbits)
    for orbit, column in zip(orbits, words.T, strict=False):
        orbit.words = column.copy()


Names = tuple[tuple[str, Any], ...]
_LEAST_IN_LANES = 3 if LANES > 4 else 4  # fewer take longer together than one after the other
_MOST_IN_LANES = 496  # fraction bits; beyond that LLVM takes seconds
_WORTH_COMPILING = 5_000_000  # steps in all: what lanes save then is about what LLVM takes


def compile_source(source: str, fraction: int, names: Mapping[str, Any]) -> "NativeFunction":
    """Return the function that the source defines (see `verify.arithmetic.wide.translator`).

    It is compiled once, and linked when it is first called, since not every kernel that is made is
    run. It takes and gives `Fixed`, int and float. Raises OverflowError if an argument is
    outside the format, and ValueError if a function had no value outside a loop.
    """
    return _cached_function(source, fraction, tuple(sorted(names.items(), key=itemgetter(0))))


@lru_cache(maxsize=256)
def _cached_function(source: str, fraction: int, names: Names) -> "NativeFunction":
    return NativeFunction(Source(source, fraction, names))


class NativeFunction:
    """A function of one orbit, and of several at once, with the same bits.

    If it is a kernel it is a work too (see `verify.lockstep`), of which a `Walk` is asked: its
    first argument is a number of steps, its results are the steps done and what its last arguments
    have become.
    """

    def __init__(self, source: Source, *, anew: bool = False) -> None:
        """`anew`: not from what is kept on disk."""
        self.source = source
        self.layout, self._link = source.compile(anew=anew)
        self._expected = 0  # steps

    def __call__(self, *arguments: Word) -> object:
        packed = self.layout.pack(arguments)
        result = ctypes.create_string_buffer(sum(self.layout.result_sizes) + 8)
        self._link()(packed, result)
        return self.layout.unpack(result.raw)

    # -- several ------------------------------------------------------------------------------

    @cached_property
    def lane_kernel(self) -> "Callable[[Words], Words] | None":
        """The same as `orbit_kernel`, for as many orbits as there are lanes; None if one by one is
        better."""
        if self._lane_source is None:
            return None
        _, linked = self._lane_source.compile()
        return partial(_call, linked(), sum(self.layout.result_sizes) // 8 + 1)

    @cached_property
    def _lane_source(self) -> Source | None:
        path = paths.choose_path()
        if path is None or self.source.fraction > _MOST_IN_LANES:
            return None
        return replace(self.source, target=f"lanes, {path.name}", make=path.target)

    def expect(self, steps: int) -> None:
        """Announce that so many steps will be requested, of one orbit or of many."""
        self._expected += steps

    @cached_property
    def _no_need_to_compile(self) -> bool:
        """Lanes that are kept from earlier, or asked for, are used for short work too."""
        return bool(paths.forced_path()) or (
            self._lane_source is not None and self._lane_source.is_cached
        )

    @cached_property
    def orbit_kernel(self) -> "Callable[[Words], Words]":
        """The function from the arguments' words to the results' words; an orbit is a column."""
        return partial(_call, self._link(), sum(self.layout.result_sizes) // 8 + 1)

    def advance(self, pending: Sequence[Pending]) -> None:
        """Advance the walks that several orbits request, until one of them is at its end."""
        for work in pending:
            if work.state is None:
                try:
                    work.state = Orbit.from_walk(self.layout, work.request)
                except OverflowError as error:
                    work.end(None, error)
                    return
        # Who waits longest, so that nobody is left behind, and of the others those with the
        # longest way to go: then few are left to go alone at the end.
        longest = sorted(pending[1:], key=lambda work: -work.state.steps_left)
        chosen = [pending[0], *longest]
        chosen = (chosen if self.in_parts else _equally_far(chosen))[:LANES]
        worth = self._expected >= _WORTH_COMPILING or self._no_need_to_compile
        lanes = self.lane_kernel if worth and len(chosen) >= _LEAST_IN_LANES else None
        # Compilation for lanes takes seconds; it repays only if many steps are expected.
        if lanes is None:
            chosen = chosen[:1]
        kernel, orbits = lanes or self.orbit_kernel, [work.state for work in chosen]
        begin_time = time.perf_counter()  # it is compiled now
        step_together(orbits, kernel, LANES if lanes else 1)
        share = (time.perf_counter() - begin_time) / len(chosen)
        for work in chosen:
            work.seconds += share
            if work.state.has_ended:
                work.end(work.state.states)

    @cached_property
    def in_parts(self) -> bool:
        """True if m steps and then n are m + n, which a special first step makes untrue."""
        return "k == 0" not in self.source.text


def _equally_far(pending: Sequence[Pending]) -> list[Pending]:
    """Return those as far from their next stop as the first; all stand at a stop, and so they
    stay alike."""
    distance = pending[0].state.steps_to_stop
    return [work for work in pending if work.state.steps_to_stop == distance]


def _call(linked: native.Native, size: int, arguments: Words) -> Words:
    results = np.empty((size, arguments.shape[1]), dtype=np.uint64)
    linked(arguments.ctypes.data, results.ctypes.data)
    return results
