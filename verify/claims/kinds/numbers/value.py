"""MSE, or Λ, of one run as printed; or its lg, for Λ that of |Λ|."""

from typing import Literal, Self

from pydantic import model_validator

from verify.claims.base_claim import Findings
from verify.claims.quantities import QUANTITIES, PrintedDecimal, all_hold, format_value, holds
from verify.claims.run_claims import RunClaim
from verify.errors import NOT_GIVEN, InputError
from verify.prose import Number, number, prose
from verify.scenes.results.claim import ClaimResult

_MORE_DIGITS = 3  # digits beyond those that are printed
_RESULTS = {
    True: "which rounds to",
    False: "which does not round to",
    None: "not known to round to",
}


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
        (run, *other_runs), *other_rows = self.run_rows(findings)
        if other_runs or other_rows:
            raise InputError(
                f"claim {self.id}", NOT_GIVEN, "speaks of one run; give step_size, q and p"
            )
        rounds = holds(run, quantity, printed)
        digits = format_value(run, quantity, len(printed.partition("e")[0]) + _MORE_DIGITS)
        evidence = prose(
            f"{QUANTITIES[quantity].label} = ", number(digits), f", {_RESULTS[rounds]} ",
            Number(printed), f", in {run.steps} steps",
        )  # fmt: skip
        return self.result(all_hold([rounds]), evidence)


CLAIM = ValueClaim
