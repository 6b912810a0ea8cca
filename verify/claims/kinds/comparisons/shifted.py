"""Other claims get the same verdicts where J is taken at z_1 … z_N, and not at z_0 … z_{N−1}.

A sum over k = 1 … N of what a run has for k = 0 … N − 1 lacks the first term and has one at the
end of the run instead: Λ' = (1 + Λ)(1 + ΔJ_N)/(1 + ΔJ_0) − 1 and MSE' = MSE + (ΔJ_N² − ΔJ_0²)/N.
"""

from collections.abc import Callable
from fractions import Fraction
from typing import Any, Literal

from verify.algebra.enclosure import enclose_over
from verify.arithmetic.arb import Ball, ball, in_reach, middle_and_radius, rational_ball, shown
from verify.claims.again import AgainClaim
from verify.claims.findings import Findings
from verify.claims.formulas import step_map_of
from verify.claims.on_runs import RunClaim
from verify.claims.runs import QUANTITIES, NoValueError, all_hold, middle
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
        if claim.always_own or set(claim.observables()) - set(_SHIFTED):
            return f"is not made of {' and '.join(_SHIFTED)} of the scene’s runs alone"
        return ""

    def compare(self, findings: Findings) -> ClaimResult:
        scene = findings.scene_of(self)
        tasks = grid_tasks(scene, self.scheme)
        changed, changes = _shifted(findings, tasks, scene.exact_hamiltonian(), self.scheme)
        both = self.twice(findings, changed)
        details = [["claim", "k = 0 … N − 1", "k = 1 … N"], *self.rows(both)]
        verdicts: list[bool | None] = [x.verdict is y.verdict for x, y in both]
        evidence = prose(
            f"{verdicts.count(True)} of {len(verdicts)} verdicts are the same; by the other count "
            "Λ changes by ", number(shown(changes["lambda"], 2)), " of itself at most, MSE by ",
            number(shown(changes["mse"], 2)), f" of itself, in {len(tasks)} runs",
        )  # fmt: skip
        return self.result(all_hold(verdicts), evidence, details)


def _shifted(
    findings: Findings, tasks: list[Any], exact: Hamiltonian, scheme: str
) -> tuple[dict[str, RunResult], dict[str, Ball]]:
    """The runs by the other count, by the tasks' keys, and the greatest relative changes."""
    delta_j, changed = _delta_j(exact, scheme), {}
    most: dict[str, Ball] = {name: rational_ball(Fraction(0)) for name in _SHIFTED}
    for task in tasks:
        run = findings.results[task.key]
        if not isinstance(run, RunResult) or run.status != "finished":
            raise InputError("claim", task.key, "its scene has no finished run of it")
        values = _values(run, delta_j)
        for name, value in values.items():
            before = ball(run.values[name])
            change = abs(value / before - 1)
            if not in_reach(change):
                raise NoValueError(run)
            most[name] = max(most[name], change, key=middle)
        told = {n: Value.of(*middle_and_radius(x), run.digits) for n, x in values.items()}
        kept = {n: v for n, v in run.values.items() if n in ("p", "q")}
        changed[task.key] = run.model_copy(update={"values": {**kept, **told}})
    return changed, most


def _values(run: RunResult, delta_j: DeltaJ) -> dict[str, Ball]:
    h = rational_ball(Fraction(run.step_size))
    q, p = map(Fraction, run.plane_start)
    first = delta_j(rational_ball(p), rational_ball(q), h)
    last = delta_j(ball(run.values["p"]), ball(run.values["q"]), h)
    lam, mse = QUANTITIES["lambda"](run), QUANTITIES["mse"](run)
    return {
        "lambda": (1 + lam) * (1 + last) / (1 + first) - 1,
        "mse": mse + (last**2 - first**2) / run.steps,
    }


def _delta_j(exact: Hamiltonian, scheme: str) -> DeltaJ:
    step_map = step_map_of(exact, scheme)
    field, (element,) = canonical_field(step_map.hamiltonian, step_map.delta_j)

    def at(p: Ball, q: Ball, h: Ball) -> Ball:
        found = enclose_over(field.ring, element, {"p": p, "q": q, "h": h})
        return Ball("nan") if found is None else found

    return at


CLAIM = ShiftedClaim
