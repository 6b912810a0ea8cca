"""Stepping: a run of N steps in any arithmetic, and the limits of a fixed-point run.

Interval arithmetic over the box |p| < reach_p, |q| < reach_q bounds every operation of a step, if
the values of functions stay below reach_value. Before the run a box is sought, as large as
possible and with sides from a short list, in which all operations stay in the format. The kernel
ends the loop when the orbit leaves the box, or a function's value its limit. So no operation checks
for overflow: none can occur.
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
from verify.kernels.rounding import PRECISION_BITS, Ball, RoundedValue, analyse
from verify.kernels.run_inputs import RunInputs, Times
from verify.lockstep import Course, run_alone

_FORMAT_LIMIT = Fraction(2) ** 15 * (1 - Fraction(1, 2**20))  # a little below the format's 2^15
_MATRIX_LIMITS = tuple(Fraction(2) ** n for n in (12, 10, 8, 6, 4, 3, 2))
_VALUE_LIMITS = tuple(Fraction(2) ** n for n in (13, 11, 9, 7, 5, 4, 3, 2, 1))
_BOX_SIDES = tuple(
    Fraction(2) ** n * share * Fraction(1023, 1024)
    for n in range(15, -8, -1)
    for share in (1, Fraction(3, 4))
)
_ASCENDING_SIDES = _BOX_SIDES[::-1]


class Limits(NamedTuple):
    """Limits of all momenta, all displacements, Λ (or 1 + Λ), functions' values, and M's entries if
    M is carried; in this order they are arguments of a kernel (see `kernel.LIMITS`)."""

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
    """Return the kernel's limits, or None if no box that contains the start is safe.

    `inputs`: h, the parameters and the scales, by name in the kernel's source. `times`: bounds of
    the steps' times, if H depends on time.
    """
    sizes = {name: abs(start[name]) for name in kernel.coordinates}
    # Coordinates that are no p and q have the limit of the displacements.
    p_sizes = [x for name, x in sizes.items() if name[0] == PLANE[0]]
    q_sizes = [x for name, x in sizes.items() if name[0] != PLANE[0]]
    start_sizes = [max(kind, default=Fraction(0)) for kind in (p_sizes, q_sizes)]
    # First boxes with room in all directions, then the smallest one that contains the start.
    roomy = [[room * max(start_sizes)] * 2 for room in (16, 2)]
    boxes = tuple((_side(p), _side(q)) for p, q in (*roomy, start_sizes))
    return _find_limits(kernel, tuple(inputs.items()), times, boxes)


def _side(size: Fraction) -> Fraction | None:
    """Return the least side that is greater than a size; None if there is none."""
    index = bisect_right(_ASCENDING_SIDES, size)
    return _ASCENDING_SIDES[index] if index < len(_ASCENDING_SIDES) else None


# Cached, since most starts of a grid lie in the same few boxes.
@lru_cache(maxsize=1 << 12)
def _find_limits(
    kernel: Kernel,
    inputs: tuple[tuple[str, Fraction], ...],
    times: Times | None,
    boxes: tuple[tuple[Fraction | None, Fraction | None], ...],
) -> Limits | None:
    """Return the limits of the first safe box, with the greatest limit of functions' values, after
    the box has grown as far as possible; None if no box is safe."""

    def grow(p: Fraction, q: Fraction, value: Fraction, matrix: Fraction) -> Limits:
        """Grow a safe box: first in p and q together, then in q, then in p."""
        part_limit = partial(_find_part_limit, kernel, inputs, times, matrix)

        def widest(growing: Iterable[tuple[Fraction, Fraction]]) -> tuple[Fraction, Fraction]:
            """Return the greatest safe box, by bisection: a box that contains an unsafe box is
            unsafe. The boxes come in decreasing order; the last one is safe."""
            boxes = list(growing)
            return boxes[
                bisect_left(boxes, True, key=lambda box: part_limit(*box, value) is not None)
            ]

        p, q = widest((max(p, r), max(q, r)) for r in _BOX_SIDES)
        # q first: it is often an angle, which grows along an orbit that rotates.
        p, q = widest((p, max(q, r)) for r in _BOX_SIDES)
        p, q = widest((max(p, r), q) for r in _BOX_SIDES)
        part = part_limit(p, q, value)
        assert part is not None  # noqa: S101 - the box is safe
        return Limits(p, q, part, value, matrix)

    matrices = _MATRIX_LIMITS if kernel.matrix else (Fraction(1),)
    with working_precision(PRECISION_BITS):
        # The order of the product is the preference: large boxes, then large limits of values.
        for (p, q), value, matrix in product(boxes, _VALUE_LIMITS, matrices):
            if p and q and _find_part_limit(kernel, inputs, times, matrix, p, q, value) is not None:
                return grow(p, q, value, matrix)
    return None


@lru_cache(maxsize=1 << 14)
def _find_part_limit(
    kernel: Kernel,
    inputs: tuple[tuple[str, Fraction], ...],
    times: Times | None,
    matrix: Fraction,
    p: Fraction,
    q: Fraction,
    value: Fraction,
) -> Fraction | None:
    """Return the limit of Λ; None if an operation may leave the format in this box, with M's
    entries below `matrix`.

    It is cached: a box has one of few sides, so the runs of a grid share boxes.
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
    format_limit = rational_ball(_FORMAT_LIMIT)
    return _part_limit(size) if all(x < format_limit for x in sizes) else None


