"""Closed form and order of ΔJ, for the scene's H and each of its schemes."""

import time
from dataclasses import replace
from fractions import Fraction
from typing import Any, Literal

from verify.algebra.expressions.formula_text import to_text
from verify.arithmetic.exact import text
from verify.execution.keeper import Keeper
from verify.execution.plan import Plan, Study, scene_name
from verify.execution.task import SchemeTask
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_one_h import prove
from verify.proof.proof_for_one_h import Proof
from verify.prose import Prose
from verify.scenes.results.proof_result import FormResult, Formulas, ProofResult
from verify.scenes.scene import Scene
from verify.schemes import get
from verify.schemes.maps.closed_form import group_by_powers
from verify.schemes.maps.step_map import StepMap
from verify.schemes.scheme import Scheme
from verify.schemes.steps.two_form import MOST_TERMS

_LONG = 12  # digits of a value that no formula is read with
_FORMULAS = ("delta_j", "p_next", "q_next", "jacobian")


class ProofTask(SchemeTask):
    """Prove the order of ΔJ and of the map for one H and one scheme.

    `formulas`: ΔJ, the map and its Jacobian are also written out, and the proof's other checkers
    are named, which may take longer.
    """

    result = ProofResult
    price = 10_000_000
    kind: Literal["proof"] = "proof"
    formulas: bool = True

    def compute(self, keeper: Keeper) -> ProofResult:
        """Return the proof for this H as a result."""
        hamiltonian, scheme = self.exact_hamiltonian(), get(self.scheme)
        start_time = time.perf_counter()
        step_map = scheme.step_map(hamiltonian)
        proof = prove(step_map, scheme)
        extra_fields = _extra_fields(proof, scheme, self.formulas)
        return ProofResult.from_object(
            proof,
            **hamiltonian.texts,
            scheme=self.scheme,
            leading=proof.leading_text,
            witness={name: text(value) for name, value in proof.witness.items()},
            domain=proof.domain.texts,
            where=proof.domain.prose,
            **extra_fields,
            checked_by=_mark_checkers(proof, hamiltonian, scheme) if self.formulas else (),
            seconds=time.perf_counter() - start_time,
        )


def _mark_checkers(proof: Proof, hamiltonian: Hamiltonian, scheme: Scheme) -> tuple[Prose, ...]:
    """Return the marks of those who also checked the proof."""
    from verify.proof.checked.proof_marks import marks
    from verify.proof.checked.proved_statement import DEFECT, MAP, statement_for_one_h

    return marks(statement_for_one_h(proof, hamiltonian, scheme, DEFECT | MAP))


def _extra_fields(proof: Proof, scheme: Scheme, formulas: bool) -> dict[str, Any]:
    """Return the fields written out in full: closed forms in the plane, S in n degrees."""
    if not proof.planar:
        texts = dict.fromkeys(_FORMULAS) | {"delta_j": "0" if proof.symplectic else None}
        return {**texts, "form": _describe_form(proof)}
    hamiltonian = proof.step_map.hamiltonian
    texts = _write_out(proof.step_map) if formulas else dict.fromkeys(_FORMULAS)
    symbolic = _write_with_symbols(hamiltonian, scheme, proof.order) if formulas else None
    return {**texts, "symbolic": symbolic}


def _describe_form(proof: Proof) -> FormResult:
    """Return the leading coefficient of S, entry by entry where that is short."""
    leading = proof.first.form
    entries: tuple[tuple[str, str], ...] = ()
    if leading is not None and leading.length <= MOST_TERMS:
        nonzero_entries = leading.entries.items()
        entries = tuple(
            (leading.entry_name(position), leading.ring.text(x)) for position, x in nonzero_entries
        )
    return FormResult.from_object(proof, entries=entries)


def _write_out(step_map: StepMap) -> dict[str, Any]:
    """Return the map, its Jacobian and ΔJ as texts, each None if it is too large."""
    fields: dict[str, Any] = dict.fromkeys(_FORMULAS)
    fields["delta_j"] = step_map.delta_j_text
    if (closed_form := step_map.closed) is not None:
        rows = closed_form.elements, *closed_form.jacobian
        texts = [tuple(to_text(group_by_powers(closed_form.ring, x)) for x in row) for row in rows]
        (p_next, q_next), *jacobian = texts
        fields |= {"p_next": p_next, "q_next": q_next, "jacobian": tuple(jacobian)}
    return fields


def _write_with_symbols(
    hamiltonian: Hamiltonian, scheme: Scheme, order: int | None
) -> Formulas | None:
    """Return the same with symbols for long values; None if no value is long.

    A leading coefficient is given where it is of the same order: for a value of its own a
    parameter may have another one.
    """
    # A parameter with a long value makes formulas unreadable, so that its symbol stays in them.
    long = tuple(name for name, value in hamiltonian.values if _digits(value) >= _LONG)
    if not long:
        return None
    kept_values = tuple((name, value) for name, value in hamiltonian.values if name not in long)
    step_map = scheme.step_map(replace(hamiltonian, values=kept_values))
    proof = prove(step_map, scheme)
    same = order is not None and proof.order == order
    leading = proof.first.text if same else None
    return Formulas(symbols=long, leading=leading, **_write_out(step_map))


def _digits(value: Fraction) -> int:
    return max(len(str(abs(value.numerator))), len(str(value.denominator)))


def proof_task(scene: Scene, scheme: str, *, formulas: bool = True) -> ProofTask:
    """Return the proof of one scheme for the scene's H; `formulas`: with ΔJ in closed form."""
    return ProofTask(**scene.hamiltonian_fields(), scheme=scheme, formulas=formulas)


def _need(plan: Plan, scene: Scene, scheme: str, _preserves: bool) -> None:
    plan.need(proof_task(scene, scheme), f"{scene_name(scene)}: closed form and order of ΔJ")


STUDY = Study(0, need_of_scheme=_need)
