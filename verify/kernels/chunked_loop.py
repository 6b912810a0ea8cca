"""One kernel's loop in chunks, what is noted on the way, and its checkpoints."""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cache
from typing import Annotated, Any

from pydantic import PlainSerializer, PlainValidator, TypeAdapter

from verify.arithmetic.exact import decimal
from verify.arithmetic.number import Number
from verify.arithmetic.number_system import Arithmetic
from verify.execution.keeping import fraction_of, fraction_text
from verify.kernels import tangent_map
from verify.kernels.kernel import Kernel
from verify.kernels.run_inputs import RunInputs
from verify.scenes.results.run import SeriesPoint

Progress = Callable[[int], None]  # called with the number of steps done
State = tuple[Number, ...]
_ACCUMULATORS = {"lambda": "lam", "lambda_max": "lam_top", "mse": "mse", "delta_j_max": "top",
                 "lambda_plain": "plain"}  # fmt: skip
# Powers of the 2^s that the kernel carries.
_SCALED = {"lam": 1, "lam_top": 1, "mse": 2, "top": 1, "dj": 1}
_EXTREMES = ("dj_low", "dj_high", "lam_low", "lam_high")
Exact = Annotated[Fraction, PlainValidator(fraction_of), PlainSerializer(fraction_text)]
Note = dict[str, Exact]


@dataclass(frozen=True)
class Reached:
    """Where a run is after some chunks and their notes, which is all that a checkpoint keeps.

    `trail` has p, q and the observables at points on the way and at the last step done, as the
    exact rationals that they are; `tangents` what `verify.kernels.tangent_map.NAMES` names, at the
    same points. `state`: all that is carried; `seen`: extremes since the last note.
    """

    done: int = 0
    seconds: float = 0.0
    state: tuple[Exact, ...] = ()
    seen: Note = field(default_factory=dict)
    trail: tuple[Note, ...] = ()
    tangents: tuple[Note, ...] = ()
    series: tuple[SeriesPoint, ...] = ()


