"""A run of one kernel in chunks: the notes that it takes on the way, and its checkpoints.

A note has the coordinates and observables at one stop.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from itertools import takewhile
from typing import Any

from verify import observables
from verify.arithmetic.exact import decimal
from verify.arithmetic.number_system import Arithmetic, State, SystemNumber
from verify.arithmetic.systems.float64 import nearest_double
from verify.kernels.kernel import Kernel, clock_inputs, initial_remainder
from verify.kernels.last_in_range import last_good
from verify.kernels.notes import (
    LazyNote,
    Notes,
    ReachedPoint,
    RunningPoint,
    checkpoint_adapter,
)
from verify.kernels.run_changes import RunChanges
from verify.kernels.run_inputs import RunInputs
from verify.kernels.step import tangent_map
from verify.lockstep import Course, clock
from verify.scenes.results.run import SeriesPoint

Progress = Callable[[int], None]  # is called with the number of steps done
W_ENTRIES = "symplectic_defect_entries"  # a request to note the entries of W in `tangents`
_EXTREMES = ("dj_low", "dj_high", "lam_low", "lam_high")


class ChunkedLoop:
    """A run with one kernel, from its start or from the last checkpoint."""

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
        # The order is that of the kernel's signature: h, parameters, scales, limits, clock.
        self.fixed: list[SystemNumber] = [number(x) for x in run.inputs(kernel, shift).values()]
        self.fixed += [shift] if kernel.scales else []
        self.fixed += [number(x) for x in limits]
        if kernel.timed:
            self.fixed += [number(x) for x in clock_inputs(arithmetic, run.start).values()]
        # If H is periodic in t, whole periods are taken off t before every chunk: a fixed-point t
        # would leave its format.
        self.turns = run.turns(arithmetic)
        self._observables = {each.name: each for each in observables.select(run.observables)}
        self._changes = RunChanges(run, arithmetic, [*self._observables.values()], shift)
        self.state: State = self._first_state()
        self._position = {name: k for k, name in enumerate(kernel.state_names)}
        self._extreme = [name for name in _EXTREMES if name in self._position]
        self._note_names = (*kernel.coordinates, *sorted(self._observables))
        self._form = [n for n in kernel.state_names if n[:2] == "w_" and f"d{n}" in kernel.outputs]
        tangent_names = tangent_map.names_of(kernel.coordinates)
        carried_names = (*(name for name in tangent_names if name in self._position), "done")
        self._tangent = carried_names if "growth" in self._position else ()
        self._tangent += tuple(self._form) if W_ENTRIES in run.observables else ()
        self._tangent += self._changes.parts(kernel.matrix) if self._tangent else ()
        self._restart: dict[int, float] = {}
        if run.restarts and self._tangent:
            self._tangent += tangent_map.entries_of(kernel.coordinates)
            first = tangent_map.initial_values(kernel.coordinates, kernel.canonical)
            self._restart = {self._position[n]: float(x) for n, x in first if isinstance(x, int)}
        self._doubles = [k for k, x in enumerate(self.state) if isinstance(x, float)]
        self.section = run.section
        # The label identifies the run: a checkpoint with another label is ignored, since its
        # numbers would have other bits.
        kinds = f"{arithmetic.name} {arithmetic.bits} {shift} {' '.join(kernel.state_names)}"
        inputs = (run.start, run.parameters, run.scheme, run.steps, run.points)
        self._label = f"{kinds} {' '.join(map(str, limits))} {inputs}"
        checkpoint = run.keeper.load(self._label)
        resumed = ReachedPoint() if checkpoint is None else self._restore(checkpoint)
        self.done, self.seconds = resumed.done, resumed.seconds
        notes = Notes(resumed.trail), Notes(resumed.tangents), Notes(resumed.series)
        reached = resumed.done, resumed.seconds, resumed.state, resumed.seen
        self._latest = RunningPoint(*reached, *notes)

    def _first_state(self) -> State:
        start = self.run.start | self._changes.start
        number = partial(self.run.start_number, self.arithmetic)
        if self.kernel.timed:
            start = start | self._clock_after(0)
        state: list[SystemNumber] = []
        start_names = (*self.kernel.coordinates, *self.kernel.start)
        for kind, source in zip(self.kernel.kinds, start_names, strict=True):
            value = start[source] if isinstance(source, str) else Fraction(source)
            state.append(nearest_double(value) if kind == "float" else number(source, value))
        return tuple(state)

    def _clock_after(self, steps: int) -> dict[str, Fraction]:
        """Return the start values of the kernel's clock after `steps` steps."""
        t = self.run.start["t"] + steps * self.run.start["h"]
        t = self.turns.time(t, self.arithmetic) if self.turns else t
        return {"t": t} | initial_remainder(self.arithmetic, t)

    def _state_in_first_period(self) -> State:
        """Return the state with whole periods of H taken off t."""
        state, clock = list(self.state), self._clock_after(self.done)
        for index, source in enumerate(self.kernel.start, start=len(self.kernel.coordinates)):
            if isinstance(source, str) and source in clock:
                state[index] = self.arithmetic.number(clock[source])
        return tuple(state)

    # -- steps --------------------------------------------------------------------------------

    def run_to_end(self, goes_on: Callable[[int], bool] = lambda _: True) -> Course[bool]:
        """Step to the end, or until a number leaves the arithmetic's range; `done` is then the
        number of steps that stayed in it.

        `goes_on(steps done)` is called after every stop. Return False if it does, else True.
        """
        run = self.run
        self.arithmetic.expect(self.kernel.function, run.steps - self.done)
        # A call with 0 steps compiles the kernel, so that `seconds` is the time of the steps alone.
        yield from self._advance(0)
        while self.done < run.steps:
            every, stops = self._next_stops()
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
            # Within the next `every` steps a number leaves the range.
            if len(states) < stops:
                self.done += yield from last_good(every, self._advance)
                return True
        return True

    def _next_stops(self) -> tuple[int, int]:
        """Return the number of steps from stop to stop, and the number of stops in one call:
        several stops are the next notes; one is the next note, or a chunk on the way to it."""
        to_note, chunk = self.section - self.done % self.section, self.arithmetic.chunk
        chunk = min(chunk, self.turns.steps) if self.turns else chunk
        remaining = self.run.steps - self.done
        # The first note is the only stop of its call: the run may end there. So is each at which
        # the tangent map begins anew.
        is_next = to_note == self.section and not self._restart
        if self.done and is_next and 2 * self.section <= min(chunk, remaining):
            return self.section, min(chunk, remaining) // self.section
        return min(chunk, to_note, remaining), 1

    def _advance(self, every: int, stops: int = 1) -> Course[list[State]]:
        """Return the states at the next stops; fewer if a number left the arithmetic's range."""
        state = self._state_in_first_period() if self.turns else self.state
        remaining = self.run.steps - self.done - every * stops
        states = yield from self.arithmetic.states(
            self.kernel.function, every, stops, self.fixed, state, remaining
        )
        return list(takewhile(self._finite, states))

    def _finite(self, state: State) -> bool:
        """Return True if all doubles of the state are finite."""
        return all(map(math.isfinite, map(state.__getitem__, self._doubles)))

    # -- notes --------------------------------------------------------------------------------

    @property
    def current(self) -> ReachedPoint:
        """All that has been noted so far."""
        point = self._latest
        notes = tuple(point.trail), tuple(point.tangents), tuple(point.series)
        return ReachedPoint(point.done, point.seconds, point.state, point.seen, *notes)

    def _note(self) -> None:
        """Note the state. All notes are replaced at once, since an interruption may come at any
        moment."""
        previous, state, done = self._latest, self.state, self.done
        # The tuple is complete before it is assigned to `_latest`: a KeyboardInterrupt in between
        # leaves the old, consistent notes.
        seen = self._extremes(state) if self._extreme else {}
        trail, tangents, series = previous.trail, previous.tangents, previous.series
        if done % self.section == 0 or done == self.run.steps:
            if self._tangent:
                note = LazyNote(self._tangent, self._tangent_value, state, done)
                tangents = tangents.and_then(note)
            if seen:
                series = series.and_then(self._point(len(trail) * self.section + 1, seen))
                seen = {}
            trail = trail.and_then(LazyNote(self._note_names, self._exact_value, state, done))
            self.state = tuple(self._restart.get(k, x) for k, x in enumerate(state))
        self._latest = RunningPoint(done, self.seconds, state, seen, trail, tangents, series)

    def _extremes(self, state: State) -> dict[str, Fraction]:
        """Return the extremes of ΔJ and Λ since the last note."""
        extremes = dict(self._latest.seen)
        radius = self.arithmetic.radius or (lambda _: Fraction(0))
        for name in self._extreme:
            x, low = state[self._position[name]], name.endswith("low")
            # A ball counts with its outer end, so that the extremes enclose the true ones.
            end = self._exact(x) - radius(x) if low else self._exact(x) + radius(x)
            extremes[name] = (min if low else max)(end, extremes.get(name, end))
        return extremes

    def _tangent_value(self, name: str, state: State, done: int) -> Fraction:
        """Return one number of the tangent map's notes, as an exact rational."""
        if name in self._form:
            return self._unscale(1, self._total(name, state, self._exact))
        return Fraction(done) if name == "done" else self._exact(state[self._position[name]])

    def _exact_value(self, name: str, state: State, done: int) -> Fraction:
        """Return a coordinate or an observable after the steps done, as an exact rational."""
        if name in self._changes.observables:
            return self._change(name, state, done)[0]
        value = self._observe(name, state, done, self._exact)
        return value - self._observables[name].begins if name in self._observables else value

    def _observe(
        self, name: str, state: State, done: int, convert: Callable[[SystemNumber], Fraction]
    ) -> Fraction:
        """Return a coordinate or an observable of the carried numbers (or of their radii, by
        `convert`), without its initial value `begins` subtracted."""
        if name not in self._observables:
            return self._total(name, state, convert)
        observable = self._observables[name]
        carried = self._form if observable.carried == "w_" else [observable.carried]
        # W has several accumulators, others one, of the value times 2^(run's · observable's shift).
        totals = (self._total(entry, state, convert) for entry in carried)
        return observable.read([self._unscale(observable.shift, x) for x in totals], done)

    def _change(self, name: str, state: State, done: int) -> tuple[Fraction, Fraction]:
        """Return the change of a function of the state, and how far it may be off."""
        radius = self.arithmetic.radius or (lambda _: Fraction(0))
        parts = (partial(self._total, state=state, convert=x) for x in (self._exact, radius))
        return self._changes.change(name, done, *parts)

    def _total(
        self, name: str, state: State, convert: Callable[[SystemNumber], Fraction]
    ) -> Fraction:
        """Return the carried number of that name, plus its remainder in a compensated kernel."""
        total = convert(state[self._position[name]])
        if (rest := f"{name}_rest") in self._position:
            total += convert(state[self._position[rest]])
        return total

    def _exact(self, x: SystemNumber) -> Fraction:
        return Fraction(x) if isinstance(x, float) else self.arithmetic.exact(x)

    def _unscale(self, times: int, value: Fraction) -> Fraction:
        scale = self.shift * times
        return value / (1 << scale) if scale else value

    def radii(self) -> dict[str, Fraction]:
        """Return the radii of the last values; empty without enclosures or after an early end."""
        radius = self.arithmetic.radius
        if radius is None or self.done < self.run.steps:
            return {}
        state, done = self.state, self.done
        changes = {n: self._change(n, state, done)[1] for n in self._changes.observables}
        names = (n for n in self._note_names if n not in changes)
        return {n: self._observe(n, state, done, radius) for n in names} | changes

    def _point(self, first: int, seen: Mapping[str, Fraction]) -> SeriesPoint:
        def pair(name: str) -> tuple[str, str]:
            ends = (seen[f"{name}_{end}"] for end in ("low", "high"))
            low, high = (self._unscale(1, x) for x in ends)
            return decimal(low, 7), decimal(high, 7)

        return SeriesPoint(first=first, last=self.done, delta_j=pair("dj"), lam=pair("lam"))

    # -- checkpoints --------------------------------------------------------------------------

    def keep(self) -> None:
        """Write a checkpoint, from which the run can go on with the same bits."""
        # Runs in balls have no checkpoints, as these hold no radii; such runs are short.
        if self.arithmetic.radius is None and self._latest.done:
            self.run.keeper.save(
                self._label, checkpoint_adapter().dump_python(self._evaluate_notes(), mode="json")
            )

    def _evaluate_notes(self) -> ReachedPoint:
        """Return the notes with all their numbers evaluated."""
        reached = self.current
        state = tuple(self._exact(x) for x in reached.state)
        trail, tangents = tuple(map(dict, reached.trail)), tuple(map(dict, reached.tangents))
        return replace(reached, state=state, trail=trail, tangents=tangents)

    def _restore(self, checkpoint: Mapping[str, Any]) -> ReachedPoint:
        """Set the state from a checkpoint, and return its point."""
        reached = checkpoint_adapter().validate_python(checkpoint)
        self.state = tuple(
            float(x) if kind == "float" else self.arithmetic.number(x)
            for kind, x in zip(self.kernel.kinds, reached.state, strict=True)
        )
        return reached
