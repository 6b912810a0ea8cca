"""What is proved of a scheme for every H holds of this one: orders, det J ≡ 1, telescoping."""

from functools import lru_cache

from verify.errors import LimitError
from verify.exploration.property import Violation, only_if, silent_at
from verify.exploration.sample import Sample
from verify.proof.order_for_every_h import prove_for_every_h
from verify.proof.proof_for_every_h import ProofForEveryH
from verify.proof.proof_for_one_h import Proof
from verify.structures import AREA, SYMPLECTIC
from verify.verdict import Verdict

# The orders up to which a scheme is proved for every H; with 3 degrees this takes seconds, once.
_MAX_ORDER = {AREA: 4, SYMPLECTIC: 3}


@lru_cache(maxsize=128)
def _prove_every(scheme: str, timed: bool, degrees: int) -> ProofForEveryH:
    return prove_for_every_h(scheme, timed=timed, degrees=degrees)


def holds(sample: Sample) -> None:
    scheme, limit = sample.scheme, _MAX_ORDER[sample.hamiltonian.structure]
    only_if(scheme.every_h is not None and scheme.order <= limit and sample.ordinary)
    with silent_at(LimitError):
        general = _prove_every(scheme.name, sample.depends_on_time, sample.hamiltonian.degrees)
    only_if(general.verdict is Verdict.PROVED)
    contradiction = _contradiction(general, sample.proof)
    # If the leading coefficient for every H vanishes for this one, another one leads.
    if general.telescopes and sample.proof.order == general.order and _telescopes(sample) is False:
        contradiction = contradiction or "the leading coefficient does not telescope"
    if contradiction:
        raise Violation(f"{contradiction}, against what is proved for {general.quantifier}")


def _telescopes(sample: Sample) -> bool | None:
    """Return True if the leading coefficient is a Lie derivative, in the plane X·G.

    Finding G takes long, so that only some samples are tested by it.
    """
    if sample.is_turn(one_in=3) and sample.polynomial and sample.potential:
        return sample.potential.holds
    return sample.proof.telescopes


def _contradiction(general: ProofForEveryH, proof: Proof) -> str:
    """Describe how the proof for one H contradicts that for every H; "" if it does not.

    Both are about S, which in the plane is ΔJ·Ω. The order None means that it is higher than all
    that were examined.
    """
    if general.symplectic and proof.symplectic is False:
        return f"S has order {proof.order}"
    if general.order is not None and proof.order is not None and proof.order < general.order:
        return f"S has order {proof.order}, not {general.order}"
    order, common_order = proof.convergence_order, general.convergence_order
    if order is not None and common_order is not None and order < common_order:
        return f"the map agrees with the flow up to h^{order}, not h^{common_order}"
    return ""
