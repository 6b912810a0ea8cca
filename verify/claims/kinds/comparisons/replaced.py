"""Claims that hold with another number in place of the MSE, such as 1/N.

This identifies a printed number that is not the MSE: with it in place of the MSE, the paper's
statements on the MSE hold.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Literal, Self

from pydantic import model_validator

from verify.algebra.embedding import embed
from verify.algebra.enclosure import enclose_over
from verify.algebra.formula import parse
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.arb import ball, midpoint_and_radius, rational_ball
from verify.claims.base_claim import Findings
from verify.claims.quantities import NoValueError, all_hold
from verify.claims.run_claims import AgainClaim
from verify.prose import Formula, prose
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.run import RunResult
from verify.studies.kinds.grid import grid_tasks
from verify.verdict import Verdict

_NAMES = ("mse", "N", "h")


class ReplacedClaim(AgainClaim):
    """Claims of a scene's runs, with this formula in place of MSE."""

    kind: Literal["replaced"]
    mse: str
    """The number in place of MSE: a formula in N, h and mse."""

    @model_validator(mode="after")
    def _check_formula(self) -> Self:
        parse(self.mse, _NAMES, source="mse")
        return self

    def quantities(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(name for claim in self.claims() for name in claim.quantities()))

    def observables(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(("mse", *super().observables())))

    def compare(self, findings: Findings) -> ClaimResult:
        tasks = grid_tasks(findings.scene_of(self), self.scheme)
        runs = ((task.key, findings.results[task.key]) for task in tasks)
        formula = embed([parse(self.mse, _NAMES, source="mse")], _NAMES)
        changed_runs = {
            k: _with_mse(run, *formula) for k, run in runs if isinstance(run, RunResult)
        }
        pairs = self.compare_twice(findings, changed_runs)
        introduction = prose("with ", Formula(self.mse), " in place of MSE: ")
        if len(pairs) == 1:
            ((_, after),) = pairs
            return self.result(after.verdict, introduction + after.evidence, after.details)
        details = [["claim", "of MSE", prose("of ", Formula(self.mse))], *self.rows(pairs)]
        verdicts = [after.verdict for _, after in pairs]
        holds = [None if v is Verdict.UNDECIDED else v.holds for v in verdicts]
        evidence = introduction + f"{holds.count(True)} of {len(pairs)} claims hold"
        return self.result(all_hold(holds), evidence, details)


def _with_mse(run: RunResult, ring: Ring, elements: Sequence[Poly]) -> RunResult:
    """Return the run with the formula's value, in N, h and mse, in place of its MSE."""
    if run.status != "finished":
        raise NoValueError(run)
    numbers = {"N": Fraction(run.steps), "h": Fraction(run.step_size)}
    enclosures = {name: rational_ball(x) for name, x in numbers.items()}
    value = enclose_over(ring, elements[0], {**enclosures, "mse": ball(run.values["mse"])})
    if value is None or not value.is_finite():
        raise NoValueError(run)
    mse = Value.from_bound(*midpoint_and_radius(value), run.digits)
    return run.model_copy(update={"values": {**run.values, "mse": mse}})


CLAIM = ReplacedClaim
