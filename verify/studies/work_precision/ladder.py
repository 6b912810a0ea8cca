"""A scheme's ladder of step sizes: the errors of its runs, and the compiled loop that made them.

The error is that of the very loop that is timed, which steps the state and nothing else: its last
state, as a tuple of rationals, is compared with the exact solution. A second run of the same
scheme, in high precision from the exact inputs, separates the parts: its error is the truncation
part, and the difference of the two runs' states is the rounding part. Λ comes from a further
float64 run, which computes it beside the state. Errors are computed before anything is timed, in
this process or in another.

The cost of a step is the number of operations that its loop contains.
"""

import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from verify.arithmetic.exact import text
from verify.arithmetic.number_system import Arithmetic
from verify.arithmetic.systems import float64
from verify.errors import InputError
from verify.flows.extrapolation import NoFlowError
from verify.flows.solution import ExactSolution
from verify.kernels.chunked_loop import ChunkedLoop
from verify.kernels.kernel import Kernel, KernelWriter
from verify.kernels.step.computation import step_map_of
from verify.kernels.step.lowering import Lowering
from verify.kernels.stepping import KernelRun
from verify.lockstep import run_alone
from verify.runs.digits_on_demand import choose, measure
from verify.runs.estimates import Bounds
from verify.scenes.observables import accumulated_observables, carries
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.work_precision import CostResult, LimitedBy, WorkPoint
from verify.schemes import get
from verify.schemes.scheme import Scheme
from verify.studies.work_precision.peers import InitialValueProblem
from verify.studies.work_precision.problem import (
    SHOWN,
    ReferenceProblem,
    State,
    distance,
    reference,
)

ROUNDING_SHARE = Fraction(1, 20)  # rounding limits a point if it is more of the error than this
EXACT_DIGITS = 33  # digits of the run that stands for exact arithmetic
# A run's observables, and their fields in a `WorkPoint`.
_FIELDS = {
    "lambda": "lam", "lambda_plain": "lam_plain", "symplectic_defect": "symplectic_defect",
}  # fmt: skip
_CALL_PREFIX = "call "  # counted operations are called by their kind, functions by this and name
Advance = Callable[[int], None]  # called with the number of points just done


