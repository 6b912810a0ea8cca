"""Stepping: a run of N steps, in chunks, in any arithmetic, and limits in a fixed-point format.

Interval arithmetic over the box |p| < reach_p, |q| < reach_q bounds every operation of a step, with
functions' values assumed to stay below reach_value. A large box of rounded sides for which all of
them stay in the format is found before the run; the kernel ends the loop where the orbit leaves it,
or a function's value its limit. So no operation has to check for overflow: there can be none.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import lru_cache, partial
from itertools import product
from typing import Any, NamedTuple

import flint

from verify.arithmetic.arb import rational_ball
from verify.arithmetic.exact import text
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number_system import Arithmetic, State
from verify.hamiltonians.coordinates import PLANE
from verify.kernels.chunked_loop import ChunkedLoop, Progress
from verify.kernels.kernel import Kernel, kernel_for
from verify.kernels.notes import LazyNote, ReachedPoint
from verify.kernels.rounding import PRECISION, Ball, RoundedValue, analyse
from verify.kernels.run_inputs import RunInputs, Times
from verify.lockstep import Course, run_alone

_TOP = Fraction(2) ** 15 * (1 - Fraction(1, 2**20))  # numbers are below 2^15 in size
_MATRIX_LIMITS = tuple(Fraction(2) ** n for n in (12, 10, 8, 6, 4, 3, 2))
_VALUE_LIMITS = tuple(Fraction(2) ** n for n in (13, 11, 9, 7, 5, 4, 3, 2, 1))
_SIDES = tuple(
    Fraction(2) ** n * share * Fraction(1023, 1024)
    for n in range(15, -8, -1)
    for share in (1, Fraction(3, 4))
)
_ASCENDING = _SIDES[::-1]


class Limits(NamedTuple):
    """Bounds on all momenta, all coordinates, Λ (or 1 + Λ), functions' values, and M's entries
    if it is carried; see `kernel.LIMITS`."""

    p: Fraction
    q: Fraction
    part: Fraction
    value: Fraction
    matrix: Fraction


def limits(
    kernel: Kernel,
    inputs: Mapping[str, Fraction],
    start: Mapping[str, Fraction],
    times: Times | None = None,
) -> Limits | None:
    """Return the kernel's limits for these h and parameters, by the names that its source has for
    them.

    `times`: the first and the last, if H depends on time. None if no box that holds the start
    is safe.
    """
    sizes = {name: abs(start[name]) for name in kernel.coordinates}
    largest = [max(x for name, x in sizes.items() if name[0] == kind) for kind in PLANE]
    # First boxes with room to move in all directions, then one that only just holds the start.
    roomy = [[room * max(largest)] * 2 for room in (16, 2)]
    boxes = tuple((_side(p), _side(q)) for p, q in (*roomy, largest))
    return _largest(kernel, tuple(inputs.items()), times, boxes)


def _side(size: Fraction) -> Fraction | None:
    """Return the least side greater than a size."""
    index = bisect_right(_ASCENDING, size)
    return _ASCENDING[index] if index < len(_ASCENDING) else None


# Of a grid's starts most lie in the same few boxes.
@lru_cache(maxsize=1 << 12)
def _largest(
    kernel: Kernel,
    inputs: tuple[tuple[str, Fraction], ...],
    times: Times | None,
    boxes: tuple[tuple[Fraction | None, Fraction | None], ...],
) -> Limits | None:
    """Return the limits of the first safe box, with the greatest limit of values, grown as far as
    possible."""

    def grow(p: Fraction, q: Fraction, value: Fraction, matrix: Fraction) -> Limits:
        """Grow a safe box: first to all sides."""
        room = partial(_room, kernel, inputs, times, matrix)

        def widest(growing: Iterable[tuple[Fraction, Fraction]]) -> tuple[Fraction, Fraction]:
            """Return the greatest safe box, by bisection: a box that contains an unsafe box is
            unsafe. Boxes come from the greatest to the least, which is the one that was safe."""
            boxes = list(growing)
            return boxes[bisect_left(boxes, True, key=lambda box: room(*box, value) is not None)]

        p, q = widest((max(p, r), max(q, r)) for r in _SIDES)
        # q first: it is an angle more often than p, and grows where that turns.
        p, q = widest((p, max(q, r)) for r in _SIDES)
        p, q = widest((max(p, r), q) for r in _SIDES)
        part = room(p, q, value)
        assert part is not None  # noqa: S101 - as was just seen
        return Limits(p, q, part, value, matrix)

    matrices = _MATRIX_LIMITS if kernel.matrix else (Fraction(1),)
    with working_precision(PRECISION):
        # The order of the product decides the preference: roomy boxes first, then large limits of
        # values.
        for (p, q), value, matrix in product(boxes, _VALUE_LIMITS, matrices):
            if p and q and _room(kernel, inputs, times, matrix, p, q, value) is not None:
                return grow(p, q, value, matrix)
    return None


@lru_cache(maxsize=1 << 14)
def _room(
    kernel: Kernel,
    inputs: tuple[tuple[str, Fraction], ...],
    times: Times | None,
    matrix: Fraction,
    p: Fraction,
    q: Fraction,
    value: Fraction,
) -> Fraction | None:
    """Return how large Λ may become; None if an operation may leave the format in this box, with
    M's entries below `matrix`.

    Boxes have few sides, so that the runs of a grid ask for the same ones.
    """
    inputs_ = {name: RoundedValue(rational_ball(x), flint.arb(0)) for name, x in inputs}
    unit_ball = flint.arb(0, 1)
    sides = {name: p if name[0] == "p" else q for name in kernel.coordinates}
    sides |= dict.fromkeys(kernel.matrix, matrix)
    inputs_ |= {
        n: RoundedValue(rational_ball(r) * unit_ball, flint.arb(0)) for n, r in sides.items()
    }
    if times:
        first, last = map(rational_ball, times)
        inputs_["t"] = RoundedValue(first.union(last), flint.arb(0))
    program, live = kernel.lowering.program, kernel.lowering.live(kernel.roots)
    values = analyse(program, live, inputs_, lambda *_: flint.arb(0), rational_ball(value))
    if values is None:
        return None
    sizes = [x.magnitude for x in (*values.values(), *([inputs_["t"]] if times else []))]
    size = {name: values[index].magnitude for name, index in kernel.outputs.items()}
    sizes += [rational_ball(r) + size[f"d{name}"] for name, r in sides.items()]
    # ΔJ² is added to the sum for the MSE, so it must fit in the format too.
    sizes.append(size["dj"] * size["dj"])
    top = rational_ball(_TOP)
    return _part_limit(size) if all(x < top for x in sizes) else None


def _part_limit(size: Mapping[str, Ball]) -> Fraction | None:
    """Return the power of two that Λ, and the plain product of determinants, may reach: D (1 + Λ),
    Λ + D (1 + Λ) and the next product stay below 2^15."""
    determinant = size.get("det", flint.arb(0))
    for n in range(13, -1, -1):
        if size["dj"] * (1 + 2**n) < 2**14 and determinant * 2**n < 2**14:
            return Fraction(2**n)
    return None


@dataclass(frozen=True)
class RunOutcome(ReachedPoint):
    """The end of a run, by a `kernel`.

    `radii`: how far from the last values the true ones may be, if numbers are enclosures.
    `shift`: ΔJ was carried as 2^shift ΔJ. `reason` says why the run ended early, if the number
    format is the cause.
    """

    kernel: Kernel | None = None
    radii: Mapping[str, Fraction] = field(default_factory=dict)
    shift: int = 0
    reason: str = ""

    @property
    def values(self) -> Mapping[str, Fraction]:
        """The carried numbers after the last step that was done."""
        return self.trail[-1]

    @property
    def states(self) -> list[State]:
        """The states at the points of the trail, as the arithmetic has them; the coordinates come
        first. A run that was resumed has only those of its own part."""
        return [note.state for note in self.trail if isinstance(note, LazyNote)]

    @property
    def coordinates(self) -> tuple[str, ...]:
        """The names of the coordinates among the carried numbers."""
        return self.kernel.coordinates if self.kernel else ()


_FEWER_BITS = 8  # of ΔJ's scaling, if an orbit needs more room
_NOWHERE = RunOutcome(reason="an operation of the first step may leave the range of ")


class KernelRun(RunInputs):
    """A run that can be done in any arithmetic."""

    def fits(self, arithmetic: Arithmetic) -> bool:
        """Return True if a step from the start stays in the arithmetic's range, if that is
        limited.

        Raises UnsupportedError if that lacks a function.
        """
        observables = self.observables | {"tangent"}
        kernel = kernel_for(self.hamiltonian, self.scheme, arithmetic, observables, False)
        return not arithmetic.absolute or any(True for _ in self.formats(kernel, arithmetic))

    def run(self, arithmetic: Arithmetic, **options: Any) -> RunOutcome:
        """Run alone: the same as `run_in_turn`."""
        return run_alone(self.run_in_turn(arithmetic, **options))

    def run_in_turn(
        self,
        arithmetic: Arithmetic,
        *,
        compensated: bool = False,
        tangent: bool = False,
        progress: Progress | None = None,
        enough: Callable[[RunOutcome], bool] | None = None,
    ) -> Course[RunOutcome]:
        """Make all steps in this arithmetic; the series only if the kernel collects extremes.

        `tangent` carries the tangent map along. `enough` is called at the first checkpoint and
        decides whether to go on; if it says no the run ends there. A fixed-point run that cannot
        stay within its limits ends early.
        """
        observables = self.observables if not compensated else self.observables - {"extremes"}
        observables |= {"tangent"} if tangent else frozenset()
        kernel = kernel_for(self.hamiltonian, self.scheme, arithmetic, observables, compensated)
        if not arithmetic.absolute:
            loop = ChunkedLoop(self, kernel, arithmetic, (), 0)
            return (yield from _outcome(loop, progress, enough))
        outcome = replace(_NOWHERE, reason=_NOWHERE.reason + arithmetic.name)
        # Each format with a smaller scaling of ΔJ allows a larger box; the run starts again in the
        # next one if the orbit left the last.
        for shift, bounds in self.formats(kernel, arithmetic):
            loop = ChunkedLoop(self, kernel, arithmetic, bounds[: len(kernel.limits)], shift)
            outcome = yield from _outcome(loop, progress, enough)
            if outcome.done == self.steps or outcome.kernel is None:  # done, or not enough
                return outcome
            reason = (
                f"at step {outcome.done + 1} the orbit left |p| < {text(bounds.p)}, "
                f"|q| < {text(bounds.q)}, or a value was too large for {arithmetic.name}"
            )
            outcome = replace(outcome, reason=reason)
        return outcome

    def formats(self, kernel: Kernel, arithmetic: Arithmetic) -> Iterator[tuple[int, Limits]]:
        """Yield scalings s of ΔJ with their limits, the finest first.

        With a smaller s, 2^s ΔJ is smaller and the orbit may go farther.
        """
        # ΔJ = O(h^r), so 2^s h^r of about 1 uses the whole format, if the orbit leaves room for it.
        h_power = self.start["h"] ** kernel.power
        finest = min(63, max(0, (1 / h_power).__floor__().bit_length() - 1))
        last, times = None, self.times(arithmetic)
        for shift in range(finest, -1, -_FEWER_BITS):
            bounds = limits(kernel, self.inputs(kernel, shift), self.start, times)
            if bounds is not None and bounds != last:
                last = bounds
                yield shift, bounds


def _outcome(
    loop: ChunkedLoop, progress: Progress | None, enough: Callable[[RunOutcome], bool] | None
) -> Course[RunOutcome]:
    """Run the loop to its end; a checkpoint is written if it is interrupted."""

    def outcome() -> RunOutcome:
        fields = vars(loop.current) | {"done": loop.done, "seconds": loop.seconds}
        return RunOutcome(**fields, kernel=loop.kernel, radii=loop.radii(), shift=loop.shift)

    was_asked = False

    def goes_on(done: int) -> bool:
        nonlocal was_asked
        if progress and done:
            progress(done)
        if enough and not was_asked and loop.done >= loop.section:
            was_asked = True
            return enough(outcome())
        return True

    try:
        # A run resumed beyond its first checkpoint must pass the same question.
        if goes_on(0) and (yield from loop.run_to_end(goes_on)):
            return outcome()
    except KeyboardInterrupt:
        loop.keep()
        raise
    return replace(_NOWHERE, done=loop.done, seconds=loop.seconds)
