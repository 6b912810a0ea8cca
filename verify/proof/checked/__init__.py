"""Who checked what is proved of a scheme: the small checker, Rocq, or only who reads it."""

from verify.proof.checked import in_theory, small_checker
from verify.proof.checked.proved import Proved
from verify.prose import Prose

__all__ = ["Proved", "marks"]


def marks(proved: Proved) -> tuple[Prose, ...]:
    """One text for each that checked it, in this run or once for all; none where nobody did."""
    return (*small_checker.marks(proved), *in_theory.marks(proved))
