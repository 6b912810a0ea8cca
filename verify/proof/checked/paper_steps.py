"""The steps of an argument on paper that accompanies a proof, each with its checkers."""

from dataclasses import dataclass
from functools import cache

from verify.proof.assistant.stated import cite_theorems
from verify.proof.every_proof import EveryProof
from verify.proof.lie_argument import STEPS
from verify.prose import Prose, read_prose


@dataclass(frozen=True)
class PaperStep:
    """One step in words; `checked_by`: the machines that checked it, if any."""

    text: Prose
    checked_by: tuple[Prose, ...] = ()


def steps_of(proof: EveryProof) -> tuple[PaperStep, ...]:
    """Return the steps of the proof's argument; none where it has none."""
    return _lie_steps() if proof.argument else ()


@cache
def _lie_steps() -> tuple[PaperStep, ...]:
    return tuple(
        PaperStep(read_prose(text), (cite_theorems(names),) if names else ())
        for text, names in STEPS
    )
