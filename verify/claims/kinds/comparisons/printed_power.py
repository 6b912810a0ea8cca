"""The printed values are a higher-order infinitesimal than a power of the step size: o(h^power).

The printed numbers alone decide, without a run. The claim is refuted if each of them, divided by
h^power, is one and the same constant to all printed digits; if the quotients differ, so few of them
decide nothing.
"""

from fractions import Fraction
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from verify.arithmetic.arb import Ball, bounds, format_fixed, lg, precision, rational_ball
from verify.claims.base_claim import Claim, Findings
from verify.claims.quantities import PrintedRow, places
from verify.errors import InputError
from verify.prose import Formula, Number, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.values import StepSize
from verify.verdict import Verdict


class PrintedPowerClaim(Claim):
    """A row of printed logarithms, one a step size."""

    on_scene = False
    obstacle = "printed numbers say nothing of drawn Hamiltonians"
    kind: Literal["printed_power"]
    scheme: str = ""
    """None: only what is printed is looked at."""
    step_sizes: Annotated[tuple[StepSize, ...], Field(min_length=2)]
    """The step sizes of the row."""
    lg_printed: PrintedRow
    """The printed logarithms, one a step size."""
    beyond_power: Annotated[int, Field(ge=0, le=64, strict=True)]
    """The power of the step size."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        if len(self.lg_printed) != len(self.step_sizes):
            problem = f"give {len(self.step_sizes)} values, one a step size"
            raise InputError("lg_printed", len(self.lg_printed), problem)
        return self

    def judge(self, findings: Findings) -> ClaimResult:
        with precision():
            quotients = [
                (Fraction(cell), Fraction(10) ** -places(cell) / 2, self._lg_power(h))
                for cell, h in zip(self.lg_printed, self.step_sizes, strict=True)
            ]
            # lg of the quotient lies between these bounds: the printed logarithm is rounded, and
            # may be off by half a unit of its last digit.
            lows = [bounds(rational_ball(x - half) - lg_h)[1] for x, half, lg_h in quotients]
            highs = [bounds(rational_ball(x + half) - lg_h)[0] for x, half, lg_h in quotients]
            x, _, lg_h = quotients[0]
            constant = format_fixed(rational_ball(x) - lg_h, places(self.lg_printed[0]))
        power = "h" if self.beyond_power == 1 else f"h^{self.beyond_power}"
        if max(lows) <= min(highs):
            evidence = prose(
                "each printed value divided by ", Formula(power), " has the same logarithm, ",
                Number(constant), ", within the rounding of what is printed, for all "
                f"{len(quotients)} step sizes: they fall as that does, and no faster",
            )  # fmt: skip
            return self.result(Verdict.REFUTED, evidence)
        evidence = prose("the printed values divided by ", Formula(power), " are not all the same")
        return self.result(Verdict.UNDECIDED, evidence)

    def _lg_power(self, h: Fraction) -> Ball:
        return self.beyond_power * lg(rational_ball(h))


CLAIM = PrintedPowerClaim
