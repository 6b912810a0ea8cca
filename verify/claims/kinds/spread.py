"""The quantity varies over the initial values by at most this factor at each step size."""

from fractions import Fraction
from typing import Annotated, Literal

from pydantic import Field

from verify.arithmetic.arb import bounds, format_ball, is_representable
from verify.arithmetic.exact import decimal, text
from verify.claims.base_claim import Findings
from verify.claims.quantities import QUANTITIES, all_hold, middle
from verify.claims.run_claims import QuantityClaim
from verify.prose import Number, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.values import ExactNumber


class SpreadClaim(QuantityClaim):
    """The range of a quantity over the initial values."""

    obstacle = "a spread is over the initial values of its own scene"
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
            ends = [bounds(v) if is_representable(v) else None for v in values]
            positive_ends = [e for e in ends if e is not None and e[0] > 0]
            # A quotient of a value that may be 0 has no bound.
            if len(positive_ends) < len(values):
                verdicts.append(None)
                details.append([column[0].step_size, "unknown", "unknown", "unknown"])
                continue
            # Whatever the values in their balls are, the factor is at least `least_factor` and at
            # most `greatest_factor`.
            least_factor = max(low for low, _ in positive_ends) / min(
                high for _, high in positive_ends
            )
            greatest_factor = max(high for _, high in positive_ends) / min(
                low for low, _ in positive_ends
            )
            holds = greatest_factor <= self.factor
            verdicts.append(None if not holds and least_factor <= self.factor else holds)
            low, high = min(values, key=middle), max(values, key=middle)
            details.append(
                [
                    column[0].step_size,
                    format_ball(low),
                    format_ball(high),
                    format_ball(high / low, 3),
                ]
            )
            worst = max(worst, least_factor)
        evidence = prose(
            f"{quantity.label} varies over the initial values by a factor of up to ",
            Number(decimal(worst, 2)), " at one step size (the claim: at most ",
            Number(text(self.factor)), ")",
        )  # fmt: skip
        return self.result(all_hold(verdicts), evidence, details)


CLAIM = SpreadClaim
