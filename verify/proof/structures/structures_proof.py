"""The proof of all structures that are claimed to be kept by one step map."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from verify.notebook import cut, html_table
from verify.proof.order_for_one_h import convergence_of_scheme
from verify.proof.structures.structure_order import StructureProof, prove_structure
from verify.prose import Prose, join_prose, prose
from verify.schemes.maps.step_map import StepMap
from verify.schemes.scheme import Scheme
from verify.structures.reading import ClaimedStructure
from verify.verdict import Verdict

_FROM_BEST = (
    Verdict.PROVED, Verdict.ENCLOSED, Verdict.MEASURED, Verdict.UNDECIDED, Verdict.REFUTED,
)  # fmt: skip


@dataclass(frozen=True)
class StructuresProof:
    """The proof of what a step map keeps: `keeps` has one for each requested structure.

    `verdict` is the worst of theirs, and UNDECIDED at best for a map that does not follow the flow:
    a step that does nothing keeps everything. `convergence_order` is as in
    `verify.proof.proof_for_one_h.Proof`. A proof for every H has no `step_map`; `quantifier`
    says of which H it is, in words.
    """

    verdict: Verdict
    reason: Prose
    keeps: tuple[StructureProof, ...]
    convergence_order: int | None
    convergence_decided: bool
    step_map: StepMap | None = field(default=None, repr=False, compare=False)
    quantifier: str = ""

    def __repr__(self) -> str:
        return f"StructuresProof({self.verdict}: {cut(str(self.reason))})"

    def _repr_html_(self) -> str:
        rows = [(x.structure.label, f"{x.verdict}: {x.reason}") for x in self.keeps]
        return html_table("What is kept", (), rows)


def prove_structures(
    step_map: StepMap, claims: Sequence[ClaimedStructure], scheme: Scheme | None = None
) -> StructuresProof:
    """Prove, for each claimed structure, the order of its defect, and judge the claims.

    Raises InputError if a structure is not one of the exact flow.
    """
    proofs = tuple(prove_structure(step_map, x.structure, scheme, x.order) for x in claims)
    convergence, _ = convergence_of_scheme(step_map, scheme)
    verdict, reason = judge_all(proofs, convergence.order)
    return StructuresProof(
        verdict, reason, proofs, convergence.order, convergence.decided, step_map
    )


def judge_all(
    proofs: Sequence[StructureProof], convergence_order: int | None
) -> tuple[Verdict, Prose]:
    """Return the worst verdict with its reasons; see `StructuresProof`."""
    verdict = max((x.verdict for x in proofs), key=_FROM_BEST.index)
    reasons = [prose(x.structure.label, ": ", x.reason) for x in proofs if x.verdict is verdict]
    if convergence_order is not None and convergence_order < 1:
        verdict = max(verdict, Verdict.UNDECIDED, key=_FROM_BEST.index)
        reasons.append(Prose("the map is no step of this system: it does not agree up to h"))
    return verdict, join_prose("; ", reasons)
