"""The errors of one run over [0, T], and the compiled loop that made them, ready to be timed.

The error is that of the very loop that is timed, which steps the state and nothing else: its last
state is a pair of rationals, and is held against the exact solution in rationals. What is
truncation in it tells a run of the same scheme at high precision from the exact inputs; the
difference of the two runs is the rounding. Λ comes from a second float64 run, which computes it
beside the state.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, partial
from math import isqrt
from typing import Any

from verify.algebra.enclosure import enclose
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.arb import in_reach, middle_and_radius
from verify.arithmetic.exact import decimal, text
from verify.arithmetic.number_system import Arithmetic
from verify.arithmetic.systems import float64
from verify.flows.solution import Solution, exact_solution
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.chunked_loop import ChunkedLoop
from verify.kernels.kernel import Kernel, Writer
from verify.kernels.stepping import KernelRun
from verify.runs.digits_on_demand import choose, measure
from verify.runs.estimated import Bounds
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.work_precision import CostResult, LimitedBy, WorkPoint
from verify.schemes import get
from verify.studies.work_precision.peer_interface import InitialValueProblem
from verify.studies.work_precision.step_cost import cost

ROUNDING_SHARE = Fraction(1, 20)  # of the error: a larger rounding part limits the point
EXACT_DIGITS = 33  # of the run that stands for exact arithmetic
SHOWN = 12  # digits of an error at most
_BITS = 400
_REFERENCE_DIGITS = 33  # of the exact solution: float64 has 16
_ROOT_BITS = 160

State = tuple[Fraction, Fraction]  # p, q


def reference(
    hamiltonian: Hamiltonian, p: Fraction, q: Fraction, time: Fraction, t0: Fraction
) -> Solution:
    """The exact solution that errors are held against; NoFlowError where it is not reached."""
    return exact_solution(hamiltonian, p=p, q=q, time=time, digits=_REFERENCE_DIGITS, t0=t0)


@dataclass(frozen=True)
class Problem(InitialValueProblem):
    """An initial value problem with its exact solution at the time."""

    solution: Solution

    @cached_property
    def _ends(self) -> dict[Fraction, Solution]:
        return {self.time: self.solution}

    def solution_after(self, h: Fraction) -> Solution:
        """The exact solution after N·h, N = T/h rounded down, where the steps end."""
        end = self.time // h * h
        if end not in self._ends:
            self._ends[end] = reference(self.hamiltonian, self.p, self.q, end, self.t0)
        return self._ends[end]

    @property
    def start(self) -> State:
        return self.p, self.q

    @cached_property
    def _energy(self) -> tuple[Ring, Poly]:
        field, _ = self.hamiltonian.field()
        return field.ring, field.energy

    @property
    def scale(self) -> str:
        """The greater |z| of the orbit's two ends."""
        ends = self.start, (self.solution.p, self.solution.q)
        return decimal(max(distance(z, (Fraction(0), Fraction(0)))[0] for z in ends), 3)

    def error(self, state: State, h: Fraction | None = None) -> tuple[Fraction, Fraction]:
        """|state − z(T)| with its bound; with h, the distance from z(N·h)."""
        exact = self.solution if h is None else self.solution_after(h)
        size, own = distance(state, (exact.p, exact.q))
        return size, own + 2 * exact.bound  # of each of p and q

    def energy_error(self, state: State) -> Value | None:
        """|H(state) − H(z₀)|; None where H is not defined there, or out of reach, or not kept by
        the motion as it depends on time."""
        if self.hamiltonian.time_dependent:
            return None
        ring, energy = self._energy
        ends = [
            enclose(ring, energy, dict(zip("pq", at, strict=True)), _BITS)
            for at in (state, self.start)
        ]
        reached = [x for x in ends if x is not None and in_reach(x)]
        if len(reached) < len(ends):
            return None
        (a, a_bound), (b, b_bound) = map(middle_and_radius, reached)
        return Value.of(abs(a - b), a_bound + b_bound, SHOWN)


