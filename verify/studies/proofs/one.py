"""The task of a proof for one H and one scheme."""

import time
from dataclasses import replace
from fractions import Fraction
from typing import Any, Literal

from verify.algebra.expressions.formula_text import to_text
from verify.arithmetic.exact import text
from verify.execution.keeping import Keeper
from verify.execution.task import SchemeTask
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order import prove
from verify.proof.order_proof import Proof
from verify.proof.symplectic.order import prove_symplectic
from verify.proof.symplectic.proof import SymplecticProof
from verify.prose import Prose
from verify.scenes.results.proof import FormResult, Formulas, ProofResult
from verify.schemes import get
from verify.schemes.degrees.two_form import MOST_TERMS
from verify.schemes.scheme import Scheme
from verify.schemes.step_map import StepMap, grouped

_COST = 10_000_000  # of a proof, about
_LONG = 12  # digits of a value that no formula is read with
_FORMULAS = ("delta_j", "p_next", "q_next", "jacobian")


class ProofTask(SchemeTask):
    """Prove the order of ΔJ and of the map for one H and one scheme.

    `formulas`: ΔJ, the map and its Jacobian are also written out, and it is told who else checked
    the proof, which may take longer.
    """

    result = ProofResult
    kind: Literal["proof"] = "proof"
    formulas: bool = True

    @property
    def cost(self) -> int:
        """About how many float64 steps it is worth."""
        return _COST

    def compute(self, keeper: Keeper) -> ProofResult:
        """The proof for this H, as a result."""
        hamiltonian, scheme = self.exact_hamiltonian(), get(self.scheme)
        begun = time.perf_counter()
        made = _in_plane if hamiltonian.planar else _in_degrees
        proof, more = made(hamiltonian, scheme, self.formulas)
        return ProofResult(
            **hamiltonian.texts,
            scheme=self.scheme,
            verdict=proof.verdict,
            reason=proof.reason,
            order=proof.order,
            leading=proof.leading_text,
            area_preserving=proof.area_preserving,
            convergence_order=proof.convergence_order,
            convergence_decided=proof.convergence_decided,
            witness={name: text(value) for name, value in proof.witness.items()},
            enclosure=proof.enclosure,
            domain=proof.domain.texts,
            where=proof.domain.prose,
            **more,
            checked_by=_marks(proof, hamiltonian, scheme) if self.formulas else (),
            seconds=time.perf_counter() - begun,
        )


def _marks(
    proof: Proof | SymplecticProof, hamiltonian: Hamiltonian, scheme: Scheme
) -> tuple[Prose, ...]:
    """Who else checked it."""
    from verify.proof.checked import marks
    from verify.proof.checked.proved import DEFECT, MAP, of_one_hamiltonian

    return marks(of_one_hamiltonian(proof, hamiltonian, scheme, DEFECT | MAP))


def _in_plane(
    hamiltonian: Hamiltonian, scheme: Scheme, formulas: bool
) -> tuple[Proof, dict[str, Any]]:
    """The proof and what is written out beside it."""
    step_map = scheme.step_map(hamiltonian)
    proof = prove(step_map, scheme)
    written = _written(step_map) if formulas else dict.fromkeys(_FORMULAS)
    symbolic = _symbolic(hamiltonian, scheme, proof.order) if formulas else None
    return proof, {**written, "symbolic": symbolic}


def _in_degrees(
    hamiltonian: Hamiltonian, scheme: Scheme, _: bool
) -> tuple[SymplecticProof, dict[str, Any]]:
    """The proof and its form S; closed forms are not written out."""
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
    written = dict.fromkeys(_FORMULAS) | {"delta_j": "0" if proof.symplectic else None}
    return proof, {**written, "form": form}


def _written(step_map: StepMap) -> dict[str, Any]:
    """The map, its Jacobian and ΔJ as texts, each None where it is too large."""
    found: dict[str, Any] = dict.fromkeys(_FORMULAS)
    found["delta_j"] = step_map.delta_j_text
    if (closed := step_map.closed) is not None:
        elements = (closed.p_next, closed.q_next, *closed.jacobian)
        p_next, q_next, a, b, c, d = (to_text(grouped(closed.ring, x)) for x in elements)
        found |= {"p_next": p_next, "q_next": q_next, "jacobian": ((a, b), (c, d))}
    return found


def _symbolic(hamiltonian: Hamiltonian, scheme: Scheme, order: int | None) -> Formulas | None:
    """The same with symbols for long values; None where no value is long.

    A leading coefficient is given where it is of the same order: for a value of its own a
    parameter may have another one.
    """
    long = tuple(name for name, value in hamiltonian.values if _digits(value) >= _LONG)
    if not long:
        return None
    kept = tuple((name, value) for name, value in hamiltonian.values if name not in long)
    step_map = scheme.step_map(replace(hamiltonian, values=kept))
    proof = prove(step_map, scheme)
    same = order is not None and proof.order == order
    leading = proof.first.text if same else None
    return Formulas(symbols=long, leading=leading, **_written(step_map))


def _digits(value: Fraction) -> int:
    return max(len(str(abs(value.numerator))), len(str(value.denominator)))
