"""The Jacobian's entries (Eq. 12), by rows."""

from typing import Literal

from verify.claims.base_claim import Findings
from verify.claims.formula_claims import FormulaClaim, condition_text, gaps
from verify.scenes.results.claim import ClaimResult

_NAMES = (("∂p′/∂p", "∂p′/∂q"), ("∂q′/∂p", "∂q′/∂q"))
_CELLS = ((0, 0), (0, 1), (1, 0), (1, 1))


class JacobianClaim(FormulaClaim):
    """J as printed."""

    kind: Literal["jacobian"]
    entries: tuple[tuple[str, str], tuple[str, str]]
    """∂p′/∂p, ∂p′/∂q and ∂q′/∂p, ∂q′/∂q: p stands before q."""

    def formulas(self) -> dict[str, str]:
        return {f"entries.{i}.{j}": self.entries[i][j] for i, j in _CELLS}

    def judge(self, findings: Findings) -> ClaimResult:
        step_map, read, domain = self.read(findings)
        computed = step_map.jacobian
        pairs = [(_NAMES[i][j], read[f"entries.{i}.{j}"], computed[i, j]) for i, j in _CELLS]
        holds = "all four entries are those of the exact Jacobian" + condition_text(domain)
        return self.from_gaps(gaps(step_map, pairs, domain), holds, domain)


CLAIM = JacobianClaim
