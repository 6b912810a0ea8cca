"""At each step size the quantity varies over the initial values by this factor at most."""

from fractions import Fraction
from typing import Annotated, Literal

from pydantic import Field

from verify.arithmetic.arb import bounds, in_reach, shown
from verify.arithmetic.exact import decimal, text
from verify.claims.findings import Findings
from verify.claims.on_runs import QuantityClaim
from verify.claims.runs import QUANTITIES, all_hold, middle
from verify.prose import Number, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.values import Number as ExactNumber


class SpreadClaim(QuantityClaim):
    """How far values from several initial values lie apart."""

    only_here = "a spread is over the initial values of its own scene"
    kind: Literal["spread"]
    factor: Annotated[ExactNumber, Field(ge=1)]
    """The largest quotient of two of its values at one step size."""

    def compare(self, findings: Findings) -> ClaimResult:
        rows, quantity = self.run_rows(findings), QUANTITIES[self.quantity]
        details = [["step size", "least", "greatest", "factor"]]
        verdicts: list[bool | None] = []
        worst = Fraction(0)
        for column in zip(*rows, strict=True):
            values = [quantity(run) for run in column]
            ends = [bounds(v) if in_reach(v) else None for v in values]
            known = [e for e in ends if e is not None and e[0] > 0]
            if len(known) < len(values):
                verdicts.append(None)
                details.append([column[0].step_size, "unknown", "unknown", "unknown"])
                continue
            # The factor is surely reached, and surely not passed, whatever the values are inside.
            reached = max(low for low, _ in known) / min(high for _, high in known)
            passed = max(high for _, high in known) / min(low for low, _ in known)
            within = passed <= self.factor
            verdicts.append(None if not within and reached <= self.factor else within)
            low, high = min(values, key=middle), max(values, key=middle)
            details.append([column[0].step_size, shown(low), shown(high), shown(high / low, 3)])
            worst = max(worst, reached)
        evidence = prose(
            f"{quantity.label} varies over the initial values by a factor of up to ",
            Number(decimal(worst, 2)), " at one step size (allowed here: ",
            Number(text(self.factor)), ")",
        )  # fmt: skip
        return self.result(all_hold(verdicts), evidence, details)


CLAIM = SpreadClaim
