"""What is proved of a scheme for every H holds of this one: orders, det J ≡ 1, telescoping."""

from functools import lru_cache

from verify.errors import LimitError
from verify.exploration.property import Violation, only_if, silent_at
from verify.exploration.sample import Sample
from verify.proof.every import prove_every
from verify.proof.every_proof import EveryProof
from verify.proof.proof import Proof
from verify.structures import AREA, SYMPLECTIC
from verify.verdict import Verdict

# Of a scheme that is proved for every H here; in 3 degrees such a proof takes seconds, once.
_MOST_ORDER = {AREA: 4, SYMPLECTIC: 3}


@lru_cache(maxsize=128)
def _proved(scheme: str, timed: bool, degrees: int) -> EveryProof:
    return prove_every(scheme, timed=timed, degrees=degrees)


def holds(sample: Sample) -> None:
    scheme, most = sample.scheme, _MOST_ORDER[sample.hamiltonian.structure]
    only_if(scheme.every_h is not None and scheme.order <= most and sample.ordinary)
    with silent_at(LimitError):
        every = _proved(scheme.name, sample.timed, sample.hamiltonian.degrees)
    only_if(every.verdict is Verdict.PROVED)
    wrong = _contradiction(every, sample.proof)
    # Where the leading coefficient for every H vanishes for this one, another one leads.
    if every.telescopes and sample.proof.order == every.order and _telescopes(sample) is False:
        wrong = wrong or "the leading coefficient does not telescope"
    if wrong:
        raise Violation(f"{wrong}, against what is proved for {every.quantifier}")


def _telescopes(sample: Sample) -> bool | None:
    """Whether the leading coefficient is a Lie derivative: in the plane X·G, which takes long."""
    if sample.is_turn(one_in=3) and sample.polynomial and sample.potential:
        return sample.potential.holds
    return sample.proof.telescopes


def _contradiction(every: EveryProof, proof: Proof) -> str:
    """In words, of S, which in the plane is ΔJ; empty where there is none. None, as an order, is
    beyond all that are looked at."""
    if every.symplectic and proof.symplectic is False:
        return f"S has order {proof.order}"
    if every.order is not None and proof.order is not None and proof.order < every.order:
        return f"S has order {proof.order}, not {every.order}"
    own, agreed = proof.convergence_order, every.convergence_order
    if own is not None and agreed is not None and own < agreed:
        return f"the map agrees with the flow up to h^{own}, not h^{agreed}"
    return ""
