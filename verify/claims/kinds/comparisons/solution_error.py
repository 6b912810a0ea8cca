"""At the end of a run p and q are so close to the exact solution, or so far from it.

The error is measured by the orbit's own reach, half of how far p and q go along it, in whichever of
the two it is greater. The exact solution is in closed form where one is known.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Annotated, Literal, NamedTuple, Self

from pydantic import Field, model_validator

from verify.arithmetic.exact import decimal, text
from verify.claims.findings import Findings
from verify.claims.on_runs import RunClaim
from verify.claims.runs import all_hold, start_of
from verify.errors import NOT_GIVEN, InputError
from verify.flows.extrapolation import NoFlowError
from verify.flows.orbit import exact_orbit
from verify.flows.solution import exact_solution
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import Number, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.run import RunResult
from verify.scenes.scene import Scene
from verify.scenes.values import Number as ExactNumber
from verify.scenes.values import StepSize
from verify.verdict import Verdict

_DIGITS = 12  # of the exact solution, at least; reaches are known to three


class _Error(NamedTuple):
    """The relative error at the end of a run, between two numbers; None where it is not known."""

    run: RunResult
    low: Fraction | None
    high: Fraction | None


class SolutionErrorClaim(RunClaim):
    """`within` or `beyond` so much of the reach, for every run of the grid or for some run.

    `step_size` of the grid alone, where it is given. MEASURED at best: the reach is an estimate.
    """

    planar = True
    only_here = "an error at one time is that of its own runs"
    kind: Literal["solution_error"]
    step_size: StepSize | None = None
    """That of the grid's runs which is spoken of; all, where it is left out."""
    within: Annotated[ExactNumber, Field(gt=0)] | None = None
    """The error is at most this part of the orbit's reach; or `beyond`."""
    beyond: Annotated[ExactNumber, Field(gt=0)] | None = None
    """The error is at least this part of the orbit's reach; or `within`."""
    quantifier: Literal["every", "some"] = "every"
    """Of how many of the runs."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        if (self.within is None) == (self.beyond is None):
            raise InputError("within, beyond", NOT_GIVEN, "give one of the two")
        return self

    def quantities(self) -> tuple[str, ...]:
        """None: p and q at the end, which every run has that is done and not proved."""
        return ()

    def check_scene(self, scene: Scene) -> None:
        sizes = scene.grid.step_sizes if scene.grid else ()
        if self.step_size is not None and sizes and self.step_size not in sizes:
            raise InputError("step_size", text(self.step_size), "is not in the scene's grid")

    def judge(self, findings: Findings) -> ClaimResult:
        """MEASURED at best, however rigorous the bounds of the runs are."""
        return self.compared(findings)

    def compare(self, findings: Findings) -> ClaimResult:
        exact = findings.scene(self.scene).exact_hamiltonian()
        rows = self.run_rows(findings)
        runs = [
            run
            for row in rows
            for run in (row if self.step_size is None else [self.run_at(row, self.step_size)])
        ]
        errors = [_error_of(exact, run) for run in runs]
        holds = [self._holds(error) for error in errors]
        known = [e for e in errors if e.high is not None and e.low is not None]
        details = [["initial value", "h", "t", "error, of the orbit’s reach"], *map(_row, errors)]
        if not known:
            return self.result(
                Verdict.UNDECIDED, "no exact solution, or no state at the end, is known", details
            )
        least, most = (pick(known, key=lambda e: e.high or 0) for pick in (min, max))
        allowed = f"{'within' if self.within else 'beyond'} "
        evidence = prose(
            f"{holds.count(True)} of {len(holds)} errors at the end lie {allowed}",
            Number(text(self.within or self.beyond or Fraction(0))), " of the orbit’s reach: from ",
            Number(_shown(least)), " (", _place(least), ") to ", Number(_shown(most)), " (",
            _place(most), ")",
        )  # fmt: skip
        every = self.quantifier == "every"
        decided = all_hold(holds) if every else _some(holds)
        return self.result(decided, evidence, details)

    def _holds(self, error: _Error) -> bool | None:
        if error.low is None or error.high is None:
            return None
        if self.within is not None:
            return True if error.high <= self.within else False if error.low > self.within else None
        limit = self.beyond or Fraction(0)
        return True if error.low > limit else False if error.high <= limit else None


def _some(holds: Sequence[bool | None]) -> Verdict:
    if True in holds:
        return Verdict.MEASURED
    return Verdict.UNDECIDED if None in holds else Verdict.REFUTED


def _error_of(exact: Hamiltonian, run: RunResult) -> _Error:
    if not {"p", "q"} <= set(run.values):  # a scene's run that a proof was given for
        return _Error(run, None, None)
    (q, p), time = map(Fraction, run.plane_start), Fraction(run.step_size) * run.steps
    try:
        t0 = Fraction(run.t0)
        solution = exact_solution(exact, p=p, q=q, time=time, digits=_DIGITS, t0=t0)
        reach = exact_orbit(exact, p, q, time, t0).reach
    except (NoFlowError, InputError):
        return _Error(run, None, None)
    lows, highs = [Fraction(0)], [Fraction(0)]
    for name, true, size in zip(("p", "q"), (solution.p, solution.q), reach, strict=True):
        found = run.values[name]
        apart = abs(Fraction(found.value) - true)
        unsure = Fraction(found.bound) + solution.bound
        if not size:
            return _Error(run, None, None)
        lows.append(max(apart - unsure, Fraction(0)) / size)
        highs.append((apart + unsure) / size)
    return _Error(run, max(lows), max(highs))


def _shown(error: _Error) -> str:
    return decimal(error.high or Fraction(0), 2)


def _place(error: _Error) -> str:
    return prose(start_of(error.run), ", h = ", Number(error.run.step_size))


def _row(error: _Error) -> list[str]:
    run = error.run
    time = text(Fraction(run.step_size) * run.steps)
    said = "unknown" if error.high is None else decimal(error.high, 3)
    return [start_of(run), run.step_size, time, said]


CLAIM = SolutionErrorClaim
