"""The one quantity is smaller than the other at each step size and initial value."""

from typing import Literal

from verify.arithmetic.arb import format_ball, is_representable
from verify.claims.base_claim import Findings
from verify.claims.quantities import QUANTITIES, Quantity, all_hold, middle, sign
from verify.claims.run_claims import RunClaim
from verify.prose import number, prose
from verify.scenes.results.claim import ClaimResult


class LessClaim(RunClaim):
    """Two quantities of every run, compared."""

    obstacle = ""
    kind: Literal["less"]
    quantity: Quantity
    """The smaller one."""
    than: Quantity
    """The larger one."""

    def quantities(self) -> tuple[str, ...]:
        return (self.quantity, self.than)

    def compare(self, findings: Findings) -> ClaimResult:
        rows = self.run_rows(findings)
        smaller, larger = QUANTITIES[self.quantity], QUANTITIES[self.than]
        runs = [run for row in rows for run in row]
        verdicts = [sign(larger(run) - smaller(run)) for run in runs]
        # A quotient whose denominator may be 0 has no bound, and is left out of the evidence alone.
        ratios = [r for r in (smaller(run) / larger(run) for run in runs) if is_representable(r)]
        largest = format_ball(max(ratios, key=middle), 2) if ratios else "unknown"
        evidence = prose(
            f"{smaller.label} is at most ", number(largest),
            f" times {larger.label} in {len(ratios)} of {len(runs)} runs",
        )  # fmt: skip
        return self.result(all_hold(verdicts), evidence)


CLAIM = LessClaim
