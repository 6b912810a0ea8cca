"""What is proved of a scheme for every H holds of this one: orders, det J ≡ 1, telescoping."""

from functools import lru_cache

from verify.errors import LimitError
from verify.exploration.property import Violation, only_if, silent_at
from verify.exploration.sample import Sample
from verify.exploration.sample_in_degrees import SampleInDegrees
from verify.proof.every import prove_every
from verify.proof.every_in_time import prove_every_in_time
from verify.proof.every_proof import EveryProof
from verify.proof.order_proof import Proof
from verify.proof.potential import potential_of
from verify.proof.symplectic.every import prove_every_in_degrees
from verify.proof.symplectic.proof import SymplecticProof
from verify.verdict import Verdict

_MOST_ORDER = 4  # of a scheme that is proved for every H here
_MOST_IN_DEGREES = 3  # whose proof for every H in 3 degrees takes seconds, once
_IN = 3  # one in so many samples is asked whether its leading coefficient telescopes


@lru_cache(maxsize=128)
def _proved(scheme: str, timed: bool) -> EveryProof:
    return prove_every_in_time(scheme) if timed else prove_every(scheme)


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
    if every.area_preserving and proof.area_preserving is False:
        return f"ΔJ has order {proof.order}"
    if every.order is not None and proof.order is not None and proof.order < every.order:
        return f"ΔJ has order {proof.order}, not {every.order}"
    own, agreed = proof.convergence_order, every.convergence_order
    if own is not None and agreed is not None and own < agreed:
        return f"the map agrees with the flow up to h^{own}, not h^{agreed}"
    return ""


@lru_cache(maxsize=128)
def _proved_in_degrees(scheme: str, degrees: int, timed: bool) -> SymplecticProof:
    return prove_every_in_degrees(scheme, degrees, timed=timed)


def holds_in_degrees(sample: SampleInDegrees) -> None:
    """The same of S in place of ΔJ, and of det J − 1."""
    scheme = sample.scheme
    only_if(scheme.every_h is not None and scheme.order <= _MOST_IN_DEGREES and sample.ordinary)
    with silent_at(LimitError):
        every = _proved_in_degrees(scheme.name, sample.hamiltonian.degrees, sample.timed)
    only_if(every.verdict is Verdict.PROVED)
    proof = sample.proof
    wrong = ""
    if every.symplectic and proof.symplectic is False:
        wrong = f"S has order {proof.order}"
    elif every.order is not None and proof.order is not None and proof.order < every.order:
        wrong = f"S has order {proof.order}, not {every.order}"
    elif every.convergence_order is not None and proof.convergence_order is not None:
        if proof.convergence_order < every.convergence_order:
            wrong = f"the map agrees with the flow up to h^{proof.convergence_order}"
    elif every.telescopes and proof.order == every.order and proof.telescopes is False:
        wrong = "S does not begin with a Lie derivative"
    if wrong:
        raise Violation(f"{wrong}, against what is proved for every H")