class SchemeLadder:
    """One scheme on a problem: its loop in float64, and its runs over step sizes."""

    def __init__(self, problem: ReferenceProblem, scheme: str) -> None:
        self.problem, self.scheme = problem, get(scheme)
        self.name = scheme
        self.preserves_area = step_map_of(problem.hamiltonian, scheme).preserves_area
        # Observables of the loss of area, or of the symplectic form; the most accurate one is last.
        self.defect_names = accumulated_observables(problem.hamiltonian)
        # Compiled anew: code that an earlier run has cached would be loaded, not compiled.
        self.arithmetic: Arithmetic = float64.compiled_at_once(anew=True)
        step_map = step_map_of(self._kernel_run(problem.time, frozenset()).hamiltonian, scheme)
        start_time = time.perf_counter()
        self.kernel: Kernel = KernelWriter(step_map, self.arithmetic, frozenset(), False).kernel()
        # The first call compiles.
        self.call(problem.time, blank=True)()
        self.compile_seconds = time.perf_counter() - start_time

    @property
    def cost(self) -> CostResult:
        """The operations of one step."""
        return count_cost(self.kernel, self.scheme)

    def _kernel_run(self, h: Fraction, observables: frozenset[str]) -> KernelRun:
        problem = self.problem
        start, steps = {**problem.point, "h": h, "t": problem.t0}, problem.time // h
        return KernelRun(problem.hamiltonian, self.name, start, steps, observables, points=0)

    def _loop(self, h: Fraction) -> ChunkedLoop:
        return ChunkedLoop(self._kernel_run(h, frozenset()), self.kernel, self.arithmetic, (), 0)

    def call(self, h: Fraction, *, blank: bool = False) -> Callable[[], object]:
        """Return a call of the loop over all steps; `blank`: over none, to time the call itself."""
        from verify.arithmetic.compiled.doubles import prepared_call

        loop = self._loop(h)
        count = 0 if blank else loop.run.steps
        return prepared_call(self.kernel.function, count, *loop.fixed, *loop.state)

    def point(self, h: Fraction) -> WorkPoint:
        """Return the errors of the run with this step size, not yet timed."""
        loop = self._loop(h)
        run_alone(loop.run_to_end())
        steps = loop.run.steps
        if loop.done < steps:
            return build_failed_point(
                self.name, step_size=text(h), steps=steps, failed_step=loop.done + 1,
                reason="left the range of float64",
            )  # fmt: skip
        last = loop.current.trail[-1]
        return self._build_point(h, steps, tuple(last[name] for name in self.problem.point))

    def _build_point(self, h: Fraction, steps: int, last: State) -> WorkPoint:
        error = self.problem.error(last, h)
        bounds = self._run_precisely(h)
        truncation = rounding = None
        limited: LimitedBy = "undecided"
        reason = ""
        if bounds.status == "finished" and set(self.problem.point) <= set(bounds.values):
            pairs = [bounds.values[name] for name in self.problem.point]
            true, uncertain = tuple(x for x, _ in pairs), sum(bound for _, bound in pairs)
            difference, bound = self.problem.error(true, h)
            truncation = difference, bound + uncertain
            difference, bound = distance(last, true)
            rounding = difference, bound + uncertain
            limited = decide_limit(error, rounding)
        else:
            reason = f"at high precision: {bounds.status} ({bounds.method})"
        area = self._area_fields(h, bounds)
        return WorkPoint(
            scheme=self.name,
            step_size=text(h),
            steps=steps,
            error=Value.from_bound(*error, SHOWN),
            truncation=truncation and Value.from_bound(*truncation, SHOWN),
            rounding=rounding and Value.from_bound(*rounding, SHOWN),
            energy=self.problem.energy_error(last),
            limited_by=limited,
            reason=reason,
            **area,
        )

    def _run_precisely(self, h: Fraction) -> Bounds:
        """Do the same steps in high precision, from the exact inputs."""
        lost = frozenset[str]() if self.preserves_area else frozenset(self.defect_names)
        kernel_run = self._kernel_run(h, lost)
        return run_alone(measure(kernel_run, choose(kernel_run, EXACT_DIGITS), EXACT_DIGITS)).bounds

    def _area_fields(self, h: Fraction, precise_bounds: Bounds) -> dict[str, Any]:
        """Return a point's fields of Λ, or of W in n degrees of freedom, and of what limits them.

        In the plane Λ by the plain product is one of them.
        """
        plain = "lambda_plain"
        observables = {plain} if carries(self.problem.hamiltonian, plain) else set[str]()
        observables |= set() if self.preserves_area else set(self.defect_names)
        run = (
            self._kernel_run(h, frozenset(observables)).run(float64.make(17))
            if observables
            else None
        )
        if run is not None and run.done < self.problem.time // h:
            return {"lambda_limited_by": "failed"}
        fields: dict[str, Any] = {
            _FIELDS[name]: Value.from_bound(run.values[name], Fraction(0), SHOWN)
            for name in observables
            if run is not None
        }
        if (
            self.preserves_area
        ):  # Λ, or W, is proved to be 0, so that all of the product is rounding
            zeros = dict.fromkeys(
                (_FIELDS[name] for name in self.defect_names), Value(value="0", bound="0")
            )
            return {**fields, **zeros, "lambda_limited_by": "rounding"}
        if run is None:
            return fields
        limits: LimitedBy = "undecided"
        if self.defect_names[-1] in precise_bounds.values:
            value = run.values[self.defect_names[-1]]
            (true, bound) = precise_bounds.values[self.defect_names[-1]]
            limits = decide_limit((abs(value), Fraction(0)), (abs(value - true), bound))
        return {**fields, "lambda_limited_by": limits}


