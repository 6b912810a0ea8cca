"""One kernel's loop in chunks, what is noted on the way, and its checkpoints."""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Any

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
_SCALED = {
    "lam": 1,
    "lam_top": 1,
    "mse": 2,
    "top": 1,
    "dj": 1,
}  # powers of the 2^s that the kernel carries
_EXTREMES = ("dj_low", "dj_high", "lam_low", "lam_high")


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
        self.done, self.seconds = 0, 0.0
        self.trail: list[dict[str, Fraction]] = []
        self.tangents: list[dict[str, Fraction]] = []
        self.series: list[SeriesPoint] = []
        self._seen: dict[str, Fraction] = {}  # extremes since the last note
        kinds = f"{arithmetic.name} {arithmetic.bits} {shift} {' '.join(kernel.state_names)}"
        inputs = (run.start, run.parameters, run.scheme, run.steps, run.points)
        self._label = f"{kinds} {' '.join(map(str, limits))} {inputs}"
        self._restore(run.keeper.load(self._label))
        self._sound = self._mark()

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
            self._sound = self._mark()
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
        raw = {n: self._exact(x) for n, x in zip(self.kernel.state_names, self.state, strict=True)}
        radius = self.arithmetic.radius or (lambda _: Fraction(0))
        for name, x in zip(self.kernel.state_names, self.state, strict=True):
            if name in _EXTREMES:
                low = name.endswith("low")
                end = raw[name] - radius(x) if low else raw[name] + radius(x)
                self._seen[name] = (min if low else max)(end, self._seen.get(name, end))
        if self.done % self.section and self.done < self.run.steps:
            return
        self.trail.append(self._finals(raw))
        if "growth" in raw:
            seen = {name: raw[name] for name in tangent_map.NAMES if name in raw}
            self.tangents.append(seen | {"done": Fraction(self.done)})
        if self._seen:
            first = (len(self.trail) - 1) * self.section + 1
            self.series.append(self._point(first))
            self._seen = {}

    def _exact(self, x: Number) -> Fraction:
        return Fraction(x) if isinstance(x, float) else self.arithmetic.exact(x)

    def _unscaled(self, name: str, value: Fraction) -> Fraction:
        return value / (1 << self.shift * _SCALED.get(name, 0))

    def _finals(self, raw: dict[str, Fraction]) -> dict[str, Fraction]:
        """p, q and the observables after the steps done, as the exact rationals that they are."""
        total = {n: x + raw.get(f"{n}_rest", 0) for n, x in raw.items()}
        result = {"p": total["p"], "q": total["q"]}
        for name in self.run.observables & set(_ACCUMULATORS):
            carried = _ACCUMULATORS[name]
            result[name] = self._unscaled(carried, total[carried])
        if "mse" in result:
            result["mse"] /= self.done
        if "lambda_plain" in result:
            result["lambda_plain"] -= 1
        return result

    def radii(self) -> dict[str, Fraction]:
        """How far the last values may be from the true ones, where numbers are enclosures."""
        radius = self.arithmetic.radius
        if radius is None or self.done < self.run.steps:
            return {}
        raw = {n: radius(x) for n, x in zip(self.kernel.state_names, self.state, strict=True)}
        names = self.run.observables & set(_ACCUMULATORS)
        found = {"p": raw["p"], "q": raw["q"]} | {n: raw[_ACCUMULATORS[n]] for n in names}
        if "mse" in found:
            found["mse"] /= self.done
        return found

    def _point(self, first: int) -> SeriesPoint:
        def pair(name: str) -> tuple[str, str]:
            ends = (self._seen[f"{name}_{end}"] for end in ("low", "high"))
            low, high = (self._unscaled(name, x) for x in ends)
            return decimal(low, 7), decimal(high, 7)

        return SeriesPoint(first=first, last=self.done, delta_j=pair("dj"), lam=pair("lam"))

    # -- checkpoints --------------------------------------------------------------------------

    def keep(self) -> None:
        """Writes a checkpoint: all that is needed to go on with the same bits."""
        if self.arithmetic.radius is not None:
            return  # a ball's radius is not kept; such runs are short
        done, seconds, state, seen, (trail, tangents, series) = self._sound
        data = {
            "done": done,
            "seconds": seconds,
            "state": [fraction_text(self._exact(x)) for x in state],
            "seen": _texts(seen),
            "trail": list(map(_texts, self.trail[:trail])),
            "tangents": list(map(_texts, self.tangents[:tangents])),
            "series": [point.model_dump(mode="json") for point in self.series[:series]],
        }
        self.run.keeper.save(self._label, data)

    def _mark(self) -> tuple[int, float, State, dict[str, Fraction], tuple[int, ...]]:
        """Where the run is after a chunk and its notes; an interruption may come amid them."""
        notes = len(self.trail), len(self.tangents), len(self.series)
        return self.done, self.seconds, self.state, dict(self._seen), notes

    def _restore(self, kept: Mapping[str, Any] | None) -> None:
        if kept is None:
            return
        self.done, self.seconds = kept["done"], kept["seconds"]
        number, kinds = self.arithmetic.number, self.kernel.kinds
        values = [fraction_of(x) for x in kept["state"]]
        self.state = tuple(
            float(x) if kind == "float" else number(x)
            for kind, x in zip(kinds, values, strict=True)
        )
        self._seen = _fractions(kept["seen"])
        self.trail = list(map(_fractions, kept["trail"]))
        self.tangents = list(map(_fractions, kept["tangents"]))
        self.series = [SeriesPoint.model_validate(point) for point in kept["series"]]


def _texts(note: Mapping[str, Fraction]) -> dict[str, str]:
    return {name: fraction_text(x) for name, x in note.items()}


def _fractions(note: Mapping[str, str]) -> dict[str, Fraction]:
    return {name: fraction_of(x) for name, x in note.items()}
