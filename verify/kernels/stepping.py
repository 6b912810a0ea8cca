"""Stepping: a run of N steps, in chunks, in whatever arithmetic it is given."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import chain

from verify.arithmetic.exact import text
from verify.arithmetic.number_system import Arithmetic, State
from verify.kernels.chunked_loop import ChunkedLoop, Progress, Reached
from verify.kernels.kernel import Kernel, kernel_for
from verify.kernels.notes import LazyNote
from verify.kernels.reach import Limits, limits
from verify.kernels.run_inputs import RunInputs


@dataclass(frozen=True)
class Outcome(Reached):
    """Where a run has ended, by a `kernel`.

    `radii`: how far from the last values the true ones may be, where numbers are enclosures.
    `shift`: what was carried of ΔJ was 2^shift times it. `reason` says why the run ended early,
    where that is the number format's doing.
    """

    kernel: Kernel | None = None
    radii: Mapping[str, Fraction] = field(default_factory=dict)
    shift: int = 0
    reason: str = ""

    @property
    def values(self) -> Mapping[str, Fraction]:
        """What is carried, after the last step that was done."""
        return self.trail[-1]

    @property
    def states(self) -> list[State]:
        """What was carried at the points of the trail, as the arithmetic has it; the coordinates
        come first. Of a run that was taken up again, what it has done itself."""
        return [note.state for note in self.trail if isinstance(note, LazyNote)]

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Those of what is carried that are the state."""
        return self.kernel.coordinates if self.kernel else ()


_FEWER_BITS = 8  # of ΔJ's scaling, where an orbit needs more room
_NOWHERE = Outcome(reason="an operation of the first step may leave the range of ")


class KernelRun(RunInputs):
    """A run that can be done in any arithmetic."""

    def fits(self, arithmetic: Arithmetic) -> bool:
        """Whether a step from the start stays in the arithmetic's range, where that is limited.

        Raises UnsupportedError where that lacks a function.
        """
        made = (self.hamiltonian, self.scheme, arithmetic, self.observables | {"tangent"}, False)
        kernel = kernel_for(*made)
        return not arithmetic.absolute or any(True for _ in self.formats(kernel, arithmetic))

    def run(
        self,
        arithmetic: Arithmetic,
        *,
        compensated: bool = False,
        tangent: bool = False,
        progress: Progress | None = None,
        enough: Callable[[Outcome], bool] | None = None,
    ) -> Outcome:
        """All steps in this arithmetic; the series only where the kernel collects extremes.

        `tangent` carries the tangent map along. `enough` is asked at the first checkpoint whether
        to go on; where it says no the run ends there. A fixed-point run that cannot stay within its
        limits ends early.
        """
        observables = self.observables if not compensated else self.observables - {"extremes"}
        observables |= {"tangent"} if tangent else frozenset()
        made = (self.hamiltonian, self.scheme, arithmetic, observables, compensated)
        kernel = kernel_for(*made)
        if not arithmetic.absolute:
            return _outcome(ChunkedLoop(self, kernel, arithmetic, (), 0), progress, enough)
        outcome = replace(_NOWHERE, reason=_NOWHERE.reason + arithmetic.name)
        for shift, found in self.formats(kernel, arithmetic):
            loop = ChunkedLoop(self, kernel, arithmetic, found[: len(kernel.limits)], shift)
            outcome = _outcome(loop, progress, enough)
            if outcome.done == self.steps or outcome.kernel is None:  # done, or not enough
                return outcome
            reason = (
                f"at step {outcome.done + 1} the orbit left |p| < {text(found.p)}, "
                f"|q| < {text(found.q)}, or a value was too large for {arithmetic.name}"
            )
            outcome = replace(outcome, reason=reason)
        return outcome

    def formats(self, kernel: Kernel, arithmetic: Arithmetic) -> Iterator[tuple[int, Limits]]:
        """Scalings s of ΔJ with the limits that they have, the finest first.

        With a smaller s, 2^s ΔJ is smaller and the orbit may go farther.
        """
        h_power = self.start["h"] ** kernel.power
        finest = min(63, max(0, (1 / h_power).__floor__().bit_length() - 1))
        last, times = None, self.times(arithmetic)
        for shift in range(finest, -1, -_FEWER_BITS):
            found = limits(kernel, self.inputs(kernel, shift), self.start, times)
            if found is not None and found != last:
                last = found
                yield shift, found


def _outcome(
    loop: ChunkedLoop, progress: Progress | None, enough: Callable[[Outcome], bool] | None
) -> Outcome:
    """The loop to its end; a checkpoint is written where it is interrupted."""

    def outcome() -> Outcome:
        reached = vars(loop.reached) | {"done": loop.done, "seconds": loop.seconds}
        return Outcome(**reached, kernel=loop.kernel, radii=loop.radii(), shift=loop.shift)

    asked = False
    try:
        # A run that goes on from beyond its first checkpoint is asked about that one as well.
        for done in chain([0], loop.chunks()):
            if progress and done:
                progress(done)
            if enough and not asked and loop.done >= loop.section:
                asked = True
                if not enough(outcome()):
                    return replace(_NOWHERE, done=loop.done, seconds=loop.seconds)
    except KeyboardInterrupt:
        loop.keep()
        raise
    return outcome()
