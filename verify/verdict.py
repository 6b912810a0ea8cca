"""The verdict on a claim."""

from collections.abc import Iterable
from enum import StrEnum


class Verdict(StrEnum):
    """The five answers; each is given together with its evidence, never alone."""

    PROVED = "PROVED"  # exact algebra
    ENCLOSED = "ENCLOSED"  # a rigorous numeric enclosure
    MEASURED = "MEASURED"  # numbers, with an estimate of their errors
    REFUTED = "REFUTED"  # a counterexample, or the proof of the contrary
    UNDECIDED = "UNDECIDED"  # neither a proof nor a counterexample

    @property
    def holds(self) -> bool:
        """True if the claim holds: it is PROVED, ENCLOSED or MEASURED."""
        return self in (Verdict.PROVED, Verdict.ENCLOSED, Verdict.MEASURED)


_FROM_BEST = (
    Verdict.PROVED, Verdict.ENCLOSED, Verdict.MEASURED, Verdict.UNDECIDED, Verdict.REFUTED,
)  # fmt: skip


def worst_of(verdicts: Iterable[Verdict]) -> Verdict:
    """Return the worst of several verdicts."""
    return max(verdicts, key=_FROM_BEST.index)
