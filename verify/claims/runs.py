"""The runs that a claim about numbers speaks of, as balls, and how its verdict rests on them."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

from verify.arithmetic.arb import Ball, ball, lg, precision
from verify.claims.findings import Findings, result
from verify.errors import InputError
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.run import RunResult
from verify.scenes.scene import Scene
from verify.verdict import Verdict

QUANTITIES: dict[str, Callable[[RunResult], Ball]] = {
    "mse": lambda run: ball(run.values["mse"]),
    "lambda": lambda run: ball(run.values["lambda"]),
    "lambda_max": lambda run: ball(run.values["lambda_max"]),
    "lg_mse": lambda run: lg(ball(run.values["mse"])),
    "lg_abs_lambda": lambda run: lg(abs(ball(run.values["lambda"]))),
    "abs_lambda": lambda run: abs(ball(run.values["lambda"])),
    "mse_over_lambda": lambda run: ball(run.values["mse"]) / abs(ball(run.values["lambda"])),
    "delta_j_max": lambda run: ball(run.values["delta_j_max"]),
}
NEEDS = {
    "mse": ("mse",),
    "lambda": ("lambda",),
    "lambda_max": ("lambda_max",),
    "lg_mse": ("mse",),
    "lg_abs_lambda": ("lambda",),
    "abs_lambda": ("lambda",),
    "mse_over_lambda": ("mse", "lambda"),
    "delta_j_max": ("delta_j_max",),
}
LABELS = {
    "mse": "MSE",
    "lambda": "Λ",
    "lambda_max": "max |Λ|",
    "lg_mse": "lg MSE",
    "lg_abs_lambda": "lg |Λ|",
    "abs_lambda": "|Λ|",
    "mse_over_lambda": "MSE/|Λ|",
    "delta_j_max": "max |ΔJ|",
}


class NoValueError(Exception):
    """A run that the claim needs ended without values; the message says which and how."""


def decided(check: Callable[[Any, Findings], ClaimResult]) -> Callable[..., ClaimResult]:
    """The check, with UNDECIDED where a run that it needs has no values, and ENCLOSED for what was
    measured where all runs have rigorous bounds."""

    def checked(claim: Any, findings: Findings) -> ClaimResult:
        try:
            with precision():
                found = check(claim, findings)
        except NoValueError as reason:
            return result(claim, Verdict.UNDECIDED, str(reason))
        runs = findings.runs(findings.scene(claim.scene), claim.scheme)
        enclosed = all(r.error_kind == "enclosed" for r in runs)
        if found.verdict is Verdict.MEASURED and enclosed:
            return found.model_copy(update={"verdict": Verdict.ENCLOSED})
        if found.verdict is Verdict.REFUTED and not enclosed:
            by = f"{found.evidence} (by estimated error bounds)"
            return found.model_copy(update={"evidence": by})
        return found

    return checked


def rows_of(
    claim: Any, findings: Findings, *quantities: str
) -> tuple[Scene, list[list[RunResult]]]:
    """The grid's runs: one row an initial value, its runs by increasing step size.

    Raises InputError where the scene does not run what the claim speaks of, and NoValueError where
    a run ended without values.
    """
    scene = findings.scene(claim.scene)
    runs = findings.runs(scene, claim.scheme)
    if not runs or scene.grid is None:
        raise InputError("claim", claim.id, "its scene has no runs of that scheme")
    needed = [o for quantity in quantities for o in NEEDS[quantity]]
    for run in runs:
        if run.status != "finished":
            raise NoValueError(end_of(run))
        if missing := [name for name in needed if name not in run.values]:
            raise InputError("claim", claim.id, f"its scene does not observe {missing[0]}")
    width = len(scene.grid.step_sizes)
    rows = [runs[i : i + width] for i in range(0, len(runs), width)]
    return scene, [sorted(row, key=lambda run: Fraction(run.step_size)) for row in rows]


def start_of(run: RunResult) -> str:
    return f"q₀ = {run.q}, p₀ = {run.p}"


def end_of(run: RunResult) -> str:
    """How a run ended that has no values."""
    why = f"left the range at step {run.failed_step}" if run.failed_step else run.status
    return f"the run from {start_of(run)} with h = {run.step_size} {why}"


def sign(x: Ball, *, zero: bool | None = None) -> bool | None:
    """Whether x is positive (True) or negative (False); `zero` where it is exactly 0, and None
    where its ball holds 0 with other numbers."""
    if x.is_zero():
        return zero
    return True if x > 0 else False if x < 0 else None


def all_hold(verdicts: Sequence[bool | None]) -> Verdict:
    """REFUTED by one False; MEASURED where there is something to measure and all is True."""
    if False in verdicts:
        return Verdict.REFUTED
    return Verdict.UNDECIDED if None in verdicts or not verdicts else Verdict.MEASURED
