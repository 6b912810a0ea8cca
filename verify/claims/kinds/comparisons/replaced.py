"""Claims that hold with another number in place of the MSE, such as 1/N.

What a printed number is, where it is not the MSE, is shown so: with it, what the paper says of the
MSE is so.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Literal, Self

from pydantic import model_validator

from verify.algebra.embedding import embed
from verify.algebra.enclosure import enclose_over
from verify.algebra.formula import parse
from verify.arithmetic.arb import Ball, ball, middle_and_radius, rational_ball
from verify.claims.again import AgainClaim
from verify.claims.findings import Findings
from verify.claims.runs import NoValueError
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
    """What stands in place of MSE: a formula in N, h and mse."""

    @model_validator(mode="after")
    def _check_formula(self) -> Self:
        parse(self.mse, _NAMES, source="mse")
        return self

    def quantities(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(name for each in self.claims() for name in each.quantities()))

    def observables(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(("mse", *super().observables())))

    def compare(self, findings: Findings) -> ClaimResult:
        tasks = grid_tasks(findings.scene_of(self), self.scheme)
        runs = {task.key: findings.results[task.key] for task in tasks}
        changed = {
            key: self._with_formula(run) if isinstance(run, RunResult) else run
            for key, run in runs.items()
        }
        again = Findings(findings.scenes, {**findings.results, **changed})
        both = [(each.compare(findings), each.compare(again)) for each in self.claims()]
        said = prose("with ", Formula(self.mse), " in place of MSE: ")
        if len(both) == 1:
            ((_, after),) = both
            return self.result(after.verdict, said + after.evidence, after.details)
        details = [["claim", "of MSE", prose("of ", Formula(self.mse))]]
        for table, (before, after) in zip(self.again, both, strict=True):
            words = ", ".join(f"{k} {v}" for k, v in table.items() if isinstance(v, str | int))
            details.append([words, *map(_short, (before, after))])
        verdicts = [after.verdict for _, after in both]
        count = sum(verdict.holds for verdict in verdicts)
        evidence = said + f"{count} of {len(both)} of these claims hold"
        return self.result(_weakest(verdicts), evidence, details)

    def _with_formula(self, run: RunResult) -> RunResult:
        """The run with the formula's value as its MSE."""
        if run.status != "finished":
            raise NoValueError(run)
        ring, (element,) = embed([parse(self.mse, _NAMES, source="mse")], _NAMES)
        numbers = {"N": Fraction(run.steps), "h": Fraction(run.step_size)}
        at = {name: rational_ball(x) for name, x in numbers.items()}
        value = enclose_over(ring, element, {**at, "mse": ball(run.values["mse"])})
        told = Value.of(*middle_and_radius(_finite(value, run)), run.digits)
        return run.model_copy(update={"values": {**run.values, "mse": told}})


def _finite(value: Ball | None, run: RunResult) -> Ball:
    if value is None or not value.is_finite():
        raise NoValueError(run)
    return value


def _short(result: ClaimResult) -> str:
    return "holds" if result.verdict.holds else result.verdict.lower()


def _weakest(verdicts: Sequence[Verdict]) -> Verdict:
    for weak in (Verdict.REFUTED, Verdict.UNDECIDED):
        if weak in verdicts:
            return weak
    return Verdict.MEASURED


CLAIM = ReplacedClaim
