"""The error of p and q over the last period of a run is within a bound, or beyond it.

The error is relative to the reach of the orbit, half the range of p or q along it, and the greater
one of both coordinates counts. At a single time it depends on where the solutions happen to be; so
the largest error over a period is taken: the run's last state and the exact one are both carried
back through the orbit's last period by the exact flow. Errors grow at most like t², so that the
error over the run's own last period differs from this one by at most a part 2/n, n the number of
periods. In a run of fewer than ten periods, and if the orbit does not close, the error at the end
is taken. The exact solution is in closed form if one is known.
"""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from functools import lru_cache
from typing import Annotated, Literal, NamedTuple, Self

from pydantic import Field, model_validator

from verify.arithmetic.exact import known_text, text, upper
from verify.claims.base_claim import Findings
from verify.claims.quantities import all_hold, some_hold, start_of
from verify.claims.run_claims import RunClaim
from verify.errors import NOT_GIVEN, InputError
from verify.execution.plan import results_of_tasks
from verify.execution.task import Task
from verify.flows.exact_orbit import exact_orbit
from verify.flows.extrapolation import NoFlowError
from verify.flows.solution import exact_solution
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import Number, prose
from verify.runs.task import RunTask
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.run import RunResult
from verify.scenes.scene import Scene
from verify.scenes.values import ExactNumber, StepSize
from verify.studies.kinds.series import series_task
from verify.verdict import Verdict

_DIGITS = 12  # of the exact solution, at least; reaches are known to three
_SAMPLES = 120  # of a period
_PERIODS = 10  # that a run has at least, where the last one is looked at
_COARSE = Fraction(1, 50)  # of a reach that the orbit's search has seen at its own steps alone
_SHOWN = 2  # digits of an error
State = tuple[Fraction, Fraction]  # p, q


class _Error(NamedTuple):
    """Bounds of the greatest relative error of a run; None if it is unknown."""

    run: RunResult
    low: Fraction | None
    high: Fraction | None


class SolutionErrorClaim(RunClaim):
    """The error is `within` or `beyond` a part of the reach, for every run of the grid or some run.

    Only runs of `step_size` count, if it is given. The verdict is MEASURED at best, as the reach
    is an estimate. The claim needs p and q at the end, which every computed run has.
    """

    planar = True
    obstacle = "an error at one time is that of its own runs"
    kind: Literal["solution_error"]
    step_size: StepSize | None = None
    """The step size of the grid's runs that the claim is about; by default all."""
    series: Annotated[str, Field(max_length=80)] = ""
    """The `source` of the scene's `[[series]]` that is spoken of, the longest, not its grid."""
    within: Annotated[ExactNumber, Field(gt=0)] | None = None
    """The error is at most this part of the orbit's reach; or `beyond`."""
    beyond: Annotated[ExactNumber, Field(gt=0)] | None = None
    """The error is at least this part of the orbit's reach; or `within`."""
    quantifier: Literal["every", "some"] = "every"
    """The number of runs for which it holds: every run, or some run."""

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
            sources = ", ".join(
                dict.fromkeys(section.source for section in scene.series if section.source)
            )
            problem = f"the scene has no such [[series]]; it has {sources or 'none'}"
            raise InputError("series", self.series, problem)

    def _series_tasks(self, scene: Scene) -> list[RunTask]:
        sections = [section for section in scene.series if section.source == self.series]
        longest = max(
            (section.step_size * section.count for section in sections), default=Fraction(0)
        )
        return [
            series_task(scene, self.scheme, section)
            for section in sections
            if section.step_size * section.count == longest
        ]

    def tasks(self, scene: Scene) -> Iterable[Task]:
        return self._series_tasks(scene) if self.series else super().tasks(scene)

    def judge(self, findings: Findings) -> ClaimResult:
        """MEASURED at best, however rigorous the bounds of the runs are."""
        return self.compare_or_undecided(findings)

    def compare(self, findings: Findings) -> ClaimResult:
        hamiltonian = findings.scene(self.scene).exact_hamiltonian()
        errors = [_error_of(hamiltonian, run) for run in self._runs(findings)]
        holds = [self._holds(error) for error in errors]
        bounded_errors = [e for e in errors if e.high is not None and e.low is not None]
        head = ["initial value", "h", "t", "largest error over the last period, of the reach"]
        details = [head, *map(_row, errors)]
        if not bounded_errors:
            return self.result(
                Verdict.UNDECIDED, "no exact solution, or no state at the end, is known", details
            )
        least, greatest = (pick(bounded_errors, key=lambda e: e.high or 0) for pick in (min, max))
        relation = f"{'within' if self.within else 'beyond'} "
        if len(errors) == 1:
            evidence = prose(
                "the largest error over the last period is ", Number(_format_error(greatest)),
                " of the orbit’s reach, half the range of p or of q on it (", _place(greatest), ")",
            )  # fmt: skip
            return self.result(all_hold(holds), evidence, details)
        evidence = prose(
            f"in {holds.count(True)} of {len(holds)} runs the largest error over the last period "
            f"is {relation}", Number(text(self.within or self.beyond or Fraction(0))),
            " of the orbit’s reach, half the range of p or of q on it; it goes from ",
            Number(_format_error(least)), " (", _place(least), ") to ",
            Number(_format_error(greatest)), " (", _place(greatest), ")",
        )  # fmt: skip
        of_every_run = self.quantifier == "every"
        decided = all_hold(holds) if of_every_run else some_hold(holds)
        return self.result(decided, evidence, details)

    def _runs(self, findings: Findings) -> list[RunResult]:
        if self.series:
            tasks = self._series_tasks(findings.scene(self.scene))
            return list(results_of_tasks(RunResult, tasks, findings.results))
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