class Ladder:
    """One scheme on the problem: its loop in float64, and its runs over step sizes."""

    def __init__(self, problem: Problem, scheme: str) -> None:
        self.problem, self.scheme = problem, get(scheme)
        self.name = scheme
        self.preserves_area = self.scheme.step_map(problem.hamiltonian).preserves_area
        self.arithmetic: Arithmetic = float64.compiled_at_once()
        step_map = self.scheme.step_map(self._kernel_run(problem.time, frozenset()).hamiltonian)
        begun = time.perf_counter()
        self.kernel: Kernel = Writer(step_map, self.arithmetic, frozenset(), False).kernel()
        self.call(problem.time, blank=True)()
        self.compile_seconds = time.perf_counter() - begun

    @property
    def cost(self) -> CostResult:
        return cost(self.kernel, self.scheme)

    def _kernel_run(self, h: Fraction, observables: frozenset[str]) -> KernelRun:
        of = self.problem
        start, steps = {"p": of.p, "q": of.q, "h": h, "t": of.t0}, of.time // h
        return KernelRun(of.hamiltonian, self.name, start, steps, observables, points=0)

    def _loop(self, h: Fraction) -> ChunkedLoop:
        return ChunkedLoop(self._kernel_run(h, frozenset()), self.kernel, self.arithmetic, (), 0)

    def call(self, h: Fraction, *, blank: bool = False) -> Callable[[], object]:
        """The loop over all steps, or over none, which is what a call takes by itself."""
        loop = self._loop(h)
        count = 0 if blank else loop.run.steps
        return partial(self.kernel.function, count, *loop.fixed, *loop.state)

    def point(self, h: Fraction) -> WorkPoint:
        """The run with this step size, not yet timed."""
        loop = self._loop(h)
        for _ in loop.chunks():
            pass
        steps = loop.run.steps
        if loop.done < steps:
            return failed(
                self.name, step_size=text(h), steps=steps, failed_step=loop.done + 1,
                reason="left the range of float64",
            )  # fmt: skip
        last = loop.reached.trail[-1]
        return self._finished(h, steps, (last["p"], last["q"]))

    def _finished(self, h: Fraction, steps: int, last: State) -> WorkPoint:
        error = self.problem.error(last, h)
        exact = self._exactly(h)
        truncation = rounding = None
        limited: LimitedBy = "undecided"
        reason = ""
        if exact.status == "finished" and {"p", "q"} <= set(exact.values):
            (p, p_bound), (q, q_bound) = exact.values["p"], exact.values["q"]
            size, bound = self.problem.error((p, q), h)
            truncation = size, bound + p_bound + q_bound
            size, bound = distance(last, (p, q))
            rounding = size, bound + p_bound + q_bound
            limited = limited_by(error, rounding)
        else:
            reason = f"at high precision: {exact.status} ({exact.method})"
        plain, lam, lambda_limited = self._area(h, exact)
        return WorkPoint(
            scheme=self.name,
            step_size=text(h),
            steps=steps,
            error=Value.of(*error, SHOWN),
            truncation=truncation and Value.of(*truncation, SHOWN),
            rounding=rounding and Value.of(*rounding, SHOWN),
            energy=self.problem.energy_error(last),
            lam=lam,
            lam_plain=plain,
            limited_by=limited,
            lambda_limited_by=lambda_limited,
            reason=reason,
        )

    def _exactly(self, h: Fraction) -> Bounds:
        """The same steps in high precision, from the exact inputs."""
        kernel_run = self._kernel_run(
            h, frozenset() if self.preserves_area else frozenset({"lambda"})
        )
        return measure(kernel_run, choose(kernel_run, EXACT_DIGITS), EXACT_DIGITS).bounds

    def _area(
        self, h: Fraction, exact: Bounds
    ) -> tuple[Value | None, Value | None, LimitedBy | None]:
        """Λ by the plain product, by its closed form, and what limits the latter."""
        asked = {"lambda_plain"} | (set() if self.preserves_area else {"lambda"})
        kernel_run = self._kernel_run(h, frozenset(asked))
        run = kernel_run.run(float64.make(17))
        if run.done < kernel_run.steps:
            return None, None, "failed"
        plain = Value.of(run.values["lambda_plain"], Fraction(0), SHOWN)
        if self.preserves_area:  # proved; what the product shows is rounding
            return plain, Value(value="0", bound="0"), "rounding"
        lam = run.values["lambda"]
        limited: LimitedBy = "undecided"
        if "lambda" in exact.values:
            true, bound = exact.values["lambda"]
            limited = limited_by((abs(lam), Fraction(0)), (abs(lam - true), bound))
        return plain, Value.of(lam, Fraction(0), SHOWN), limited


def limited_by(error: tuple[Fraction, Fraction], rounding: tuple[Fraction, Fraction]) -> LimitedBy:
    """By rounding where that may be more than its share of the error, else by truncation.

    Each with its bound: what is not certainly small is not called so.
    """
    most, least = rounding[0] + rounding[1], error[0] - error[1]
    return "truncation" if most <= ROUNDING_SHARE * least else "rounding"


def failed(scheme: str, **found: Any) -> WorkPoint:  # Any: the model checks them
    """A run that gave no values."""
    return WorkPoint(scheme=scheme, limited_by="failed", lambda_limited_by="failed", **found)


def distance(one: State, other: State) -> tuple[Fraction, Fraction]:
    """|one − other|, Euclidean, with the bound of its root."""
    square = sum(((a - b) ** 2 for a, b in zip(one, other, strict=True)), Fraction(0))
    if square == 0:
        return square, square
    # An even shift that leaves the root enough bits, however small the square is.
    bits = square.denominator.bit_length() - square.numerator.bit_length()
    half = _ROOT_BITS + max(0, bits)
    root = isqrt((square.numerator << 2 * half) // square.denominator)
    return Fraction(root, 1 << half), Fraction(1, 1 << half)
