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
from verify.proof.proof import Proof
from verify.prose import Prose
from verify.scenes.results.proof import FormResult, Formulas, ProofResult
from verify.schemes import get
from verify.schemes.maps.step_map import StepMap, grouped
from verify.schemes.scheme import Scheme
from verify.schemes.steps.two_form import MOST_TERMS

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
        step_map = scheme.step_map(hamiltonian)
        proof = prove(step_map, scheme)
        more = _beside(proof, scheme, self.formulas)
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


def _marks(proof: Proof, hamiltonian: Hamiltonian, scheme: Scheme) -> tuple[Prose, ...]:
    """Who else checked it."""
    from verify.proof.checked import marks
    from verify.proof.checked.proved import DEFECT, MAP, of_one_hamiltonian

    return marks(of_one_hamiltonian(proof, hamiltonian, scheme, DEFECT | MAP))


def _beside(proof: Proof, scheme: Scheme, formulas: bool) -> dict[str, Any]:
    """What is written out beside it: in the plane closed forms, in n degrees of freedom S."""
    if not proof.planar:
        written = dict.fromkeys(_FORMULAS) | {"delta_j": "0" if proof.symplectic else None}
        return {**written, "form": _form(proof)}
    hamiltonian = proof.step_map.hamiltonian
    written = _written(proof.step_map) if formulas else dict.fromkeys(_FORMULAS)
    symbolic = _symbolic(hamiltonian, scheme, proof.order) if formulas else None
    return {**written, "symbolic": symbolic}


def _form(proof: Proof) -> FormResult:
    """The leading coefficient of S, entry by entry where that is short."""
    leading = proof.first.form
    entries: tuple[tuple[str, str], ...] = ()
    if leading is not None and leading.length <= MOST_TERMS:
        each = leading.entries.items()
        entries = tuple((leading.called(at), leading.ring.text(x)) for at, x in each)
    return FormResult(
        symplectic=proof.symplectic,
        entries=entries,
        entry=proof.entry,
        volume_order=proof.volume_order,
        volume_leading=proof.volume_leading,
        telescopes=proof.telescopes,
        potential=proof.potential,
        why=proof.why,
    )


def _written(step_map: StepMap) -> dict[str, Any]:
    """The map, its Jacobian and ΔJ as texts, each None where it is too large."""
    found: dict[str, Any] = dict.fromkeys(_FORMULAS)
    found["delta_j"] = step_map.delta_j_text
    if (closed := step_map.closed) is not None:
        rows = closed.elements, *closed.jacobian
        texts = [tuple(to_text(grouped(closed.ring, x)) for x in row) for row in rows]
        (p_next, q_next), *jacobian = texts
        found |= {"p_next": p_next, "q_next": q_next, "jacobian": tuple(jacobian)}
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
