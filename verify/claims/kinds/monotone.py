"""For each initial value the quantity does this as the step size increases."""

from fractions import Fraction
from itertools import pairwise
from typing import Any, Literal

from verify.arithmetic.arb import format_ball
from verify.claims.base_claim import Findings
from verify.claims.quantities import QUANTITIES, all_hold, sign, start_of, table_of
from verify.claims.run_claims import QuantityClaim
from verify.prose import Number, number, prose
from verify.scenes.results.claim import ClaimResult
from verify.verdict import Verdict


class MonotoneClaim(QuantityClaim):
    """A quantity that increases, or decreases, with the step size."""

    obstacle = ""
    kind: Literal["monotone"]
    direction: Literal["increases", "decreases"]
    """The direction of the quantity as the step size increases."""

    def compare(self, findings: Findings) -> ClaimResult:
        rows = self.run_rows(findings)
        quantity, direction = QUANTITIES[self.quantity], 1 if self.direction == "increases" else -1
        label = QUANTITIES[self.quantity].label
        verdicts: list[bool | None] = []
        counterexamples = []
        for finer, coarser in (pair for row in rows for pair in pairwise(row)):
            gap = direction * (quantity(coarser) - quantity(finer))
            verdicts.append(sign(gap))
            # Only a certain decrease is shown as a counterexample; overlapping balls are not.
            if gap < 0:
                counterexamples.append(prose(
                    "from ", number(format_ball(quantity(finer), 4)), " at h = ",
                    Number(finer.step_size), " to ", number(format_ball(quantity(coarser), 4)),
                    " at h = ", Number(coarser.step_size), " with ", start_of(finer),
                ))  # fmt: skip
        total = f"{len(verdicts)} neighbouring pairs"
        evidence = prose(f"{label} {self.direction} between all {total} of step sizes")
        if counterexamples:
            opposite = "decreases" if direction > 0 else "increases"
            count = f"{len(counterexamples)} of {total} of step sizes"
            example = ", for example" if len(counterexamples) > 1 else ""
            evidence = prose(f"{label} {opposite} in {count}: ", counterexamples[0], example)
        elif all_hold(verdicts) is Verdict.UNDECIDED:
            evidence = prose(f"{verdicts.count(None)} of {total} of step sizes are not told apart")
        return self.result(all_hold(verdicts), evidence, table_of(rows, self.quantity))

    def drawn_runs(self, step_size: Fraction, steps: int) -> dict[str, Any]:
        """Return the keys of two runs over one time, whose step sizes it compares."""
        return {"step_sizes": (step_size / 2, step_size), "time": steps * step_size}


CLAIM = MonotoneClaim
