"""MSE, or Λ, of one run as printed; or its lg, for Λ that of |Λ|."""

from typing import Literal, Self

from pydantic import model_validator

from verify.claims.base_claim import Findings
from verify.claims.quantities import (
    MORE_DIGITS,
    QUANTITIES,
    ROUNDING,
    PrintedDecimal,
    all_hold,
    format_value,
    holds,
)
from verify.claims.run_claims import RunClaim
from verify.errors import NOT_GIVEN, InputError
from verify.prose import Number, number, prose
from verify.scenes.results.claim import ClaimResult


class ValueClaim(RunClaim):
    """One printed number of one run."""

    one_run = True
    separate_runs = True
    kind: Literal["mse", "lambda"]
    printed: PrintedDecimal | None = None
    """The number as printed; or `lg_printed`."""
    lg_printed: PrintedDecimal | None = None
    """Its logarithm to the base 10 as printed; or `printed`."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        if (self.printed is None) == (self.lg_printed is None):
            raise InputError("printed, lg_printed", NOT_GIVEN, "give one of the two")
        return self

    def quantities(self) -> tuple[str, ...]:
        if self.lg_printed is None:
            return (self.kind,)
        return ("lg_mse" if self.kind == "mse" else "lg_abs_lambda",)

    def printed_texts(self) -> list[str]:
        return [self.printed or self.lg_printed or ""]

    def compare(self, findings: Findings) -> ClaimResult:
        (quantity,), (printed,) = self.quantities(), self.printed_texts()
        run = self.only_run(findings)
        rounds = holds(run, quantity, printed)
        digits = format_value(run, quantity, len(printed.partition("e")[0]) + MORE_DIGITS)
        evidence = prose(
            f"{QUANTITIES[quantity].label} = ", number(digits), f", {ROUNDING[rounds]} ",
            Number(printed), f", in {run.steps} steps",
        )  # fmt: skip
        return self.result(all_hold([rounds]), evidence)


CLAIM = ValueClaim
