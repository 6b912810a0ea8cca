"""Claims about |Λ| along whole runs: a bound of it, and how it grows with the length of the run.

max |Λ| is over all steps of a run, and carries the error bound of Λ. How it grows is read from runs
to T/8, T/4, T/2 and T: the greatest |Λ| of [0, t] does not decrease in t, and each doubling of t
multiplies it by some 2^e. The growth is `linear` where every e is within 1/8 of 1, and `bounded`
where every e is within 1/8 of 0; what is neither is UNDECIDED. This is of [0, T], and MEASURED at
best: what holds for all times is for a proof to say (see `_by_proof`).
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

import flint

from verify.arithmetic.arb import Ball, fixed, in_reach, precision, rational_ball, shown
from verify.arithmetic.exact import text
from verify.claims.findings import Checks, Findings, result
from verify.claims.kinds import BoundedClaim, GrowthClaim
from verify.claims.runs import (
    QUANTITIES,
    NoValueError,
    all_hold,
    decided,
    end_of,
    rows_of,
    sign,
    start_of,
)
from verify.errors import InputError
from verify.runs.task import RunTask
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.run import RunResult
from verify.scenes.scene import Scene
from verify.studies.plan import grid_task
from verify.verdict import Verdict

_DOUBLINGS = 3
_LEAST_STEPS = 64  # of the longest run: fewer show no growth
_EXPONENTS = {"bounded": 0, "linear": 1}
_NEAR = Fraction(1, 8)


def check_bounded(claim: BoundedClaim, findings: Findings) -> ClaimResult:
    _, rows = rows_of(claim, findings, "lambda_max")
    runs = [run for row in rows for run in row]
    largest = [QUANTITIES["lambda_max"](run) for run in runs]
    bound = rational_ball(claim.bound)
    holds = [sign(bound - x, zero=True) for x in largest]
    wrong = [i for i, held in enumerate(holds) if held is False]
    at = wrong[0] if wrong else max(range(len(runs)), key=lambda i: float(largest[i].mid()))
    run = runs[at]
    evidence = (
        f"max |Λ| = {shown(largest[at])} over {run.steps} steps of {run.step_size} from "
        f"{start_of(run)}"
    )
    if len(runs) > 1:
        evidence += f", the first of {len(wrong)} beyond it" if wrong else (
            f", the greatest of {len(runs)} runs"
        )  # fmt: skip
    return result(claim, all_hold(holds), f"{evidence}; bound {text(claim.bound)}")


# -- growth ---------------------------------------------------------------------------------------


def growth_tasks(scene: Scene, scheme: str) -> list[RunTask]:
    """The runs to T/8, T/4, T/2 and T; InputError where the scene has several, or a short one."""
    grid = scene.grid
    if grid is None or len(grid.step_sizes) > 1 or len(grid.initial_values) > 1:
        raise InputError("growth", scene.name, "speaks of one run; give step_size, q and p")
    whole = grid_task(scene, scheme, grid.step_sizes[0], 0)
    if whole.steps < _LEAST_STEPS:
        raise InputError("growth", whole.steps, f"needs {_LEAST_STEPS} steps or more")
    halved = [whole.steps >> k for k in range(_DOUBLINGS, -1, -1)]
    return [whole.model_copy(update={"steps": steps}) for steps in halved]


def check_growth(claim: GrowthClaim, findings: Findings) -> ClaimResult:
    return _by_proof(claim, findings) or _by_runs(claim, findings)


def _by_proof(claim: GrowthClaim, findings: Findings) -> ClaimResult | None:
    """The verdict of a proof, where there is one: so far of ΔJ ≡ 0 alone."""
    scene = findings.scene_of(claim)
    runs = [findings.results[task.key] for task in growth_tasks(scene, claim.scheme)]
    if not all(isinstance(run, RunResult) and _zero(run) for run in runs):
        return None
    holds = claim.growth == "bounded"
    evidence = "ΔJ ≡ 0 is proved: Λ is exactly 0 after every step"
    return result(claim, Verdict.PROVED if holds else Verdict.REFUTED, evidence)


def _zero(run: RunResult) -> bool:
    value = run.values.get("lambda_max")
    exactly = "lambda_max" in run.exact and value is not None
    return exactly and value is not None and Fraction(value.value) == Fraction(value.bound) == 0


def _by_runs(claim: GrowthClaim, findings: Findings) -> ClaimResult:
    tasks = growth_tasks(findings.scene_of(claim), claim.scheme)
    runs = [findings.results[task.key] for task in tasks]
    try:
        with precision():
            values = [_largest(run) for run in runs]
            exponents = [_exponent(x, y) for x, y in pairwise(values)]
            verdict = _judge(claim.growth, exponents)
            found = ", ".join(f"{shown(value, 4)} to t = {_end(run)}"
                              for value, run in zip(values, runs, strict=True))  # fmt: skip
            by = ", ".join("unknown" if not in_reach(e) else fixed(e, 2) for e in exponents)
    except NoValueError as reason:
        return result(claim, Verdict.UNDECIDED, str(reason))
    return result(claim, verdict, f"max |Λ| is {found}: it grows like t^e, e = {by}")


def _largest(run: Any) -> Ball:
    if run.status != "finished":
        raise NoValueError(end_of(run))
    return QUANTITIES["lambda_max"](run)


def _end(run: Any) -> str:
    return text(Fraction(run.step_size) * run.steps)


def _exponent(first: Ball, last: Ball) -> Ball:
    """e in last = first · 2^e; not finite where one of them may be 0."""
    return (last / first).log() / flint.arb(2).log()


def _judge(claimed: str, exponents: Sequence[Ball]) -> Verdict:
    near = rational_ball(_NEAR)
    fitting = [name for name, e in _EXPONENTS.items() if all(abs(x - e) < near for x in exponents)]
    if not fitting:
        return Verdict.UNDECIDED
    return Verdict.MEASURED if claimed in fitting else Verdict.REFUTED


CHECKS: Checks = {BoundedClaim: decided(check_bounded), GrowthClaim: check_growth}
