"""Over the last period of a run p and q are so close to the exact solution, or so far from it.

The error is measured by the orbit's own reach, half of how far p and q go along it, in whichever of
the two it is greater. At one time it depends on where the solutions happen to be; so it is the
largest over a period: the run's last state and the exact one, both carried back through the orbit's
last period by the exact flow. Errors grow with t, or with t² at most: what the run's own last
period has is that up to 2/n of it, n the number of periods, and is known no better. In a run of
fewer than ten periods, and where the orbit does not close, it is that at the end. The exact
solution is in closed form where one is known.
"""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from functools import lru_cache
from typing import Annotated, Literal, NamedTuple, Self

from pydantic import Field, model_validator

from verify.arithmetic.exact import known_text, text, upper
from verify.claims.findings import Findings
from verify.claims.on_runs import RunClaim
from verify.claims.runs import all_hold, some_hold, start_of
from verify.errors import NOT_GIVEN, InputError
from verify.execution.study import known_results
from verify.execution.task import Task
from verify.flows.extrapolation import NoFlowError
from verify.flows.orbit import exact_orbit
from verify.flows.solution import exact_solution
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import Number, prose
from verify.runs.task import RunTask
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.run import RunResult
from verify.scenes.scene import Scene
from verify.scenes.values import Number as ExactNumber
from verify.scenes.values import StepSize
from verify.studies.kinds.series import series_task
from verify.verdict import Verdict

_DIGITS = 12  # of the exact solution, at least; reaches are known to three
_SAMPLES = 120  # of a period
_PERIODS = 10  # that a run has at least, where the last one is looked at
_COARSE = Fraction(1, 50)  # of a reach that the orbit's search has seen at its own steps alone
_SHOWN = 2  # digits of an error
State = tuple[Fraction, Fraction]  # p, q


class _Error(NamedTuple):
    """The greatest relative error of a run, between two numbers; None where it is not known."""

    run: RunResult
    low: Fraction | None
    high: Fraction | None


class SolutionErrorClaim(RunClaim):
    """`within` or `beyond` so much of the reach, for every run of the grid or for some run.

    `step_size` of the grid alone, where it is given. MEASURED at best: the reach is an estimate. It
    takes p and q at the end, which every run has that is done and not proved.
    """

    planar = True
    only_here = "an error at one time is that of its own runs"
    kind: Literal["solution_error"]
    step_size: StepSize | None = None
    """That of the grid's runs which is spoken of; all, where it is left out."""
    series: Annotated[str, Field(max_length=80)] = ""
    """The `source` of the scene's `[[series]]` that is spoken of, the longest, not its grid."""
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
        if self.series and self.step_size is not None:
            raise InputError("step_size", NOT_GIVEN, "is of the grid; give it, or series")
        return self

    def check_scene(self, scene: Scene) -> None:
        sizes = scene.grid.step_sizes if scene.grid else ()
        if self.step_size is not None and sizes and self.step_size not in sizes:
            raise InputError("step_size", text(self.step_size), "is not in the scene's grid")
        if self.series and not self._series_tasks(scene):
            known = ", ".join(dict.fromkeys(each.source for each in scene.series if each.source))
            problem = f"the scene has no such [[series]]; it has {known or 'none'}"
            raise InputError("series", self.series, problem)

    def _series_tasks(self, scene: Scene) -> list[RunTask]:
        named = [each for each in scene.series if each.source == self.series]
        longest = max((each.step_size * each.count for each in named), default=Fraction(0))
        return [
            series_task(scene, self.scheme, each)
            for each in named
            if each.step_size * each.count == longest
        ]

    def tasks(self, scene: Scene) -> Iterable[Task]:
        return self._series_tasks(scene) if self.series else super().tasks(scene)

    def judge(self, findings: Findings) -> ClaimResult:
        """MEASURED at best, however rigorous the bounds of the runs are."""
        return self.compared(findings)

    def compare(self, findings: Findings) -> ClaimResult:
        exact = findings.scene(self.scene).exact_hamiltonian()
        errors = [_error_of(exact, run) for run in self._runs(findings)]
        holds = [self._holds(error) for error in errors]
        known = [e for e in errors if e.high is not None and e.low is not None]
        head = ["initial value", "h", "t", "largest error over the last period, of the reach"]
        details = [head, *map(_row, errors)]
        if not known:
            return self.result(
                Verdict.UNDECIDED, "no exact solution, or no state at the end, is known", details
            )
        least, most = (pick(known, key=lambda e: e.high or 0) for pick in (min, max))
        allowed = f"{'within' if self.within else 'beyond'} "
        if len(errors) == 1:
            evidence = prose(
                "the largest error over the last period is ", Number(_shown(most)),
                " of the orbit’s reach, half of how far p and q go along it (", _place(most), ")",
            )  # fmt: skip
            return self.result(all_hold(holds), evidence, details)
        evidence = prose(
            f"{holds.count(True)} of {len(holds)} errors, each the largest over the last period, "
            f"lie {allowed}", Number(text(self.within or self.beyond or Fraction(0))),
            " of the orbit’s reach, half of how far p and q go along it: from ",
            Number(_shown(least)), " (", _place(least), ") to ", Number(_shown(most)), " (",
            _place(most), ")",
        )  # fmt: skip
        every = self.quantifier == "every"
        decided = all_hold(holds) if every else some_hold(holds)
        return self.result(decided, evidence, details)

    def _runs(self, findings: Findings) -> list[RunResult]:
        if self.series:
            tasks = self._series_tasks(findings.scene(self.scene))
            return list(known_results(RunResult, tasks, findings.results))
        rows = self.run_rows(findings)
        if self.step_size is not None:
            return [self.run_at(row, self.step_size) for row in rows]
        return [run for row in rows for run in row]

    def _holds(self, error: _Error) -> bool | None:
        if error.low is None or error.high is None:
            return None
        if self.within is not None:
            return True if error.high <= self.within else False if error.low > self.within else None
        limit = self.beyond or Fraction(0)
        return True if error.low > limit else False if error.high <= limit else None


