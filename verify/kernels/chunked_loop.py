"""One kernel's loop in chunks, what is noted on the way, and its checkpoints."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cache
from itertools import takewhile
from typing import Annotated, Any, NamedTuple

from pydantic import PlainSerializer, PlainValidator, TypeAdapter

from verify import observables
from verify.arithmetic.exact import decimal
from verify.arithmetic.number import Number
from verify.arithmetic.number_system import Arithmetic, State
from verify.arithmetic.systems.float64 import nearest_double
from verify.execution.keeping import fraction_of, fraction_text
from verify.kernels.clock import clock_inputs, first_rest
from verify.kernels.kernel import Kernel
from verify.kernels.notes import LazyNote, Notes
from verify.kernels.run_inputs import RunInputs
from verify.kernels.step import tangent_map
from verify.lockstep import Course, clock
from verify.scenes.results.run import SeriesPoint

Progress = Callable[[int], None]  # called with the number of steps done
ENTRIES = "symplectic_defect_entries"  # with it W's own entries are noted in `tangents`
_EXTREMES = ("dj_low", "dj_high", "lam_low", "lam_high")
Exact = Annotated[Fraction, PlainValidator(fraction_of), PlainSerializer(fraction_text)]
Note = Mapping[str, Fraction]


@dataclass(frozen=True)
class Reached:
    """Where a run is after some chunks and their notes, which is all that a checkpoint keeps.

    `trail` has p, q and the observables at points on the way and at the last step done, as the
    exact rationals that they are; `tangents` what `verify.kernels.step.tangent_map` notes, at the
    same points, with the entries of W (`w_a_b`, a < b) where `ENTRIES` are asked for. `state`: all
    that is carried; `seen`: extremes since the last note.
    """

    done: int = 0
    seconds: float = 0.0
    state: Sequence[Exact] = ()
    seen: dict[str, Exact] = field(default_factory=dict)
    trail: tuple[Mapping[str, Exact], ...] = ()
    tangents: tuple[Mapping[str, Exact], ...] = ()
    series: tuple[SeriesPoint, ...] = ()


class _Now(NamedTuple):
    """`Reached` while the loop goes on."""

    done: int
    seconds: float
    state: State
    seen: dict[str, Fraction]
    trail: Notes[Mapping[str, Fraction]]
    tangents: Notes[Mapping[str, Fraction]]
    series: Notes[SeriesPoint]


@cache
def _kept() -> TypeAdapter[Reached]:
    return TypeAdapter(Reached)


def last_good(count: int, advance: Callable[[int], Course[Sequence[object]]]) -> Course[int]:
    """The greatest number of steps below `count` that stays in range, by bisection; where one does
    not, there are no states when it is advanced by so many."""
    good, bad = 0, count
    while bad - good > 1:
        middle = (good + bad) // 2
        if (yield from advance(middle)):
            good = middle
        else:
            bad = middle
    return good


class ChunkedLoop:
    """Does a run with one kernel from its start, or from where a checkpoint was kept."""

    def __init__(
        self,
        run: RunInputs,
        kernel: Kernel,
        arithmetic: Arithmetic,
        limits: Sequence[Fraction],
        shift: int,
    ) -> None:
        self.run, self.kernel, self.arithmetic, self.shift = run, kernel, arithmetic, shift
        number = arithmetic.number
        self.fixed: list[Number] = [number(x) for x in run.inputs(kernel, shift).values()]
        self.fixed += [shift] if kernel.scales else []
        self.fixed += [number(x) for x in limits]
        if kernel.timed:
            self.fixed += [number(x) for x in clock_inputs(arithmetic, run.start).values()]
        self.turns = run.turns(arithmetic)
        self.state: State = self._first_state()
        self._at = {name: k for k, name in enumerate(kernel.state_names)}
        self._extreme = [name for name in _EXTREMES if name in self._at]
        asked = sorted(run.observables & observables.by_name().keys())
        self._observables = {name: observables.by_name()[name] for name in asked}
        self._noted = (*kernel.coordinates, *asked)
        self._form = [
            name
            for name in kernel.state_names
            if f"d{name}" in kernel.outputs and name.startswith("w_")
        ]
        noted = tangent_map.names_of(kernel.coordinates)
        known = (*(name for name in noted if name in self._at), "done")
        self._tangent = known if "growth" in self._at else ()
        self._tangent += tuple(self._form) if ENTRIES in run.observables else ()
        self._doubles = [k for k, x in enumerate(self.state) if isinstance(x, float)]
        self.section = run.section
        kinds = f"{arithmetic.name} {arithmetic.bits} {shift} {' '.join(kernel.state_names)}"
        inputs = (run.start, run.parameters, run.scheme, run.steps, run.points)
        self._label = f"{kinds} {' '.join(map(str, limits))} {inputs}"
        kept = run.keeper.load(self._label)
        begun = Reached() if kept is None else self._restored(kept)
        self.done, self.seconds = begun.done, begun.seconds
        notes = Notes(begun.trail), Notes(begun.tangents), Notes(begun.series)
        self._now = _Now(begun.done, begun.seconds, begun.state, begun.seen, *notes)

    def _first_state(self) -> State:
        start, number = self.run.start, self.arithmetic.number
        if self.kernel.timed:
            start = start | self._clock_after(0)
        state: list[Number] = []
        carried = (*self.kernel.coordinates, *self.kernel.start)
        for kind, first in zip(self.kernel.kinds, carried, strict=True):
            value = start[first] if isinstance(first, str) else Fraction(first)
            state.append(nearest_double(value) if kind == "float" else number(value))
        return tuple(state)

    def _clock_after(self, done: int) -> dict[str, Fraction]:
        """What the kernel's clock starts with after so many steps."""
        t = self.run.start["t"] + done * self.run.start["h"]
        t = self.turns.time(t, self.arithmetic) if self.turns else t
        return {"t": t} | first_rest(self.arithmetic, t)

    def _turned_back(self) -> State:
        """The state with whole periods of H taken off t."""
        state, clock = list(self.state), self._clock_after(self.done)
        for at, first in enumerate(self.kernel.start, start=len(self.kernel.coordinates)):
            if isinstance(first, str) and first in clock:
                state[at] = self.arithmetic.number(clock[first])
        return tuple(state)

    # -- steps --------------------------------------------------------------------------------

    def to_end(self, goes_on: Callable[[int], bool] = lambda _: True) -> Course[bool]:
        """Steps to the end; ends early where a number left the arithmetic's range, with `done` the
        steps that stayed in it. `goes_on` is told the steps done after every chunk, and says
        whether to go on: False where it said no."""
        run = self.run
        self.arithmetic.expect(self.kernel.function, run.steps - self.done)
        yield from self._advance(0)  # compiles: `seconds` is the stepping alone
        while self.done < run.steps:
            every, stops = self._ahead()
            begun = clock()
            states = yield from self._advance(every, stops)
            self.seconds += clock() - begun
            for state in states:
                self.state, self.done = state, self.done + every
                self._note()
                if not goes_on(self.done):
                    return False
                if run.keeper.due(self._label):
                    self.keep()
            if len(states) < stops:
                self.done += yield from last_good(every, self._advance)
                return True
        return True

    def _ahead(self) -> tuple[int, int]:
        """So many steps to the next stop, and so many stops: to a note or to some, or on the way to
        the next where that is far."""
        left, chunk = self.section - self.done % self.section, self.arithmetic.chunk
        chunk = min(chunk, self.turns.steps) if self.turns else chunk
        rest = self.run.steps - self.done
        # The first note is made by itself, since a run may be asked there whether to go on.
        if self.done and left == self.section and 2 * self.section <= min(chunk, rest):
            return self.section, min(chunk, rest) // self.section
        return min(chunk, left, rest), 1

    def _advance(self, every: int, stops: int = 1) -> Course[list[State]]:
        """The states at the next stops; fewer where a number left the arithmetic's range."""
        kernel = self.kernel.function
        state = self._turned_back() if self.turns else self.state
        beyond = self.run.steps - self.done - every * stops
        found = yield from self.arithmetic.states(kernel, every, stops, self.fixed, state, beyond)
        return list(takewhile(self._finite, found))

    def _finite(self, state: State) -> bool:
        return all(map(math.isfinite, map(state.__getitem__, self._doubles)))

    # -- what is noted ------------------------------------------------------------------------

    @property
    def reached(self) -> Reached:
        """All that was taken up so far."""
        now = self._now
        noted = tuple(now.trail), tuple(now.tangents), tuple(now.series)
        return Reached(now.done, now.seconds, now.state, now.seen, *noted)

    def _note(self) -> None:
        """Takes up the state. It is taken up whole: an interruption may come amid this."""
        before, state, done = self._now, self.state, self.done
        seen = self._extremes(state) if self._extreme else {}
        trail, tangents, series = before.trail, before.tangents, before.series
        if done % self.section == 0 or done == self.run.steps:
            if self._tangent:
                carried = LazyNote(self._tangent, self._of_tangent, state, done)
                tangents = tangents.and_then(carried)
            if seen:
                series = series.and_then(self._point(len(trail) * self.section + 1, seen))
                seen = {}
            trail = trail.and_then(LazyNote(self._noted, self._final, state, done))
        self._now = _Now(done, self.seconds, state, seen, trail, tangents, series)

    def _extremes(self, state: State) -> dict[str, Fraction]:
        """Those since the last note."""
        radius, found = self.arithmetic.radius or (lambda _: Fraction(0)), dict(self._now.seen)
        for name in self._extreme:
            x, low = state[self._at[name]], name.endswith("low")
            end = self._exact(x) - radius(x) if low else self._exact(x) + radius(x)
            found[name] = (min if low else max)(end, found.get(name, end))
        return found

    def _of_tangent(self, name: str, state: State, done: int) -> Fraction:
        if name in self._form:
            return self._unscaled(1, self._total(name, state, self._exact))
        return Fraction(done) if name == "done" else self._exact(state[self._at[name]])

    def _final(self, name: str, state: State, done: int) -> Fraction:
        """p, q or an observable after the steps done, as the exact rational that it is."""
        value = self._observed(name, state, done, self._exact)
        return value - self._observables[name].begins if name in self._observables else value

    def _observed(
        self, name: str, state: State, done: int, of: Callable[[Number], Fraction]
    ) -> Fraction:
        """The same of what is carried, or of its radii, with what it began with."""
        if name not in self._observables:
            return self._total(name, state, of)
        each = self._observables[name]
        carried = self._form if each.carried == "w_" else [each.carried]
        totals = (self._total(entry, state, of) for entry in carried)
        return each.read([self._unscaled(each.shift, total) for total in totals], done)

    def _total(self, carried: str, state: State, of: Callable[[Number], Fraction]) -> Fraction:
        """What is carried under a name, with what a compensated kernel carries beside it."""
        total = of(state[self._at[carried]])
        if (rest := f"{carried}_rest") in self._at:
            total += of(state[self._at[rest]])
        return total

    def _exact(self, x: Number) -> Fraction:
        return Fraction(x) if isinstance(x, float) else self.arithmetic.exact(x)

    def _unscaled(self, times: int, value: Fraction) -> Fraction:
        scale = self.shift * times
        return value / (1 << scale) if scale else value

    def radii(self) -> dict[str, Fraction]:
        """How far the last values may be from the true ones, where numbers are enclosures."""
        radius = self.arithmetic.radius
        if radius is None or self.done < self.run.steps:
            return {}
        state, done = self.state, self.done
        return {n: self._observed(n, state, done, radius) for n in self._noted}

    def _point(self, first: int, seen: Mapping[str, Fraction]) -> SeriesPoint:
        def pair(name: str) -> tuple[str, str]:
            ends = (seen[f"{name}_{end}"] for end in ("low", "high"))
            low, high = (self._unscaled(1, x) for x in ends)
            return decimal(low, 7), decimal(high, 7)

        return SeriesPoint(first=first, last=self.done, delta_j=pair("dj"), lam=pair("lam"))

    # -- checkpoints --------------------------------------------------------------------------

    def keep(self) -> None:
        """Writes a checkpoint: all that is needed to go on with the same bits."""
        # A ball's radius is not kept; such runs are short.
        if self.arithmetic.radius is None and self._now.done:
            self.run.keeper.save(self._label, _kept().dump_python(self._whole(), mode="json"))

    def _whole(self) -> Reached:
        """What is reached, with all its numbers made."""
        own = self.reached
        state = tuple(self._exact(x) for x in own.state)
        trail, tangents = tuple(map(dict, own.trail)), tuple(map(dict, own.tangents))
        return replace(own, state=state, trail=trail, tangents=tangents)

    def _restored(self, kept: Mapping[str, Any]) -> Reached:
        found = _kept().validate_python(kept)
        self.state = tuple(
            float(x) if kind == "float" else self.arithmetic.number(x)
            for kind, x in zip(self.kernel.kinds, found.state, strict=True)
        )
        return found
