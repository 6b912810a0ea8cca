"""The steps of an argument on paper that stands beside a proof, each with what checked it."""

from dataclasses import dataclass
from functools import cache

from verify.proof.assistant.stated import by_rocq
from verify.proof.every_proof import EveryProof
from verify.proof.lie_argument import STEPS
from verify.prose import Prose, read_prose


@dataclass(frozen=True)
class PaperStep:
    """One step in words; `checked_by`: what checked it by machine, none where nothing did."""

    text: Prose
    checked_by: tuple[Prose, ...] = ()


def steps_of(proof: EveryProof) -> tuple[PaperStep, ...]:
    """Those of the proof's argument; none where it has none."""
    return _lie_steps() if proof.argument else ()


@cache
def _lie_steps() -> tuple[PaperStep, ...]:
    return tuple(
        PaperStep(read_prose(text), (by_rocq(names),) if names else ()) for text, names in STEPS
    )
