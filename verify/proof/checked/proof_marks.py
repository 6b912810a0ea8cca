"""Marks of who checked a proof about a scheme: the small checker, Rocq, or only its readers.

The small checker's mark means that it accepted a certificate of the proof in this run; the marks of
Rocq are in `verify.proof.checked.theory_marks`. An argument on paper that accompanies a proof is
shown in steps, each with the machines that checked it; steps without a mark are checked by readers
only.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

from verify.effort import limit_effort
from verify.errors import InputError
from verify.proof.assistant.shipped_theory import cite_theorems
from verify.proof.certificates.established_statement import EstablishedStatement, check_certificate
from verify.proof.checked.proved_statement import ProvedStatement
from verify.proof.checked.theory_marks import theory_marks
from verify.proof.proof_for_every_h import STEPS, ProofForEveryH
from verify.prose import Formula, Prose, prose, read_prose

_POWER = re.compile(r"h\^[0-9]+")
_CERTIFIED = {"defect", "map", "telescopes"}
_LONGEST_QUOTE = 60  # characters; a longer leading coefficient is left out


def marks(proved: ProvedStatement) -> tuple[Prose, ...]:
    """Return a text for each checker of the proof, the small checker first; empty if none."""
    return (*small_checker_marks(proved), *theory_marks(proved))


# -- the small checker ----------------------------------------------------------------------------


def small_checker_marks(proved: ProvedStatement) -> Iterator[Prose]:
    """Yield the statement of the first certificate that exists, if the checker accepts it."""
    if not (_CERTIFIED & proved.about) and not ("volume" in proved.about and proved.preserves):
        return
    for make in proved.certificates:
        try:
            with limit_effort("proof", proved.scheme.name, "to certify it"):
                result = check_certificate(make())
        except InputError:  # this certificate does not exist
            continue
        if isinstance(result, EstablishedStatement):
            yield prose("small checker: ", read_prose(_statement(result)), _leading(result))
        return


def _statement(result: EstablishedStatement) -> str:
    """Return the statement with the powers of h marked as formulas."""
    return _POWER.sub(r"`\g<0>`", result.statement)


def _leading(result: EstablishedStatement) -> Prose:
    """Quote L if it is short; return nothing otherwise."""
    if result.leading is None or len(result.leading) > _LONGEST_QUOTE:
        return Prose()
    return prose("; L = ", Formula(result.leading))


# -- the argument on paper ------------------------------------------------------------------------


@dataclass(frozen=True)
class PaperStep:
    """One step of an argument in words; `checked_by`: the machines that checked it, if any."""

    text: Prose
    checked_by: tuple[Prose, ...] = ()


def steps_of(proof: ProofForEveryH) -> tuple[PaperStep, ...]:
    """Return the steps of the argument that accompanies the proof; none if it has none."""
    return _lie_steps() if proof.argument else ()


@cache
def _lie_steps() -> tuple[PaperStep, ...]:
    return tuple(
        PaperStep(read_prose(text), (cite_theorems(names),) if names else ())
        for text, names in STEPS
    )
