"""Other claims get the same verdicts if J is taken at z_1 … z_N instead of z_0 … z_{N−1}.

A sum over k = 1 … N of what a run has for k = 0 … N − 1 lacks the first term and has one at the
end of the run instead: Λ' = (1 + Λ)(1 + ΔJ_N)/(1 + ΔJ_0) − 1 and MSE' = MSE + (ΔJ_N² − ΔJ_0²)/N.
"""

from collections.abc import Callable
from fractions import Fraction
from typing import Any, Literal

from verify.algebra.enclosure import enclose_over
from verify.arithmetic.arb import (
    Ball,
    ball,
    format_ball,
    is_representable,
    midpoint_and_radius,
    rational_ball,
)
from verify.claims.base_claim import Findings
from verify.claims.formula_claims import step_map_of
from verify.claims.quantities import QUANTITIES, NoValueError, all_hold, middle
from verify.claims.run_claims import AgainClaim, RunClaim
from verify.errors import InputError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import number, prose
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.run import RunResult
from verify.studies.kinds.grid import grid_tasks

_SHIFTED = ("lambda", "mse")
DeltaJ = Callable[[Ball, Ball, Ball], Ball]


class ShiftedClaim(AgainClaim):
    """Claims that do not depend on which step is counted first."""

    compares = _SHIFTED
    autonomous = planar = True
    kind: Literal["shifted"]

    def refuses(self, claim: RunClaim) -> str:
        if claim.separate_runs or set(claim.observables()) - set(_SHIFTED):
            return f"is not made of {' and '.join(_SHIFTED)} of the scene’s runs alone"
        return ""

    def compare(self, findings: Findings) -> ClaimResult:
        scene = findings.scene_of(self)
        tasks = grid_tasks(scene, self.scheme)
        changed_runs, changes = _shift_runs(findings, tasks, scene.exact_hamiltonian(), self.scheme)
        pairs = self.compare_twice(findings, changed_runs)
        details = [["claim", "k = 0 … N − 1", "k = 1 … N"], *self.rows(pairs)]
        verdicts: list[bool | None] = [x.verdict is y.verdict for x, y in pairs]
        evidence = prose(
            f"{verdicts.count(True)} of {len(verdicts)} verdicts are the same; by the other "
            "count Λ changes by ", number(format_ball(changes["lambda"], 2)),
            " of itself at most, and MSE by ", number(format_ball(changes["mse"], 2)),
            f" of itself, in {len(tasks)} runs",
        )  # fmt: skip
        return self.result(all_hold(verdicts), evidence, details)


def _shift_runs(
    findings: Findings, tasks: list[Any], hamiltonian: Hamiltonian, scheme: str
) -> tuple[dict[str, RunResult], dict[str, Ball]]:
    """Return the runs counted from z_1, by task key, and the greatest relative changes."""
    delta_j, changed_runs = _delta_j(hamiltonian, scheme), {}
    largest: dict[str, Ball] = {name: rational_ball(Fraction(0)) for name in _SHIFTED}
    for task in tasks:
        run = findings.results[task.key]
        if not isinstance(run, RunResult) or run.status != "finished":
            raise InputError("claim", task.key, "its scene has no finished run of it")
        values = _values(run, delta_j)
        for name, value in values.items():
            before = ball(run.values[name])
            change = abs(value / before - 1)
            # The changes are relative, and must be enclosed: an unbounded one decides nothing.
            if not is_representable(change):
                raise NoValueError(run)
            largest[name] = max(largest[name], change, key=middle)
        shifted = {
            n: Value.from_bound(*midpoint_and_radius(x), run.digits) for n, x in values.items()
        }
        state = {n: v for n, v in run.values.items() if n in ("p", "q")}
        changed_runs[task.key] = run.model_copy(update={"values": {**state, **shifted}})
    return changed_runs, largest


def _values(run: RunResult, delta_j: DeltaJ) -> dict[str, Ball]:
    h = rational_ball(Fraction(run.step_size))
    q, p = map(Fraction, run.plane_start)
    at_start = delta_j(rational_ball(p), rational_ball(q), h)
    at_end = delta_j(ball(run.values["p"]), ball(run.values["q"]), h)
    lam, mse = QUANTITIES["lambda"](run), QUANTITIES["mse"](run)
    return {
        "lambda": (1 + lam) * (1 + at_end) / (1 + at_start) - 1,
        "mse": mse + (at_end**2 - at_start**2) / run.steps,
    }


def _delta_j(hamiltonian: Hamiltonian, scheme: str) -> DeltaJ:
    step_map = step_map_of(hamiltonian, scheme)
    field, (element,) = canonical_field(step_map.hamiltonian, step_map.delta_j)

    def evaluate(p: Ball, q: Ball, h: Ball) -> Ball:
        value = enclose_over(field.ring, element, {"p": p, "q": q, "h": h})
        return Ball("nan") if value is None else value

    return evaluate


CLAIM = ShiftedClaim
