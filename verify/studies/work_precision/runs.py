"""The errors of one run over [0, T], and the compiled loop that made them, ready to be timed.

The error is that of the very loop that is timed, which steps the state and nothing else: its last
state is a pair of rationals, and is compared with the exact solution in rationals. The error of a
run of the same scheme at high precision from the exact inputs is its truncation part; the
difference of the two runs is the rounding. Λ comes from a second float64 run, which computes it
beside the state.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import isqrt
from typing import Any

from verify.algebra.enclosure import enclose
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.arb import is_representable, midpoint_and_radius
from verify.arithmetic.exact import decimal, text
from verify.arithmetic.number_system import Arithmetic
from verify.arithmetic.systems import float64
from verify.flows.solution import Point, Solution, solution_from
from verify.hamiltonians.canonical_field import energy_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.chunked_loop import ChunkedLoop
from verify.kernels.kernel import Kernel, Writer
from verify.kernels.step.computation import step_map_of
from verify.kernels.stepping import KernelRun
from verify.lockstep import run_alone
from verify.runs.digits_on_demand import choose, measure
from verify.runs.estimated import Bounds
from verify.scenes.observables import accumulated_observables, carries
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.work_precision import CostResult, LimitedBy, WorkPoint
from verify.schemes import get
from verify.structures import AREA, SYMPLECTIC
from verify.studies.work_precision.peer_interface import InitialValueProblem
from verify.studies.work_precision.step_cost import count_cost

ROUNDING_SHARE = Fraction(1, 20)  # of the error: a larger rounding part limits the point
EXACT_DIGITS = 33  # of the run that stands for exact arithmetic
SHOWN = 12  # digits of an error at most
_BITS = 400
# Of the exact solution: float64 has 16; in n degrees most have no closed form, and each more costs.
_REFERENCE_DIGITS = {AREA: 33, SYMPLECTIC: 20}
_ROOT_BITS = 160

# The observables of a run, as a point has them.
_FIELDS = {
    "lambda": "lam", "lambda_plain": "lam_plain", "symplectic_defect": "symplectic_defect",
}  # fmt: skip
State = tuple[Fraction, ...]  # p1 … pn, q1 … qn


def reference(hamiltonian: Hamiltonian, point: Point, time: Fraction, t0: Fraction) -> Solution:
    """Return the exact solution that errors are measured from; NoFlowError if it is not reached."""
    return solution_from(hamiltonian, point, time, _REFERENCE_DIGITS[hamiltonian.structure], t0)


@dataclass(frozen=True)
class Problem(InitialValueProblem):
    """An initial value problem with its exact solution at the time."""

    solution: Solution

    @classmethod
    def with_solution(cls, problem: InitialValueProblem, solution: Solution) -> "Problem":
        """Return the problem with its solution."""
        return cls(**vars(problem), solution=solution)

    @cached_property
    def _ends(self) -> dict[Fraction, Solution]:
        return {self.time: self.solution}

    def solution_after(self, h: Fraction) -> Solution:
        """Return the exact solution after N·h, N = T/h rounded down, where the steps end."""
        # Where h does not divide T the run ends before T, and is compared with the solution there.
        end = self.time // h * h
        if end not in self._ends:
            self._ends[end] = reference(self.hamiltonian, self.point, end, self.t0)
        return self._ends[end]

    @property
    def start(self) -> State:
        return tuple(self.point.values())

    @cached_property
    def _energy(self) -> tuple[Ring, Poly]:
        return energy_of(self.hamiltonian)

    @property
    def scale(self) -> str:
        """The greater |z| of the orbit's two ends."""
        ends = self.start, tuple(self.solution.point.values())
        return decimal(max(size(z) for z in ends), 3)

    def error(self, state: State, h: Fraction | None = None) -> tuple[Fraction, Fraction]:
        """Return |state − z(T)| with its bound; with h, the distance from z(N·h)."""
        exact = self.solution if h is None else self.solution_after(h)
        difference, root_error = distance(state, tuple(exact.point.values()))
        return difference, root_error + len(state) * exact.bound  # of each coordinate

    def energy_error(self, state: State) -> Value | None:
        """Return |H(state) − H(z₀)|.

        None where H is not defined there or out of reach, and where it depends on time, as the
        motion then does not keep it.
        """
        if self.hamiltonian.time_dependent:
            return None
        ring, energy = self._energy
        ends = [
            enclose(ring, energy, dict(zip(self.point, end, strict=True)), _BITS)
            for end in (state, self.start)
        ]
        usable = [x for x in ends if x is not None and is_representable(x)]
        if len(usable) < len(ends):
            return None
        (a, a_bound), (b, b_bound) = map(midpoint_and_radius, usable)
        return Value.from_bound(abs(a - b), a_bound + b_bound, SHOWN)


