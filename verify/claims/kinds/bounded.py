"""|Λ| ≤ bound after every step of every run. max |Λ| carries the error bound of Λ."""

from typing import Annotated, Literal

from pydantic import Field

from verify.arithmetic.arb import Ball, format_ball, rational_ball
from verify.arithmetic.exact import text
from verify.claims.base_claim import Findings
from verify.claims.quantities import QUANTITIES, all_hold, sign, start_of
from verify.claims.run_claims import RunClaim
from verify.prose import Number, number, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.scene import Scene
from verify.scenes.values import ExactNumber

_MOST_DIGITS = 200  # of runs that are made again


class BoundedClaim(RunClaim):
    """A bound of |Λ| along whole runs."""

    compares = ("lambda_max",)
    separate_runs = True
    obstacle = ""
    kind: Literal["bounded"]
    bound: Annotated[ExactNumber, Field(ge=0)]
    """The bound of |Λ|."""

    def refined_scene(self, scene: Scene) -> Scene | None:
        """Return the scene with twice as many digits, for values too close to the bound."""
        grid = scene.grid
        if grid is None or grid.digits is None or grid.digits > _MOST_DIGITS // 2:
            return None
        finer_grid = grid.model_copy(update={"digits": 2 * grid.digits})
        return scene.model_copy(update={"grid": finer_grid})

    def compare(self, findings: Findings) -> ClaimResult:
        runs = [run for row in self.run_rows(findings) for run in row]
        largest = [QUANTITIES["lambda_max"](run) for run in runs]
        # Compared exactly as balls: a float would be too coarse near the bound.
        bound = rational_ball(self.bound)
        holds = [sign(bound - x, zero=True) for x in largest]
        wrong = [i for i, answer in enumerate(holds) if answer is False]
        index = wrong[0] if wrong else max(range(len(runs)), key=lambda i: float(largest[i].mid()))
        run, comparison = runs[index], ""
        if len(runs) > 1:
            comparison = f", the greatest of {len(runs)} runs"
            comparison = f", the first of {len(wrong)} beyond it" if wrong else comparison
        evidence = prose(
            "max |Λ| = ", number(_format_beside(largest[index], bound)),
            f" over {run.steps} steps of ", Number(run.step_size), " from ", start_of(run),
            comparison, "; bound ", Number(text(self.bound)),
        )  # fmt: skip
        return self.result(all_hold(holds), evidence)


def _format_beside(x: Ball, bound: Ball) -> str:
    """Format x with six digits, or with as many as show that it differs from the bound."""
    texts = ((format_ball(x, n), format_ball(bound, n)) for n in (6, 12, 25, 50, 100, _MOST_DIGITS))
    return next((x for x, bound_text in texts if x != bound_text), format_ball(x))


CLAIM = BoundedClaim
