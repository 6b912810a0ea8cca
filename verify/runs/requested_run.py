"""One run: N steps from (q, p) in one arithmetic, each value with its error bound.

`verify.runs.a_posteriori_bound` describes the bounds that are rigorous, `verify.runs.estimates` the
others, and `verify.runs.float64_bounds` those of float64, which is under test.

A value that a proof already gives is not run; see `verify.runs.proved_values`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from typing import Any

from verify import arithmetic as number_systems
from verify import observables as kinds
from verify.arithmetic.exact import Number, NumberOrList, positive, rational, text, whole
from verify.arithmetic.systems import ball, float64
from verify.errors import InputError
from verify.execution.keeper import NOTHING, Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.run_domain import check_times, start_of
from verify.kernels.chunked_loop import Progress
from verify.kernels.run_changes import UndefinedError
from verify.kernels.run_inputs import DEFAULT_SECTIONS
from verify.kernels.step.computation import step_map_of
from verify.kernels.stepping import KernelRun, RunOutcome
from verify.lockstep import Course, run_alone
from verify.runs.departure import describe_departure
from verify.runs.digits_on_demand import Measurement, choose, measure
from verify.runs.estimates import Bounds
from verify.runs.float64_bounds import bound_errors
from verify.runs.proved_values import prove_kept, prove_observables
from verify.runs.run_start import Start
from verify.runs.series_energy import series_with_energy
from verify.runs.way_back import measure_way_back, ways_back
from verify.scenes.observables import check_observables, select_observables
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.run import RunResult, SeriesPoint
from verify.scenes.values import AUTO, MAX_DIGITS, MAX_STEPS
from verify.schemes import canonical


class RequestedRun:
    """A requested run: the values that a proof gives, and the steps that give the others."""

    def __init__(
        self,
        hamiltonian: Hamiltonian,
        scheme: str,
        *,
        q: NumberOrList | None = None,
        p: NumberOrList | None = None,
        start: Mapping[str, Number] | None = None,
        step_size: Number,
        steps: int,
        t0: Number = 0,
        arithmetic: str = float64.NAME,
        digits: int = 17,
        observables: Sequence[str] | None = None,
        aside: Sequence[str] = (),
        points: int = 0,
        sections: int = DEFAULT_SECTIONS,
        shares_kernel: bool = False,
        keeper: Keeper = NOTHING,
    ) -> None:
        """See `run`, which takes the same arguments."""
        scheme = canonical(scheme)
        h = positive(step_size, "step_size")
        point = start_of(hamiltonian, q, p, start)
        self.start = Start(hamiltonian, scheme, h, point, rational(t0, "t0"))
        self.steps, self.digits = steps, digits
        demanded = select_observables(hamiltonian, observables)
        self.observables = tuple(dict.fromkeys((*demanded, *aside)))
        check(hamiltonian, steps, digits, self.observables)
        whole("points", points, 0)
        step_map = step_map_of(hamiltonian, scheme)
        # A thinned series shows Λ: it takes Λ from a proof or from the run.
        looked_at = {*self.observables, *(("lambda",) if points else ())}
        self.proved_values = prove_observables(step_map, looked_at, h, steps, digits)
        is_binary = arithmetic == float64.NAME
        self.ways = ways_back(hamiltonian, self.observables)
        self.proved_values |= prove_kept(
            step_map,
            scheme,
            self.observables,
            # A way back in float64 is asked for its rounding.
            {} if is_binary else {name: way.structure for name, way in self.ways.items()},
        )
        settled = {*self.proved_values, *self.ways}
        needs = frozenset(o for o in self.observables if o not in settled)
        self._series_has_energy = points > 0 and "energy_error_max" in demanded
        has_series = points and ("lambda" not in self.proved_values or self._series_has_energy)
        self.kernel_run = KernelRun(
            hamiltonian,
            scheme,
            self.start.inputs,
            steps,
            needs | (frozenset({"extremes"}) if has_series else frozenset()),
            points,
            keeper,
            sections,
            shares_kernel,
            frozenset(aside).difference(demanded),
        )
        self._arithmetic = arithmetic
        self._measurement: Measurement | None = None

    @cached_property
    def arithmetic(self) -> str:
        """The name of the arithmetic that the run is done in."""
        run, request = self.kernel_run, self._arithmetic
        if request != AUTO:
            return request
        name, lighter = choose(run, self.digits), run.lighter
        if lighter.observables < run.observables and name != number_systems.automatic()[0].name:
            # What is shown aside must not make the run slower.
            faster = choose(lighter, self.digits)
            self.kernel_run = lighter if faster != name else run
            return faster
        return name

    def take_measurement(self, progress: Progress | None = None) -> Course[Measurement]:
        """Do all steps on the first call; `progress` is called with the number of steps done."""
        start = self.start
        if self._measurement is None:
            check_times(start.hamiltonian, start.t0, start.step_size, self.steps)
            measurement = yield from self._step_with_functions(progress)
            self._measurement = yield from self._go_back(measurement)
        return self._measurement

    def _go_back(self, measurement: Measurement) -> Course[Measurement]:
        """Return the measurement with the ways back."""
        bounds = measurement.bounds
        is_own = measurement.arithmetic != float64.NAME and bounds.rigorous
        for name in self.ways.keys() - self.proved_values.keys():
            if bounds.status != "finished":
                break
            way = yield from measure_way_back(
                self.kernel_run,
                self.ways[name],
                measurement.arithmetic,
                self.digits,
                measurement.bounds.values if is_own else None,
            )
            if way.value is not None:
                values = {**bounds.values, name: way.value}
                bounds = replace(bounds, values=values, rigorous=bounds.rigorous and way.rigorous)
        return replace(measurement, bounds=bounds)

    def _step_with_functions(self, progress: Progress | None) -> Course[Measurement]:
        """Do the steps; if the functions of the state keep them from an end, without these."""
        run, measurement = self.kernel_run, None
        texts = {x.name: x.integral or x.structure for x in kinds.select(run.observables)}
        functions = {name: text for name, text in texts.items() if text}
        demanded = {text for name, text in functions.items() if name not in run.aside}
        try:
            measurement = yield from self._step(progress)
        except UndefinedError:
            if demanded:
                raise
        # A step may go on where H is not defined: then it is not asked for.
        is_likely = bool(demanded) or (bool(functions) and self.start.hamiltonian.domain_moves)
        if measurement is not None and (measurement.bounds.status == "finished" or not is_likely):
            return measurement
        self.kernel_run = run.without(frozenset(functions))
        measurement = yield from self._step(progress)
        if measurement.bounds.status == "finished" and demanded:
            problem = "is not defined at every state of the run, which ends well without it"
            raise UndefinedError("integral", ", ".join(sorted(demanded)), problem)
        return measurement

    def _step(self, progress: Progress | None) -> Course[Measurement]:
        if self.arithmetic != float64.NAME:
            return (yield from measure(self.kernel_run, self.arithmetic, self.digits, progress))
        run = self.kernel_run
        first = run.run(number_systems.get(self.arithmetic, self.digits), progress=progress)
        return Measurement(
            (yield from bound_errors(run, first, self.proved_values)), self.arithmetic, first
        )

    @property
    def done(self) -> bool:
        """True if the steps of the run were done."""
        return self._measurement is not None

    def result(self, progress: Progress | None = None) -> Course[RunResult]:
        """Return the result of the run."""
        measurement = yield from self.take_measurement(progress)
        departure = describe_departure(self.start.hamiltonian, self.kernel_run, measurement.outcome)
        result = self._build_result(measurement, departure)
        if self._series_has_energy:
            return result.model_copy(update={"series": self._series_with_energy(measurement)})
        return result

    def _series_with_energy(self, measurement: Measurement) -> tuple[SeriesPoint, ...]:
        start = self.start
        is_binary = measurement.arithmetic == float64.NAME
        first = {n: Fraction(float(x)) if is_binary else x for n, x in start.point.items()}
        return series_with_energy(start.hamiltonian, measurement.outcome, first)

    def prove_result(self) -> RunResult | None:
        """Return the observables by proof, without a step and without p and q.

        None if a proof does not give all of them, and for a run that requests only p and q.
        """
        if not self.observables or not set(self.observables) <= set(self.proved_values):
            return None
        bounds = Bounds({}, "a proof, and no run", rigorous=True)
        return self._build_result(Measurement(bounds, ball.NAME, RunOutcome()))

    def _build_result(self, measurement: Measurement, departure: str = "") -> RunResult:
        """Build the result from the measured values and those that a proof gives."""
        start, bounds, proved_values = self.start, measurement.bounds, self.proved_values
        most = min(self.digits, number_systems.about(measurement.arithmetic).digits or self.digits)
        names, measured = (
            (*start.point, *self.observables),
            self.kernel_run.in_user_names(bounds.values),
        )
        values = {n: Value.from_bound(*measured[n], most) for n in names if n in measured}
        if bounds.status == "finished":
            values |= {
                n: Value.from_bound(*proved_values[n], self.digits)
                for n in self.observables
                if n in proved_values
            }
        return RunResult(
            **start.hamiltonian.texts,
            scheme=start.scheme,
            arithmetic=measurement.arithmetic,
            fallback=measurement.fallback,
            left_domain=departure,
            digits=self.digits,
            step_size=text(start.step_size),
            steps=self.steps,
            q=start.text("q"),
            p=start.text("p"),
            start=start.texts,
            t0=text(start.t0),
            status=bounds.status,
            failed_step=bounds.failed_step,
            values=values,
            error_kind="enclosed" if bounds.rigorous else "estimated",
            error_method=bounds.method,
            exact=tuple(o for o in self.observables if o in proved_values),
            series=measurement.outcome.series,
            seconds=measurement.outcome.seconds,
        )


def run(
    hamiltonian: Hamiltonian, scheme: str, *, progress: Progress | None = None, **arguments: Any
) -> RunResult:
    """Run `steps` steps of `step_size` from (q, p) and report p, q and the observables.

    - `q`, `p`: a number each; in n degrees of freedom a list each. `start`: of equations, the
      initial values by name, in their place.
    - `t0`: the time of the start, for an H that depends on time.
    - `arithmetic`: one of `verify.arithmetic.names()`, or `auto` for the fastest with rigorous
      bounds.
    - `digits`: significant digits of the values (float64 may give fewer).
    - `observables`: if left out, those of `verify.scenes.observables` for the system.
    - `aside`: more of them, which are computed with the digits that they have then.
    - `points`: the limit of the points of a thinned series; 0 for no series.
    - `sections`: without a series, how many states are noted on the way.
    - `progress`: is called with the number of steps done.
    - `keeper`: keeps checkpoints, from which an interrupted run goes on.
    - `shares_kernel`: see `verify.kernels.run_inputs`.

    Raises InputError for h ≤ 0, N < 1, a parameter without a value, unknown names and lists of
    another length.
    """
    return run_alone(RequestedRun(hamiltonian, scheme, **arguments).result(progress))


def check(hamiltonian: Hamiltonian, steps: int, digits: int, observables: Sequence[str]) -> None:
    """Raise InputError for a parameter without a value, and for inputs out of range."""
    if hamiltonian.symbols:
        name = hamiltonian.symbols[0]
        raise InputError("parameter", name, f"has no value; a run needs one, as {name}=1")
    for name, value, most in (("steps", steps, MAX_STEPS), ("digits", digits, MAX_DIGITS)):
        whole(name, value, 1, most)
    check_observables(hamiltonian, observables)
