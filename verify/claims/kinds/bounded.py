"""|Λ| ≤ bound after every step of every run. max |Λ| carries the error bound of Λ."""

from typing import Annotated, Literal

from pydantic import Field

from verify.arithmetic.arb import rational_ball, shown
from verify.arithmetic.exact import text
from verify.claims.findings import Findings
from verify.claims.on_runs import RunClaim
from verify.claims.runs import QUANTITIES, all_hold, sign, start_of
from verify.prose import Number, number, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.values import Number as ExactNumber


class BoundedClaim(RunClaim):
    """A bound of |Λ| along whole runs."""

    always_own = True
    only_here = ""
    kind: Literal["bounded"]
    bound: Annotated[ExactNumber, Field(ge=0)]

    def quantities(self) -> tuple[str, ...]:
        return ("lambda_max",)

    def compare(self, findings: Findings) -> ClaimResult:
        runs = [run for row in self.run_rows(findings) for run in row]
        largest = [QUANTITIES["lambda_max"](run) for run in runs]
        bound = rational_ball(self.bound)
        holds = [sign(bound - x, zero=True) for x in largest]
        wrong = [i for i, held in enumerate(holds) if held is False]
        at = wrong[0] if wrong else max(range(len(runs)), key=lambda i: float(largest[i].mid()))
        run, among = runs[at], ""
        if len(runs) > 1:
            among = f", the greatest of {len(runs)} runs"
            among = f", the first of {len(wrong)} beyond it" if wrong else among
        evidence = prose(
            "max |Λ| = ", number(shown(largest[at])), f" over {run.steps} steps of ",
            Number(run.step_size), " from ", start_of(run), among, "; bound ",
            Number(text(self.bound)),
        )  # fmt: skip
        return self.result(all_hold(holds), evidence)


CLAIM = BoundedClaim
