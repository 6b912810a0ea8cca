"""What is proved of a scheme for every H holds of this one: orders, det J ≡ 1, telescoping."""

from functools import lru_cache

from verify.errors import LimitError
from verify.exploration.property import Violation, only_if, silent_at
from verify.exploration.sample import Sample
from verify.exploration.sample_in_degrees import SampleInDegrees
from verify.proof.every import prove_every
from verify.proof.every_proof import EveryProof
from verify.proof.plane.potential import potential_of
from verify.proof.proof import Proof
from verify.verdict import Verdict

_MOST_ORDER = 4  # of a scheme that is proved for every H here
_MOST_IN_DEGREES = 3  # whose proof for every H in 3 degrees takes seconds, once
_IN = 3  # one in so many samples is asked whether its leading coefficient telescopes


@lru_cache(maxsize=128)
def _proved(scheme: str, timed: bool, degrees: int = 1) -> EveryProof:
    return prove_every(scheme, timed=timed, degrees=degrees)


def holds(sample: Sample) -> None:
    scheme = sample.scheme
    only_if(scheme.every_h is not None and scheme.order <= _MOST_ORDER and sample.ordinary)
    every, proof = _proved(scheme.name, sample.timed), sample.proof
    only_if(every.verdict is Verdict.PROVED)
    wrong = _contradiction(every, proof)
    if wrong:
        raise Violation(f"{wrong}, against what is proved for {every.quantifier}")
    # Where the leading coefficient for every H vanishes for this one, another one leads.
    same = proof.order == every.order and sample.is_turn(_IN) and sample.polynomial
    if every.telescopes and same:
        found = potential_of(proof, scheme)
        if found.holds is False:
            raise Violation(f"L is not X·G: {found.reason}; it is for {every.quantifier}")


def _contradiction(every: EveryProof, proof: Proof) -> str:
    """In words; empty where there is none. None, as an order, is beyond all that are looked at."""
    defect = "ΔJ" if every.planar else "S"
    if every.symplectic and proof.symplectic is False:
        return f"{defect} has order {proof.order}"
    if every.order is not None and proof.order is not None and proof.order < every.order:
        return f"{defect} has order {proof.order}, not {every.order}"
    own, agreed = proof.convergence_order, every.convergence_order
    if own is not None and agreed is not None and own < agreed:
        return f"the map agrees with the flow up to h^{own}, not h^{agreed}"
    return ""


def holds_in_degrees(sample: SampleInDegrees) -> None:
    """The same of S in place of ΔJ, and of det J − 1."""
    scheme = sample.scheme
    only_if(scheme.every_h is not None and scheme.order <= _MOST_IN_DEGREES and sample.ordinary)
    with silent_at(LimitError):
        every = _proved(scheme.name, sample.timed, sample.hamiltonian.degrees)
    only_if(every.verdict is Verdict.PROVED)
    proof = sample.proof
    wrong = _contradiction(every, proof)
    if every.telescopes and proof.order == every.order and proof.telescopes is False:
        wrong = wrong or "S does not begin with a Lie derivative"
    if wrong:
        raise Violation(f"{wrong}, against what is proved for {every.quantifier}")
