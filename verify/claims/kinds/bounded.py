"""|Λ| ≤ bound after every step of every run. max |Λ| carries the error bound of Λ."""

from typing import Annotated, Literal

from pydantic import Field

from verify.arithmetic.arb import Ball, rational_ball, shown
from verify.arithmetic.exact import text
from verify.claims.findings import Findings
from verify.claims.on_runs import RunClaim
from verify.claims.runs import QUANTITIES, all_hold, sign, start_of
from verify.prose import Number, number, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.scene import Scene
from verify.scenes.values import Number as ExactNumber

_MOST_DIGITS = 200  # of runs that are made again


class BoundedClaim(RunClaim):
    """A bound of |Λ| along whole runs."""

    compares = ("lambda_max",)
    always_own = True
    only_here = ""
    kind: Literal["bounded"]
    bound: Annotated[ExactNumber, Field(ge=0)]
    """What |Λ| is not to pass."""

    def closer(self, scene: Scene) -> Scene | None:
        """Twice as many digits, where max |Λ| and the bound share all that are known."""
        grid = scene.grid
        if grid is None or grid.digits is None or grid.digits > _MOST_DIGITS // 2:
            return None
        more = grid.model_copy(update={"digits": 2 * grid.digits})
        return scene.model_copy(update={"grid": more})

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
            "max |Λ| = ", number(_told(largest[at], bound)), f" over {run.steps} steps of ",
            Number(run.step_size), " from ", start_of(run), among, "; bound ",
            Number(text(self.bound)),
        )  # fmt: skip
        return self.result(all_hold(holds), evidence)


def _told(x: Ball, bound: Ball) -> str:
    """x with six digits, or with so many that it is seen to differ from the bound."""
    texts = ((shown(x, n), shown(bound, n)) for n in (6, 12, 25, 50, 100, _MOST_DIGITS))
    return next((x for x, other in texts if x != other), shown(x))


CLAIM = BoundedClaim
