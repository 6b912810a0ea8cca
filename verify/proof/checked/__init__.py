"""Marks of who checked a proof about a scheme: the small checker, Rocq, or only its readers."""

from verify.proof.checked import in_theory, small_checker
from verify.proof.checked.proved import ProvedStatement
from verify.prose import Prose

__all__ = ["ProvedStatement", "marks"]


def marks(proved: ProvedStatement) -> tuple[Prose, ...]:
    """Return a text for each checker, in this run or once for all; none where nobody checked."""
    return (*small_checker.marks(proved), *in_theory.marks(proved))
