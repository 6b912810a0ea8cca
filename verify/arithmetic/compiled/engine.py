"""Kernels in fixed point as native functions: one orbit at a time, or several in lanes.

An `Orbit` is one that a kernel is stepping: its words in memory, and the stops at which its state
is recorded.
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
    """The numbers that a kernel carries, at one stop; a number is decoded when it is read."""

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
        """Return the bytes of all carried numbers, as they lie in memory."""
        return self._raw[8 : self._layout.result_at[-1]]


@dataclass
class Orbit:
    """The words of one orbit, its states at the stops so far, and the steps to its next stop."""

    layout: Layout
    walk: Walk
    words: Words  # the kernel's arguments
    steps_to_stop: int
    states: list[State]

    @classmethod
    def from_walk(cls, layout: Layout, walk: Walk) -> "Orbit":
        """Begin an orbit. Raises OverflowError if a number is outside the format."""
        head = layout.pack((walk.every, *walk.fixed))
        state = walk.state
        tail = state.words() if isinstance(state, State) else layout.pack_state(state)
        return cls(layout, walk, np.frombuffer(head + tail, dtype=np.uint64).copy(), walk.every, [])

    @property
    def steps_left(self) -> int:
        """The number of steps to the end of its run."""
        walk = self.walk
        return (
            self.steps_to_stop + (walk.stops - len(self.states) - 1) * walk.every + walk.later_steps
        )

    @property
    def has_ended(self) -> bool:
        """True at its last stop, or if it left its range before; there are fewer states then."""
        return self.steps_to_stop == 0

    def take(self, result: Words, steps: int) -> None:
        """Take over the results of a call for `steps` steps."""
        # The first word is the number of steps done; the last one is 0 if a function had no value.
        # If a step or a value is missing, the orbit has left the range: the results are no state.
        if int(result[0]) < steps or not result[-1]:
            self.steps_to_stop = 0
            return
        self.steps_to_stop -= steps
        if self.steps_to_stop == 0:
            self.states.append(State(self.layout, result.tobytes()))
            self.steps_to_stop = self.walk.every if len(self.states) < self.walk.stops else 0


def step_together(orbits: Sequence[Orbit], kernel: Callable[[Words], Words], lanes: int) -> None:
    """Step orbits, at most as many as there are lanes, until one of them has ended.

    If a kernel must not stop between two stops (see `in_parts`), all orbits must be equally far
    from theirs.
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
_MIN_LANE_ORBITS = 3 if LANES > 4 else 4  # fewer orbits take longer together than in turn
_MAX_LANE_FRACTION = 496  # fraction bits; for more LLVM takes seconds
# Over so many steps of all orbits, lanes save about the time that LLVM takes to compile for them.
_MIN_STEPS_TO_COMPILE = 5_000_000


def compile_source(source: str, fraction: int, names: Mapping[str, Any]) -> "NativeFunction":
    """Return the function that the source defines (see `verify.arithmetic.wide.translator`).

    It is compiled once, and linked at its first call, since not every kernel is run. Its arguments
    and results are `Fixed`, int and float. A call raises OverflowError if an argument is outside
    the format, and ValueError if a function had no value outside a loop.
    """
    return _cached_function(source, fraction, tuple(sorted(names.items(), key=itemgetter(0))))


@lru_cache(maxsize=256)
def _cached_function(source: str, fraction: int, names: Names) -> "NativeFunction":
    return NativeFunction(Source(source, fraction, names))


class NativeFunction:
    """A function of one orbit, and of several at once, with the same bits.

    A kernel is also a work (see `verify.lockstep`) whose requests are `Walk`s: its first argument
    is a number of steps; its results are the steps done and the new values of its last arguments.
    """

    def __init__(self, source: Source, *, anew: bool = False) -> None:
        """`anew`: compile it even if its code is cached on disk."""
        self.source = source
        self.layout, self._link = source.compile(anew=anew)
        self._expected_steps = 0

    def __call__(self, *arguments: Word) -> object:
        packed = self.layout.pack(arguments)
        result = ctypes.create_string_buffer(sum(self.layout.result_sizes) + 8)
        self._link()(packed, result)
        return self.layout.unpack(result.raw)

    # -- several ------------------------------------------------------------------------------

    @cached_property
    def lane_kernel(self) -> "Callable[[Words], Words] | None":
        """The same as `orbit_kernel`, for as many orbits as there are lanes; None if orbits are
        stepped one by one."""
        if self._lane_source is None:
            return None
        _, linked = self._lane_source.compile()
        return partial(_call, linked(), sum(self.layout.result_sizes) // 8 + 1)

    @cached_property
    def _lane_source(self) -> Source | None:
        path = paths.choose_path()
        if path is None or self.source.fraction > _MAX_LANE_FRACTION:
            return None
        return replace(self.source, target=f"lanes, {path.name}", make=path.target)

    def expect(self, steps: int) -> None:
        """Announce that so many steps will be requested, of one orbit or of many."""
        self._expected_steps += steps

    @cached_property
    def _no_need_to_compile(self) -> bool:
        """True if lanes are used for short work too: their code is cached, or a user forced
        them."""
        return bool(paths.forced_path()) or (
            self._lane_source is not None and self._lane_source.is_cached
        )

    @cached_property
    def orbit_kernel(self) -> "Callable[[Words], Words]":
        """The function from the arguments' words to the results' words, one column per orbit."""
        return partial(_call, self._link(), sum(self.layout.result_sizes) // 8 + 1)

    def advance(self, pending: Sequence[Pending]) -> None:
        """Advance walks that orbits have requested, until one of them has ended."""
        for work in pending:
            if work.state is None:
                try:
                    work.state = Orbit.from_walk(self.layout, work.request)
                except OverflowError as error:
                    work.end(None, error)
                    return
        # The first has waited longest, and is always chosen. Of the others those with the most
        # steps left are: so that few orbits remain to be stepped alone at the end.
        longest = sorted(pending[1:], key=lambda work: -work.state.steps_left)
        chosen = [pending[0], *longest]
        chosen = (chosen if self.in_parts else _equally_far(chosen))[:LANES]
        # Compilation for lanes takes seconds; it repays only if many steps are expected.
        worth = self._expected_steps >= _MIN_STEPS_TO_COMPILE or self._no_need_to_compile
        lanes = self.lane_kernel if worth and len(chosen) >= _MIN_LANE_ORBITS else None
        if lanes is None:
            chosen = chosen[:1]
        kernel, orbits = lanes or self.orbit_kernel, [work.state for work in chosen]
        begin_time = time.perf_counter()  # after compilation, which is not counted
        step_together(orbits, kernel, LANES if lanes else 1)
        share = (time.perf_counter() - begin_time) / len(chosen)
        for work in chosen:
            work.seconds += share
            if work.state.has_ended:
                work.end(work.state.states)

    @cached_property
    def in_parts(self) -> bool:
        """True if m steps and then n have the bits of m + n: not if the source treats k = 0
        apart."""
        return "k == 0" not in self.source.text


def _equally_far(pending: Sequence[Pending]) -> list[Pending]:
    """Return the works whose next stop is as far as that of the first: stepped together, they reach
    every stop together."""
    distance = pending[0].state.steps_to_stop
    return [work for work in pending if work.state.steps_to_stop == distance]


def _call(linked: native.Native, size: int, arguments: Words) -> Words:
    results = np.empty((size, arguments.shape[1]), dtype=np.uint64)
    linked(arguments.ctypes.data, results.ctypes.data)
    return results
