"""Who checked the proof that decides a claim: by what the claim asks of it, and of which H."""

from functools import lru_cache
from typing import TYPE_CHECKING

from verify.claims.claim import Claim
from verify.claims.findings import Findings
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import Prose
from verify.schemes import get

if TYPE_CHECKING:
    from verify.proof.checked.proved import About

    AboutAll = frozenset[About]


def of_scene(claim: Claim, findings: Findings, about: "AboutAll") -> tuple[Prose, ...]:
    """The marks of the proof for the H of the claim's scene."""
    return of_hamiltonian(findings.scene_of(claim).exact_hamiltonian(), claim.scheme, about)


@lru_cache(maxsize=64)
def of_hamiltonian(hamiltonian: Hamiltonian, name: str, about: "AboutAll") -> tuple[Prose, ...]:
    """The marks of the proof for this H."""
    from verify.claims.formulas import proof_of
    from verify.proof.checked import marks
    from verify.proof.checked.proved import of_one_hamiltonian

    proof = proof_of(hamiltonian, name)
    return marks(of_one_hamiltonian(proof, hamiltonian, get(name), about))


@lru_cache(maxsize=64)
def of_every(
    name: str, about: "AboutAll", *, separable: bool, timed: bool, least: int
) -> tuple[Prose, ...]:
    """The marks of the proof for every H that is meant; `least` as for `prove_every`."""
    from verify.proof.checked import marks
    from verify.proof.checked.proved import of_every_hamiltonian
    from verify.proof.every import prove_every

    proof = prove_every(name, separable=separable, timed=timed, least=least)
    return marks(of_every_hamiltonian(proof, get(name), about))
