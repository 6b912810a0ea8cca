"""Kernels in fixed point as native functions: one orbit at a time, or several in lanes."""

import ctypes
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, lru_cache, partial
from operator import itemgetter
from typing import Any

import numpy as np

from verify.arithmetic.compiled import native, paths
from verify.arithmetic.compiled.translation import Fixed as Fixed
from verify.arithmetic.compiled.translation import Source, Word
from verify.arithmetic.compiled.walking import Orbit, Words, step_together
from verify.arithmetic.processor import LANES
from verify.lockstep import Pending

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
