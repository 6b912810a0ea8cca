"""What is proved of one H in n degrees of freedom, as claims ask for it."""

from functools import lru_cache

from verify.algebra.domain import EVERYWHERE
from verify.claims.proved_order import ProvedOrder, told_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.expansion import MOST_ORDERS
from verify.proof.symplectic.order import prove_symplectic
from verify.proof.symplectic.proof import SymplecticProof
from verify.prose import Formula, prose
from verify.schemes import get

_BEYOND = MOST_ORDERS + 1  # an order of what vanishes


@lru_cache(maxsize=64)
def proof_of(hamiltonian: Hamiltonian, scheme: str) -> SymplecticProof:
    """The proof; several claims speak of one."""
    return prove_symplectic(hamiltonian, get(scheme))


def defect_order(hamiltonian: Hamiltonian, scheme: str) -> ProvedOrder:
    """The order of S = JᵀΩJ − Ω in h."""
    proof = proof_of(hamiltonian, scheme)
    if proof.symplectic or proof.order is None:
        vanishes = True if proof.symplectic else None
        return ProvedOrder(_BEYOND if vanishes else 0, False, vanishes, proof.reason, proof.domain)
    evidence = prose("S has order exactly ", Formula(f"h^{proof.order}"), f", by {proof.entry}")
    return ProvedOrder(proof.order, True, False, evidence, proof.domain)


def volume_order(hamiltonian: Hamiltonian, scheme: str) -> ProvedOrder:
    """The order of det J − 1 in h."""
    proof = proof_of(hamiltonian, scheme)
    if proof.area_preserving:
        evidence = prose("det J ≡ 1")
        return ProvedOrder(_BEYOND, False, True, evidence, proof.domain)
    order = proof.volume_order
    if order is None:
        undecided = prose("the order of det J − 1 is not decided")
        return ProvedOrder(0, False, proof.area_preserving, undecided, proof.domain)
    evidence = prose("det J − 1 has order exactly ", Formula(f"h^{order}"))
    return ProvedOrder(order, True, False, evidence, proof.domain)


def flow_order(hamiltonian: Hamiltonian, scheme: str) -> ProvedOrder:
    """To which power of h the map agrees with the exact flow."""
    proof = proof_of(hamiltonian, scheme)
    agreed = proof.convergence_order
    if agreed is None:
        evidence = prose("the map agrees with the exact flow in all orders looked at")
        return ProvedOrder(0, False, None, evidence, proof.domain, EVERYWHERE)
    evidence = prose("the map agrees with the exact flow up to ", Formula(f"h^{agreed}"))
    exact = proof.convergence_decided
    more = " and no further" if exact else "; whether further is not decided"
    return told_of(ProvedOrder(agreed, exact, False, evidence + more, proof.domain), proof.nearby)
