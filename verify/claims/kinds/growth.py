"""The growth of the greatest |Λ| of [0, t] up to the end of the run.

It is read from runs to T/8, T/4, T/2 and T: the greatest |Λ| of [0, t] does not decrease in t, and
each doubling of t multiplies it by some 2^e. The growth is `linear` if every e is within 1/8 of
1, and `bounded` if every e is within 1/8 of 0; otherwise the claim is UNDECIDED. The verdict is
about [0, T], and MEASURED at best: only a proof can cover all times.
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Literal

import flint

from verify.arithmetic.arb import Ball, format_ball, format_fixed, is_representable, rational_ball
from verify.arithmetic.exact import text
from verify.claims.base_claim import Findings
from verify.claims.quantities import QUANTITIES, NoValueError
from verify.claims.run_claims import RunClaim
from verify.errors import InputError
from verify.prose import Formula, Number, join_prose, number, prose
from verify.runs.task import RunTask
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.run import RunResult
from verify.scenes.scene import Scene
from verify.studies.kinds.grid import grid_task
from verify.verdict import Verdict

_DOUBLINGS = 3
_LEAST_STEPS = 64  # of the longest run: fewer show no growth
_EXPONENTS = {"bounded": 0, "linear": 1}
_NEAR = Fraction(1, 8)


class GrowthClaim(RunClaim):
    """The growth of |Λ| along one run."""

    compares = ("lambda_max",)
    one_run = True
    separate_runs = True
    obstacle = ""
    kind: Literal["growth"]
    growth: Literal["bounded", "linear"]
    """The growth of max |Λ| over [0, t], t = T/8 … T."""

    def check_scene(self, scene: Scene) -> None:
        self.tasks(scene)

    def tasks(self, scene: Scene) -> list[RunTask]:
        """Return the runs to T/8, T/4, T/2 and T.

        Raises InputError if the grid has several runs, or too few steps.
        """
        grid = scene.grid
        if grid is None or len(grid.step_sizes) > 1 or len(grid.initial_values) > 1:
            raise InputError("growth", scene.name, "speaks of one run; give step_size, q and p")
        whole = grid_task(scene, self.scheme, grid.step_sizes[0], 0)
        if whole.steps < _LEAST_STEPS:
            raise InputError("growth", whole.steps, f"needs {_LEAST_STEPS} steps or more")
        # Halving by shifts rounds down, so that all four runs have whole numbers of steps.
        halved = [whole.steps >> k for k in range(_DOUBLINGS, -1, -1)]
        return [whole.model_copy(update={"steps": steps}) for steps in halved]

    def judge(self, findings: Findings) -> ClaimResult:
        """Judge with MEASURED at best: even with rigorous bounds four runs are not all times."""
        return self.compare_or_undecided(findings)

    def compare(self, findings: Findings) -> ClaimResult:
        scene = findings.scene_of(self)
        results = [findings.results[task.key] for task in self.tasks(scene)]
        runs = [run for run in results if isinstance(run, RunResult)]
        if all(map(_is_zero, runs)):
            holds = self.growth == "bounded"
            evidence = "ΔJ ≡ 0 is proved: Λ is exactly 0 after every step"
            return self.result(Verdict.PROVED if holds else Verdict.REFUTED, evidence)
        # max |Λ| over [0, t] grows like t^e between t and 2t if its ratio is 2^e.
        values = [_largest(run) for run in runs]
        exponents = [_exponent(x, y) for x, y in pairwise(values)]
        maxima = (
            prose(number(format_ball(value, 4)), " to t = ", Number(_end(run)))
            for value, run in zip(values, runs, strict=True)
        )
        exponent_texts = (
            "unknown" if not is_representable(e) else number(format_fixed(e, 2)) for e in exponents
        )
        evidence = prose(
            "max |Λ| is ", join_prose(", ", maxima), ": it grows like ", Formula("t^e"), ", e = ",
            join_prose(", ", exponent_texts),
        )  # fmt: skip
        return self.result(_judge(self.growth, exponents), evidence)


def _is_zero(run: RunResult) -> bool:
    """Return True if Λ is proved to be 0."""
    value = run.values.get("lambda_max") if "lambda_max" in run.exact else None
    return value is not None and Fraction(value.value) == Fraction(value.bound) == 0


def _largest(run: RunResult) -> Ball:
    if run.status != "finished":
        raise NoValueError(run)
    return QUANTITIES["lambda_max"](run)


def _end(run: RunResult) -> str:
    return text(Fraction(run.step_size) * run.steps)


def _exponent(value: Ball, value_at_double_time: Ball) -> Ball:
    """Return e in last = first · 2^e; not finite if one of them may be 0."""
    return (value_at_double_time / value).log() / flint.arb(2).log()


def _judge(claimed: str, exponents: Sequence[Ball]) -> Verdict:
    tolerance = rational_ball(_NEAR)
    fitting = [
        name for name, e in _EXPONENTS.items() if all(abs(x - e) < tolerance for x in exponents)
    ]
    if not fitting:
        return Verdict.UNDECIDED
    return Verdict.MEASURED if claimed in fitting else Verdict.REFUTED


CLAIM = GrowthClaim