def decide_limit(
    error: tuple[Fraction, Fraction], rounding: tuple[Fraction, Fraction]
) -> LimitedBy:
    """Return "truncation" if rounding is certainly less than its share of the error.

    Otherwise return "rounding". Both arguments are numbers with their bounds.
    """
    most, least = rounding[0] + rounding[1], error[0] - error[1]
    return "truncation" if most <= ROUNDING_SHARE * least else "rounding"


def build_failed_point(scheme: str, **fields: Any) -> WorkPoint:  # Any: the model checks them
    """Return the point of a run that gave no values."""
    return WorkPoint(scheme=scheme, limited_by="failed", lambda_limited_by="failed", **fields)


@dataclass(frozen=True)
class SchemeErrors:
    """The errors of schemes.

    `solution`: the exact one at the final time; `points`: by scheme and step size, not yet timed;
    `seconds`: the time that computing all of them took.
    """

    solution: ExactSolution
    points: Mapping[tuple[str, Fraction], WorkPoint]
    seconds: float


def find_errors(
    initial_value_problem: InitialValueProblem,
    schemes: Sequence[str],
    step_sizes: Sequence[Fraction],
    advance: Advance,
) -> SchemeErrors:
    """Compute the errors of each scheme with each step size.

    Raises InputError if the exact solution does not reach the final time.
    """
    start_time = time.perf_counter()
    try:
        solution = reference(**vars(initial_value_problem))
    except NoFlowError as error:
        raise InputError(
            "work_precision.time", text(initial_value_problem.time), str(error)
        ) from None
    problem = ReferenceProblem.with_solution(initial_value_problem, solution)
    points = {}
    # One ladder at a time: each holds a compiled kernel.
    for ladder in (SchemeLadder(problem, name) for name in schemes):
        for h in step_sizes:
            points[ladder.name, h] = ladder.point(h)
            advance(1)
    return SchemeErrors(solution, points, time.perf_counter() - start_time)


def count_cost(kernel: Kernel, scheme: Scheme) -> CostResult:
    """Count the operations of one step of the state alone, without those before the loop.

    Adding the increments to the coordinates counts; a change of sign does not.
    """
    lowering, roots = kernel.lowering, [kernel.outputs[f"d{name}"] for name in kernel.coordinates]
    turn: Counter[str] = Counter()
    # One turn of each loop that solves equations is counted apart, as the number of turns varies.
    for loop in lowering.loops(lowering.live(roots)):
        turn += _count_operations(lowering.inner(loop), loop.updates) + Counter(
            add=len(loop.updates)
        )
    operations = _count_operations(lowering, roots) + Counter(add=len(roots))
    return _build_cost(
        operations, scheme.evaluations, _build_cost(turn, None, None) if turn else None
    )


def _count_operations(lowering: Lowering, roots: Sequence[int]) -> "Counter[str]":
    """Count operations and functions by their names."""
    program = lowering.program
    inside = [index for index in lowering.live(roots) if not program.static[index]]
    functions = [name for index in inside if (name := lowering.function(index))]
    return Counter(program.ops[i].kind for i in inside) + Counter(
        f"{_CALL_PREFIX}{f}" for f in functions
    )


def _build_cost(
    operations: "Counter[str]", gradient: dict[str, int] | None, turn: CostResult | None
) -> CostResult:
    functions = {
        n.removeprefix(_CALL_PREFIX): k for n, k in operations.items() if n.startswith(_CALL_PREFIX)
    }
    return CostResult(
        additions=operations["add"] + operations["sub"],
        multiplications=operations["mul"],
        divisions=operations["inverse"],
        functions=dict(sorted(functions.items())),
        gradient=gradient,
        turn=turn,
    )
