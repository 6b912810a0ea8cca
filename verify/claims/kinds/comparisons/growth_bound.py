"""|Λ| ≤ c1 h^η + c2 h^(η+1) T at the end of every run, as the growth law of even η has it."""

from fractions import Fraction
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from verify.arithmetic.arb import format_ball, rational_ball
from verify.claims.base_claim import Findings
from verify.claims.quantities import QUANTITIES, all_hold, middle, sign, start_of
from verify.claims.run_claims import RunClaim
from verify.errors import InputError
from verify.prose import Number, number, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.values import ExactNumber


class GrowthBoundClaim(RunClaim):
    """A bound of |Λ| that grows with the length T of the run."""

    compares = ("lambda",)
    obstacle = "its constants are of the orbits of its own scene"
    kind: Literal["growth_bound"]
    eta: Annotated[int, Field(ge=1, le=20, strict=True)]
    """The power of h at which Λ is bounded."""
    c1: Annotated[ExactNumber, Field(ge=0)]
    """The constant of h^η."""
    c2: Annotated[ExactNumber, Field(ge=0)]
    """The constant of h^(η+1) T."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        # The evidence compares Λ with the bound by their quotient.
        if self.c1 == self.c2 == 0:
            raise InputError("c1, c2", "0", "give one that is not 0; `bounded` takes `bound = 0`")
        return self

    def compare(self, findings: Findings) -> ClaimResult:
        details: list[list[str]] = [["initial value", "h", "T", "|Λ|", "bound"]]
        verdicts, shares = [], []
        for run in (run for row in self.run_rows(findings) for run in row):
            h = Fraction(run.step_size)
            bound = rational_ball(h**self.eta * (self.c1 + self.c2 * h * (h * run.steps)))
            value = abs(QUANTITIES["lambda"](run))
            verdicts.append(sign(bound - value, zero=True))
            shares.append(value / bound)
            cells = (number(format_ball(x, 4)) for x in (value, bound))
            length = Number(str(h * run.steps))
            details.append([start_of(run), Number(run.step_size), length, *cells])
        largest = number(format_ball(max(shares, key=middle), 3))
        evidence = prose("|Λ| is at most ", largest, f" times the bound in {len(shares)} runs")
        return self.result(all_hold(verdicts), evidence, details)


CLAIM = GrowthBoundClaim