def _error_of(hamiltonian: Hamiltonian, run: RunResult) -> _Error:
    if not {"p", "q"} <= set(run.values):  # a scene's run that a proof was given for
        return _Error(run, None, None)
    (q, p), time = map(Fraction, run.plane_start), Fraction(run.step_size) * run.steps
    end = (Fraction(run.values["p"].value), Fraction(run.values["q"].value))
    unsure = max(Fraction(run.values[name].bound) for name in ("p", "q"))
    try:
        bounds = _largest(hamiltonian, (p, q), end, time, Fraction(run.t0))
    except (NoFlowError, InputError):
        bounds = None
    if bounds is None:
        return _Error(run, None, None)
    low, high, scale = bounds
    return _Error(run, max(low - unsure / scale, Fraction(0)), high + unsure / scale)


@lru_cache(maxsize=1024)  # several claims speak of the same runs
def _largest(
    hamiltonian: Hamiltonian, start: State, end: State, time: Fraction, t0: Fraction
) -> tuple[Fraction, Fraction, Fraction] | None:
    """Return bounds of the largest error, and the smaller reach; None if p or q is constant."""
    p, q = start
    solution = exact_solution(hamiltonian, p=p, q=q, time=time, digits=_DIGITS, t0=t0)
    orbit = exact_orbit(hamiltonian, p, q, time, t0)
    if not all(orbit.reach):
        return None
    period = Fraction(0) if hamiltonian.time_dependent else orbit.period or Fraction(0)
    # In a few periods alone the error changes too much within one: 2/n would be no small part.
    back = period if time >= _PERIODS * period else Fraction(0)
    states = list(_carry_back(hamiltonian, end, (solution.p, solution.q), back))
    # 2/n bounds by how much errors over the run's own last period may differ from these.
    low, high, drift = Fraction(0), Fraction(0), 2 * back / time
    for k, rough_reach in enumerate(orbit.reach):
        distances = [abs(state[k] - exact_state[k]) for state, exact_state in states]
        exact_values = [exact_state[k] for _, exact_state in states]
        # The search sees p and q at its own steps alone, so that the reach may be larger by `more`.
        reach, margin = rough_reach, _COARSE * rough_reach
        if back:
            reach = (max(exact_values) - min(exact_values)) / 2
            margin = (_crest(exact_values) + _crest([-x for x in exact_values])) / 2
        at_end, greatest = distances[0] - solution.bound, max(distances)
        low = max(
            low,
            at_end / (reach + margin),
            (greatest - solution.bound) * (1 - drift) / (reach + margin),
        )
        high = max(high, (greatest + _crest(distances) + solution.bound) * (1 + drift) / reach)
    return low, high, min(orbit.reach) * (1 - _COARSE)


def _crest(samples: Sequence[Fraction]) -> Fraction:
    """Estimate how far a smooth curve through the samples rises above them.

    Between two samples of a parabola its crest is an eighth of the second difference higher; twice
    that is taken, for the curve is no parabola.
    """
    bends = (2 * b - a - c for a, b, c in zip(samples, samples[1:], samples[2:], strict=False))
    return max((*bends, Fraction(0))) / 4


def _carry_back(
    hamiltonian: Hamiltonian, state: State, exact_state: State, back: Fraction
) -> Iterable[tuple[State, State]]:
    """Yield both states at the end, and at earlier times, by the exact flow."""
    yield state, exact_state
    for k in range(1, _SAMPLES + 1 if back else 1):
        s = -back * k / _SAMPLES
        solutions = (
            exact_solution(hamiltonian, p=p, q=q, time=s, digits=_DIGITS)
            for p, q in (state, exact_state)
        )
        earlier, exact_earlier = ((solution.p, solution.q) for solution in solutions)
        yield earlier, exact_earlier


def _format_error(error: _Error) -> str:
    low, high = error.low or Fraction(0), error.high or Fraction(0)
    error_text = known_text((low + high) / 2, (high - low) / 2, _SHOWN)
    return upper(high) if error_text == "0" else error_text


def _place(error: _Error) -> str:
    return prose(start_of(error.run), ", h = ", Number(error.run.step_size))


def _row(error: _Error) -> list[str]:
    run = error.run
    time = text(Fraction(run.step_size) * run.steps)
    return [
        start_of(run),
        run.step_size,
        time,
        "unknown" if error.high is None else _format_error(error),
    ]


CLAIM = SolutionErrorClaim
