"""The scheme's step map is this one; `q_next` may use p_next."""

from typing import Literal

from verify.algebra.formula import symbol
from verify.claims.base_claim import Findings
from verify.claims.formula_claims import FormulaClaim, condition_text, gaps
from verify.effort import limit_effort
from verify.proof.order_for_one_h import convergence_of
from verify.prose import Formula, prose
from verify.scenes.results.claim import ClaimResult


class StepMapClaim(FormulaClaim):
    """p′ and q′ as printed."""

    kind: Literal["step_map"]
    p_next: str
    """p′ in p, q, h and parameters."""
    q_next: str
    """q′ likewise; it may use `p_next`."""

    def formulas(self) -> dict[str, str]:
        return {"p_next": self.p_next, "q_next": self.q_next}

    def judge(self, findings: Findings) -> ClaimResult:
        step_map, read, domain = self.read(findings)
        with limit_effort("q_next", self.q_next, "to put p_next into it"):
            q_next = read["q_next"].xreplace({symbol("p_next"): read["p_next"]})
        pairs = [("p′", read["p_next"], step_map.p_next), ("q′", q_next, step_map.q_next)]
        differences = gaps(step_map, pairs, domain)
        if any(gap.decision.zero is not True for gap in differences):
            return self.from_gaps(differences, "", domain)
        order = convergence_of(step_map).order
        holds = prose(
            f"p′ and q′ are those of {self.scheme}, term by term, and agree with the exact flow up "
            "to ", "every order looked at" if order is None else Formula(f"h^{order}"),
            condition_text(domain),
        )  # fmt: skip
        return self.from_gaps(differences, holds, domain)


CLAIM = StepMapClaim