@cache
def _kept() -> TypeAdapter[Reached]:
    return TypeAdapter(Reached)


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
        self.state = self._first_state()
        self.section = -(-run.steps // run.sections)  # steps between two notes
        kinds = f"{arithmetic.name} {arithmetic.bits} {shift} {' '.join(kernel.state_names)}"
        inputs = (run.start, run.parameters, run.scheme, run.steps, run.points)
        self._label = f"{kinds} {' '.join(map(str, limits))} {inputs}"
        kept = run.keeper.load(self._label)
        self.reached = Reached() if kept is None else self._restored(kept)
        self.done, self.seconds = self.reached.done, self.reached.seconds

    def _first_state(self) -> State:
        start, number = self.run.start, self.arithmetic.number
        state = [number(start["p"]), number(start["q"])]
        for kind, first in zip(self.kernel.kinds[2:], self.kernel.start, strict=True):
            value = start[first] if isinstance(first, str) else Fraction(first)
            state.append(tangent_map.nearest_double(value) if kind == "float" else number(value))
        return tuple(state)

    # -- steps --------------------------------------------------------------------------------

    def chunks(self) -> Iterator[int]:
        """Steps to the end, and tells the steps done after every chunk; ends early where a number
        left the arithmetic's range, with `done` the steps that stayed in it."""
        run = self.run
        self._advance(0)  # compiles: `seconds` is the stepping alone
        while self.done < run.steps:
            left = self.section - self.done % self.section
            count = min(self.arithmetic.chunk, left, run.steps - self.done)
            begun = time.perf_counter()
            after = self._advance(count)
            self.seconds += time.perf_counter() - begun
            if after is None:
                self.done += self._last_good(count)
                return
            self.state, self.done = after, self.done + count
            self._note()
            yield self.done
            if run.keeper.due(self._label):
                self.keep()

    def _advance(self, count: int) -> State | None:
        """The state after `count` steps, or None where a number left the arithmetic's range."""
        try:
            with self.arithmetic.context():
                done, *after = self.kernel.function(count, *self.fixed, *self.state)
        except (ArithmeticError, ValueError):  # not float64: a pole, the log or root of a negative
            return None
        if done < count or not all(map(self._finite, after)):
            return None
        return tuple(after)

    def _finite(self, x: Number) -> bool:
        return x - x == 0 if isinstance(x, float) else self.arithmetic.finite(x)

    def _last_good(self, count: int) -> int:
        """The greatest number of steps below `count` that stays in range, by bisection."""
        good, bad = 0, count
        while bad - good > 1:
            middle = (good + bad) // 2
            if self._advance(middle) is None:
                bad = middle
            else:
                good = middle
        return good

    # -- what is noted ------------------------------------------------------------------------

    def _note(self) -> None:
        """Takes up the state. It is taken up whole: an interruption may come amid this."""
        raw = {n: self._exact(x) for n, x in zip(self.kernel.state_names, self.state, strict=True)}
        before, seen = self.reached, self._extremes(raw)
        after = replace(before, done=self.done, seconds=self.seconds, state=tuple(raw.values()),
                        seen=seen)  # fmt: skip
        if self.done % self.section == 0 or self.done == self.run.steps:
            tangents, series = before.tangents, before.series
            if "growth" in raw:
                known = {name: raw[name] for name in tangent_map.NAMES if name in raw}
                tangents += (known | {"done": Fraction(self.done)},)
            if seen:
                series += (self._point(len(before.trail) * self.section + 1, seen),)
            trail = (*before.trail, self._finals(raw))
            after = replace(after, seen={}, trail=trail, tangents=tangents, series=series)
        self.reached = after

    def _extremes(self, raw: Mapping[str, Fraction]) -> dict[str, Fraction]:
        """Those since the last note."""
        radius, found = self.arithmetic.radius or (lambda _: Fraction(0)), dict(self.reached.seen)
        for name, x in zip(self.kernel.state_names, self.state, strict=True):
            if name in _EXTREMES:
                low = name.endswith("low")
                end = raw[name] - radius(x) if low else raw[name] + radius(x)
                found[name] = (min if low else max)(end, found.get(name, end))
        return found

    def _exact(self, x: Number) -> Fraction:
        return Fraction(x) if isinstance(x, float) else self.arithmetic.exact(x)

    def _unscaled(self, name: str, value: Fraction) -> Fraction:
        scale = self.shift * _SCALED.get(name, 0)
        return value / (1 << scale) if scale else value

    def _finals(self, raw: dict[str, Fraction]) -> dict[str, Fraction]:
        """p, q and the observables after the steps done, as the exact rationals that they are."""
        result = self._observed(raw)
        if "lambda_plain" in result:
            result["lambda_plain"] -= 1
        return result

    def _observed(self, raw: dict[str, Fraction]) -> dict[str, Fraction]:
        """The same of what is carried, or of its radii; Π det J as it is."""
        total = {n: x + raw[rest] if (rest := f"{n}_rest") in raw else x for n, x in raw.items()}
        result = {"p": total["p"], "q": total["q"]}
        for name in self.run.observables & set(_ACCUMULATORS):
            carried = _ACCUMULATORS[name]
            result[name] = self._unscaled(carried, total[carried])
        if "mse" in result:
            result["mse"] /= self.done
        return result

    def radii(self) -> dict[str, Fraction]:
        """How far the last values may be from the true ones, where numbers are enclosures."""
        radius = self.arithmetic.radius
        if radius is None or self.done < self.run.steps:
            return {}
        names = self.kernel.state_names
        return self._observed({n: radius(x) for n, x in zip(names, self.state, strict=True)})

    def _point(self, first: int, seen: Mapping[str, Fraction]) -> SeriesPoint:
        def pair(name: str) -> tuple[str, str]:
            ends = (seen[f"{name}_{end}"] for end in ("low", "high"))
            low, high = (self._unscaled(name, x) for x in ends)
            return decimal(low, 7), decimal(high, 7)

        return SeriesPoint(first=first, last=self.done, delta_j=pair("dj"), lam=pair("lam"))

    # -- checkpoints --------------------------------------------------------------------------

    def keep(self) -> None:
        """Writes a checkpoint: all that is needed to go on with the same bits."""
        # A ball's radius is not kept; such runs are short.
        if self.arithmetic.radius is None and self.reached.done:
            self.run.keeper.save(self._label, _kept().dump_python(self.reached, mode="json"))

    def _restored(self, kept: Mapping[str, Any]) -> Reached:
        found = _kept().validate_python(kept)
        self.state = tuple(
            float(x) if kind == "float" else self.arithmetic.number(x)
            for kind, x in zip(self.kernel.kinds, found.state, strict=True)
        )
        return found
