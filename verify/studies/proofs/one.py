"""The task of a proof for one H and one scheme."""

import time
from typing import Literal

from verify.algebra.formula import to_text
from verify.arithmetic.exact import text
from verify.execution.keeping import Keeper
from verify.execution.task import SchemeTask
from verify.proof.order import prove
from verify.scenes.results.proof import ProofResult
from verify.schemes import get
from verify.schemes.step_map import grouped

_COST = 10_000_000  # of a proof, about


class ProofTask(SchemeTask):
    """Prove the order of ΔJ and of the map for one H and one scheme.

    `formulas`: ΔJ, the map and its Jacobian are also written out, which may take longer.
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
        closed, p_next, q_next, jacobian = step_map.closed, None, None, None
        if closed is not None and self.formulas:
            elements = (closed.p_next, closed.q_next, *closed.jacobian)
            p_next, q_next, a, b, c, d = (to_text(grouped(closed.ring, x)) for x in elements)
            jacobian = (a, b), (c, d)
        return ProofResult(
            **hamiltonian.texts,
            scheme=self.scheme,
            verdict=proof.verdict,
            reason=proof.reason,
            order=proof.order,
            leading=proof.first.text,
            delta_j=step_map.delta_j_text if self.formulas else None,
            area_preserving=proof.area_preserving,
            convergence_order=proof.convergence_order,
            witness={name: text(value) for name, value in proof.witness.items()},
            enclosure=proof.enclosure,
            domain=proof.domain.texts,
            where=proof.domain.prose,
            p_next=p_next,
            q_next=q_next,
            jacobian=jacobian,
            seconds=time.perf_counter() - begun,
        )
