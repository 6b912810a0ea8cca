"""One run: N steps from (q, p) in one arithmetic, each value with its error bound.

`verify.runs.a_posteriori_bound` describes the bounds that are rigorous, `verify.runs.estimates` the
others, and `verify.runs.float64_bounds` those of float64, which is under test.

A value that a proof already gives is not run: where ΔJ ≡ 0, ΔJ, MSE and Λ are exactly 0; where ΔJ
does not depend on (p, q), Λ = (1 + ΔJ)^N − 1 is enclosed by ball arithmetic.

A run may leave the domain of H, as a scheme may step over a pole or past an end of the domain.
Störmer–Verlet of log(q) evaluates 1/q, which is defined for q < 0 as well; no solution goes there.
At most 64 of the states that the run has noted are checked, so that a departure between two of them
is not seen.
"""

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from typing import Any

from verify import arithmetic as number_systems
from verify import observables as kinds
from verify.algebra.enclosure import enclose
from verify.arithmetic.arb import is_representable, midpoint_and_radius
from verify.arithmetic.exact import Number, NumberOrList, positive, rational, text, whole
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.systems import ball, float64
from verify.errors import InputError
from verify.execution.keeper import NOTHING, Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.run_domain import check_times, point_of
from verify.kernels.chunked_loop import Progress
from verify.kernels.run_inputs import DEFAULT_SECTIONS
from verify.kernels.step.computation import step_map_of
from verify.kernels.stepping import KernelRun, RunOutcome
from verify.lockstep import Course, run_alone
from verify.runs.digits_on_demand import Measurement, choose, measure
from verify.runs.estimates import BoundedValues, Bounds
from verify.runs.float64_bounds import bound_errors
from verify.runs.run_start import Start
from verify.scenes.observables import check_observables, select_observables
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.run import RunResult
from verify.scenes.values import AUTO, MAX_DIGITS, MAX_STEPS
from verify.schemes import canonical
from verify.schemes.maps.step_map import StepMap

_CHECKED_STATES = 64  # a run's noted states that are checked against H's domain, at most


def describe_departure(hamiltonian: Hamiltonian, run: KernelRun, outcome: RunOutcome) -> str:
    """Describe by which step a run has left H's domain, and which conditions no longer hold.

    The text is empty if no checked state is outside the domain.
    """
    domain, start, count = hamiltonian.domain, run.start, len(outcome.trail)
    if not domain.requirements or not count:
        return ""
    signs = domain.signs(start)
    for k in _select_notes(count):
        done = min(k * run.section, run.steps)
        note = outcome.trail[k - 1]
        state = {name: note[name] for name in hamiltonian.coordinates}
        violations = domain.left_since(signs, {**state, "t": start["t"] + done * start["h"]})
        if violations:
            return f"by step {done} the orbit has left where H is defined: {', '.join(violations)}"
    return ""


def _select_notes(count: int) -> list[int]:
    """Select the numbers, from 1, of at most 64 notes, evenly spaced, the last among them."""
    return sorted({-(-count * k // _CHECKED_STATES) for k in range(1, _CHECKED_STATES + 1)})


class RequestedRun:
    """A requested run: the values that a proof gives, and the steps that give the others."""

    def __init__(
        self,
        hamiltonian: Hamiltonian,
        scheme: str,
        *,
        q: NumberOrList,
        p: NumberOrList,
        step_size: Number,
        steps: int,
        t0: Number = 0,
        arithmetic: str = float64.NAME,
        digits: int = 17,
        observables: Sequence[str] | None = None,
        points: int = 0,
        sections: int = DEFAULT_SECTIONS,
        shares_kernel: bool = False,
        keeper: Keeper = NOTHING,
    ) -> None:
        """See `run`, which takes the same arguments."""
        scheme = canonical(scheme)
        h = positive(step_size, "step_size")
        self.start = Start(hamiltonian, scheme, h, point_of(hamiltonian, q, p), rational(t0, "t0"))
        self.steps, self.digits = steps, digits
        self.observables = select_observables(hamiltonian, observables)
        check(hamiltonian, steps, digits, self.observables)
        whole("points", points, 0)
        step_map = step_map_of(hamiltonian, scheme)
        # A thinned series shows Λ: it takes Λ from a proof or from the run.
        looked_at = {*self.observables, *(("lambda",) if points else ())}
        self.proved_values = prove_observables(step_map, looked_at, h, steps, digits)
        needs = frozenset(o for o in self.observables if o not in self.proved_values)
        self.kernel_run = KernelRun(
            hamiltonian,
            scheme,
            self.start.inputs,
            steps,
            needs | _series_needs(self.proved_values, points),
            points,
            keeper,
            sections,
            shares_kernel,
        )
        self._arithmetic = arithmetic
        self._measurement: Measurement | None = None

    @cached_property
    def arithmetic(self) -> str:
        """The name of the arithmetic that the run is done in."""
        request = self._arithmetic
        return choose(self.kernel_run, self.digits) if request == AUTO else request

    def take_measurement(self, progress: Progress | None = None) -> Course[Measurement]:
        """Do all steps on the first call; `progress` is called with the number of steps done."""
        if self._measurement is None:
            self._measurement = yield from self._step(progress)
        return self._measurement

    def _step(self, progress: Progress | None) -> Course[Measurement]:
        start, run = self.start, self.kernel_run
        check_times(start.hamiltonian, start.t0, start.step_size, self.steps)
        if self.arithmetic != float64.NAME:
            return (yield from measure(run, self.arithmetic, self.digits, progress))
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
        return self._build_result(measurement, departure)

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
        names = (*start.point, *self.observables)
        values = {n: Value.from_bound(*bounds.values[n], most) for n in names if n in bounds.values}
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

    - `q`, `p`: a number each; in n degrees of freedom a list each.
    - `t0`: the time of the start, for an H that depends on time.
    - `arithmetic`: one of `verify.arithmetic.names()`, or `auto` for the fastest with rigorous
      bounds.
    - `digits`: significant digits of the values (float64 may give fewer).
    - `observables`: if left out, all of `verify.scenes.observables` for H's degrees of freedom.
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


def _series_needs(proved_values: Mapping[str, object], points: int) -> frozenset[str]:
    return frozenset({"extremes"}) if points and "lambda" not in proved_values else frozenset()


# -- values by proof ------------------------------------------------------------------------------


def prove_observables(
    step_map: StepMap, names: Iterable[str], h: Fraction, steps: int, digits: int
) -> BoundedValues:
    """Return the values, with bounds, of those of the named observables that need no run."""
    selected = {name: kinds.by_name()[name] for name in names}
    zero = Fraction(0), Fraction(0)
    values = {name: zero for name, observable in selected.items() if observable.vanishes(step_map)}
    constant = {
        name: observable.constant for name, observable in selected.items() if observable.constant
    }
    if step_map.preserves_area or not constant or step_map.uniform_delta_j is None:
        return values
    # 4 bits for each digit, 64 in reserve, and 2 log2(N), as the power N multiplies errors by N.
    bits = int(4 * digits) + 64 + 2 * steps.bit_length()
    delta_j = enclose(step_map.flat.ring, step_map.uniform_delta_j, {"h": h}, bits)
    if delta_j is None:
        return values
    with working_precision(bits):
        enclosures = {name: formula(delta_j, steps) for name, formula in constant.items()}
        return values | {
            n: midpoint_and_radius(x) for n, x in enclosures.items() if x and is_representable(x)
        }