def _part_limit(size: Mapping[str, Ball]) -> Fraction | None:
    """Return the power of two up to which Λ, and the plain product Π det J, may grow: D (1 + Λ),
    Λ + D (1 + Λ) and the next product then stay below 2^15. D is the carried ΔJ."""
    determinant = size.get("det", flint.arb(0))
    for n in range(13, -1, -1):
        if size["dj"] * (1 + 2**n) < 2**14 and determinant * 2**n < 2**14:
            return Fraction(2**n)
    return None


@dataclass(frozen=True)
class RunOutcome(ReachedPoint):
    """The end of a run with a `kernel`.

    `radii`: the radii of the last values, if numbers are enclosures. `shift`: ΔJ was carried as
    2^shift ΔJ. `reason`: why the run ended early, if the number format is the cause.
    """

    kernel: Kernel | None = None
    radii: Mapping[str, Fraction] = field(default_factory=dict)
    shift: int = 0
    reason: str = ""

    @property
    def values(self) -> Mapping[str, Fraction]:
        """The coordinates and observables after the last step done."""
        return self.trail[-1]

    @property
    def states(self) -> list[State]:
        """The carried states at the notes of the trail, in the arithmetic's numbers, coordinates
        first; a resumed run has only those since it was resumed."""
        return [note.state for note in self.trail if isinstance(note, LazyNote)]

    @property
    def coordinates(self) -> tuple[str, ...]:
        """The names of the coordinates among the carried numbers."""
        return self.kernel.coordinates if self.kernel else ()


_SCALING_STEP_BITS = 8  # by so many bits the scaling of ΔJ decreases if an orbit needs more room
_NO_STEP_OUTCOME = RunOutcome(reason="an operation of the first step may leave the range of ")


class KernelRun(RunInputs):
    """A run that can be made in any arithmetic."""

    def fits(self, arithmetic: Arithmetic) -> bool:
        """Return True if limits exist with which a step from the start stays in the fixed-point
        format; True for arithmetics that need none.

        Raises UnsupportedError if the arithmetic lacks a function.
        """
        observables = self.observables | ({"tangent"} if self.certifiable else set())
        kernel = kernel_for(self.hamiltonian, self.scheme, arithmetic, observables, False)
        return not arithmetic.absolute or any(True for _ in self.formats(kernel, arithmetic))

    def run(self, arithmetic: Arithmetic, **options: Any) -> RunOutcome:
        """Do the same as `run_in_turn`, without other runs beside it."""
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
        """Make all steps in this arithmetic; a compensated run has no extremes, and so no series.

        `tangent`: carry the tangent map along. `enough` is called with the outcome at the first
        note; if it returns False, the run ends there. A fixed-point run that cannot stay within its
        limits ends early.
        """
        observables = self.observables if not compensated else self.observables - {"extremes"}
        observables |= {"tangent"} if tangent else frozenset()
        kernel = kernel_for(self.hamiltonian, self.scheme, arithmetic, observables, compensated)
        if not arithmetic.absolute:
            loop = ChunkedLoop(self, kernel, arithmetic, (), 0)
            return (yield from _outcome(loop, progress, enough))
        outcome = replace(_NO_STEP_OUTCOME, reason=_NO_STEP_OUTCOME.reason + arithmetic.name)
        # A smaller scaling of ΔJ allows a larger box. If the orbit leaves the box, the run starts
        # again with the next scaling.
        for shift, bounds in self.formats(kernel, arithmetic):
            loop = ChunkedLoop(self, kernel, arithmetic, bounds[: len(kernel.limits)], shift)
            outcome = yield from _outcome(loop, progress, enough)
            # An outcome without a kernel is that of a run which `enough` has ended.
            if outcome.done == self.steps or outcome.kernel is None:
                return outcome
            box = f"|p| < {text(bounds.p)}, |q| <" if kernel.canonical else "|z| <"
            large = f"or a value was too large for {arithmetic.name}"
            reason = f"at step {outcome.done + 1} the orbit left {box} {text(bounds.q)}, {large}"
            outcome = replace(outcome, reason=reason)
        return outcome

    def formats(self, kernel: Kernel, arithmetic: Arithmetic) -> Iterator[tuple[int, Limits]]:
        """Yield scalings s of ΔJ with their limits, the largest s first.

        With a smaller s, 2^s ΔJ is smaller, and the box may be larger.
        """
        # ΔJ = O(h^r): with 2^s h^r of about 1, 2^s ΔJ uses the whole format.
        h_power = self.start["h"] ** kernel.power
        finest = min(63, max(0, (1 / h_power).__floor__().bit_length() - 1))
        previous, times = None, self.times(arithmetic)
        for shift in range(finest, -1, -_SCALING_STEP_BITS):
            bounds = limits(kernel, self.inputs(kernel, shift), self.start, times)
            if bounds is not None and bounds != previous:
                previous = bounds
                yield shift, bounds


def _outcome(
    loop: ChunkedLoop, progress: Progress | None, enough: Callable[[RunOutcome], bool] | None
) -> Course[RunOutcome]:
    """Run the loop to its end; on an interruption write a checkpoint."""

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
        # `goes_on(0)` calls `enough` for a run that was resumed beyond its first note.
        if goes_on(0) and (yield from loop.run_to_end(goes_on)):
            return outcome()
    except KeyboardInterrupt:
        loop.keep()
        raise
    return replace(_NO_STEP_OUTCOME, done=loop.done, seconds=loop.seconds)