def _error_of(exact: Hamiltonian, run: RunResult) -> _Error:
    if not {"p", "q"} <= set(run.values):  # a scene's run that a proof was given for
        return _Error(run, None, None)
    (q, p), time = map(Fraction, run.plane_start), Fraction(run.step_size) * run.steps
    end = (Fraction(run.values["p"].value), Fraction(run.values["q"].value))
    unsure = max(Fraction(run.values[name].bound) for name in ("p", "q"))
    try:
        found = _largest(exact, (p, q), end, time, Fraction(run.t0))
    except (NoFlowError, InputError):
        found = None
    if found is None:
        return _Error(run, None, None)
    low, high, scale = found
    return _Error(run, max(low - unsure / scale, Fraction(0)), high + unsure / scale)


@lru_cache(maxsize=1024)  # several claims speak of the same runs
def _largest(
    exact: Hamiltonian, start: State, end: State, time: Fraction, t0: Fraction
) -> tuple[Fraction, Fraction, Fraction] | None:
    """Between what the largest error lies, and the smaller reach; None where p or q rests."""
    p, q = start
    last = exact_solution(exact, p=p, q=q, time=time, digits=_DIGITS, t0=t0)
    orbit = exact_orbit(exact, p, q, time, t0)
    if not all(orbit.reach):
        return None
    period = Fraction(0) if exact.time_dependent else orbit.period or Fraction(0)
    back = period if time >= _PERIODS * period else Fraction(0)
    states = list(_carried(exact, end, (last.p, last.q), back))
    low, high, drift = Fraction(0), Fraction(0), 2 * back / time
    for k, rough in enumerate(orbit.reach):
        apart = [abs(one[k] - other[k]) for one, other in states]
        along = [other[k] for _, other in states]
        reach, more = rough, _COARSE * rough
        if back:
            reach = (max(along) - min(along)) / 2
            more = (_crest(along) + _crest([-x for x in along])) / 2
        at_end, most = apart[0] - last.bound, max(apart)
        low = max(low, at_end / (reach + more), (most - last.bound) * (1 - drift) / (reach + more))
        high = max(high, (most + _crest(apart) + last.bound) * (1 + drift) / reach)
    return low, high, min(orbit.reach) * (1 - _COARSE)


def _crest(samples: Sequence[Fraction]) -> Fraction:
    """How far a smooth curve through the samples rises above them at most, about.

    A crest between two of them is an eighth of the second difference; twice that is taken.
    """
    bends = (2 * b - a - c for a, b, c in zip(samples, samples[1:], samples[2:], strict=False))
    return max((*bends, Fraction(0))) / 4


def _carried(
    exact: Hamiltonian, one: State, other: State, back: Fraction
) -> Iterable[tuple[State, State]]:
    """Both states at the end, and at times before it."""
    yield one, other
    for k in range(1, _SAMPLES + 1 if back else 1):
        s = -back * k / _SAMPLES
        found = (exact_solution(exact, p=p, q=q, time=s, digits=_DIGITS) for p, q in (one, other))
        first, second = ((each.p, each.q) for each in found)
        yield first, second


def _shown(error: _Error) -> str:
    low, high = error.low or Fraction(0), error.high or Fraction(0)
    known = known_text((low + high) / 2, (high - low) / 2, _SHOWN)
    return upper(high) if known == "0" else known


def _place(error: _Error) -> str:
    return prose(start_of(error.run), ", h = ", Number(error.run.step_size))


def _row(error: _Error) -> list[str]:
    run = error.run
    time = text(Fraction(run.step_size) * run.steps)
    return [start_of(run), run.step_size, time, "unknown" if error.high is None else _shown(error)]


CLAIM = SolutionErrorClaim
