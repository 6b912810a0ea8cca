"""The proof for one H in n degrees of freedom and one scheme, as a result."""

from verify.arithmetic.exact import text
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.symplectic.order import prove_symplectic
from verify.proof.symplectic.proof import MOST_TERMS, SymplecticProof
from verify.prose import Prose
from verify.scenes.results.proof import FormResult, ProofResult
from verify.schemes.scheme import Scheme


def in_degrees(hamiltonian: Hamiltonian, scheme: Scheme, *, marked: bool = True) -> ProofResult:
    """The proof, `marked` with who else checked it; closed forms are not written out.

    Raises InputError.
    """
    proof = prove_symplectic(hamiltonian, scheme)
    leading = proof.leading
    entries: tuple[tuple[str, str], ...] = ()
    if leading is not None and leading.length <= MOST_TERMS:
        each = leading.entries.items()
        entries = tuple((leading.called(at), leading.ring.text(x)) for at, x in each)
    form = FormResult(
        symplectic=proof.symplectic,
        entries=entries,
        entry=proof.entry,
        volume_order=proof.volume_order,
        volume_leading=proof.volume_leading,
        telescopes=proof.telescopes,
        potential=proof.potential,
        why=proof.why,
    )
    return ProofResult(
        **hamiltonian.texts,
        scheme=scheme.name,
        verdict=proof.verdict,
        reason=proof.reason,
        order=proof.order,
        leading=proof.leading_text,
        delta_j="0" if proof.symplectic else None,
        area_preserving=proof.area_preserving,
        convergence_order=proof.convergence_order,
        convergence_decided=proof.convergence_decided,
        witness={name: text(value) for name, value in proof.witness.items()},
        enclosure=proof.enclosure,
        domain=proof.domain.texts,
        where=proof.domain.prose,
        p_next=None,
        q_next=None,
        jacobian=None,
        form=form,
        checked_by=_marks(proof, hamiltonian, scheme) if marked else (),
        seconds=0.0,
    )


def _marks(proof: SymplecticProof, hamiltonian: Hamiltonian, scheme: Scheme) -> tuple[Prose, ...]:
    """Who else checked it."""
    from verify.proof.checked import marks
    from verify.proof.checked.proved import DEFECT, MAP, of_degrees

    return marks(of_degrees(proof, scheme, DEFECT | MAP, hamiltonian))