class Ladder:
    """One scheme on a problem: its loop in float64, and its runs over step sizes."""

    def __init__(self, problem: Problem, scheme: str) -> None:
        self.problem, self.scheme = problem, get(scheme)
        self.name = scheme
        self.preserves_area = step_map_of(problem.hamiltonian, scheme).preserves_area
        # What measures the loss of area, or of the symplectic form, the sharper one last.
        self.defect_names = accumulated_observables(problem.hamiltonian)
        # Compiled anew: code cached by an earlier run would only be loaded, and not timed.
        self.arithmetic: Arithmetic = float64.compiled_at_once(anew=True)
        step_map = step_map_of(self._kernel_run(problem.time, frozenset()).hamiltonian, scheme)
        start_time = time.perf_counter()
        self.kernel: Kernel = Writer(step_map, self.arithmetic, frozenset(), False).kernel()
        # The first call compiles.
        self.call(problem.time, blank=True)()
        self.compile_seconds = time.perf_counter() - start_time

    @property
    def cost(self) -> CostResult:
        return count_cost(self.kernel, self.scheme)

    def _kernel_run(self, h: Fraction, observables: frozenset[str]) -> KernelRun:
        problem = self.problem
        start, steps = {**problem.point, "h": h, "t": problem.t0}, problem.time // h
        return KernelRun(problem.hamiltonian, self.name, start, steps, observables, points=0)

    def _loop(self, h: Fraction) -> ChunkedLoop:
        return ChunkedLoop(self._kernel_run(h, frozenset()), self.kernel, self.arithmetic, (), 0)

    def call(self, h: Fraction, *, blank: bool = False) -> Callable[[], object]:
        """Return a call of the loop over all steps, or of none, which times the call itself."""
        from verify.arithmetic.compiled.doubles import prepared_call

        loop = self._loop(h)
        count = 0 if blank else loop.run.steps
        return prepared_call(self.kernel.function, count, *loop.fixed, *loop.state)

    def point(self, h: Fraction) -> WorkPoint:
        """Return the run with this step size, not yet timed."""
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

    def _area_fields(self, h: Fraction, exact: Bounds) -> dict[str, Any]:
        """Return a point's fields of Λ, or of W in n degrees of freedom, and of their limits.

        In the plane there is Λ by the plain product, too.
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
        if self.preserves_area:  # proved; what the product shows is rounding
            zeros = dict.fromkeys(
                (_FIELDS[name] for name in self.defect_names), Value(value="0", bound="0")
            )
            return {**fields, **zeros, "lambda_limited_by": "rounding"}
        if run is None:
            return fields
        limits: LimitedBy = "undecided"
        if self.defect_names[-1] in exact.values:
            value = run.values[self.defect_names[-1]]
            (true, bound) = exact.values[self.defect_names[-1]]
            limits = decide_limit((abs(value), Fraction(0)), (abs(value - true), bound))
        return {**fields, "lambda_limited_by": limits}


def decide_limit(
    error: tuple[Fraction, Fraction], rounding: tuple[Fraction, Fraction]
) -> LimitedBy:
    """Decide if a point is limited by rounding, where it may exceed its share, or by truncation.

    Both come with their bounds: rounding counts as small only where it certainly is.
    """
    most, least = rounding[0] + rounding[1], error[0] - error[1]
    return "truncation" if most <= ROUNDING_SHARE * least else "rounding"


def build_failed_point(scheme: str, **fields: Any) -> WorkPoint:  # Any: the model checks them
    """Return the point of a run that gave no values."""
    return WorkPoint(scheme=scheme, limited_by="failed", lambda_limited_by="failed", **fields)


def size(state: State) -> Fraction:
    """Return |state|, Euclidean."""
    return distance(state, (Fraction(0),) * len(state))[0]


def distance(one: State, other: State) -> tuple[Fraction, Fraction]:
    """Return |one − other|, Euclidean, with the bound of its root."""
    square = sum(((a - b) ** 2 for a, b in zip(one, other, strict=True)), Fraction(0))
    if square == 0:
        return square, square
    # An even shift that leaves the root enough bits, however small the square is.
    bits = square.denominator.bit_length() - square.numerator.bit_length()
    half = _ROOT_BITS + max(0, bits)
    root = isqrt((square.numerator << 2 * half) // square.denominator)
    return Fraction(root, 1 << half), Fraction(1, 1 << half)
