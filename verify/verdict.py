"""The verdict on a claim."""

from enum import StrEnum


class Verdict(StrEnum):
    """The five answers; each is given together with its evidence, never alone."""

    PROVED = "PROVED"  # exact algebra
    ENCLOSED = "ENCLOSED"  # a rigorous numeric enclosure
    MEASURED = "MEASURED"  # numeric, with its error estimate
    REFUTED = "REFUTED"  # a counterexample, or the proof of the contrary
    UNDECIDED = "UNDECIDED"

    @property
    def holds(self) -> bool:
        """True if the claim holds: it is PROVED, ENCLOSED or MEASURED."""
        return self in (Verdict.PROVED, Verdict.ENCLOSED, Verdict.MEASURED)
