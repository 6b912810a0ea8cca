"""The links of Λ in the plane, which is a product of determinants, less 1.

A mixed kernel carries these values along float64's states z̃_k: wide numbers, of many digits, with
names that begin with w, and float64 numbers with names that begin with f.

    w_trajectory  Λ ← Λ + ΔJ(z̃_k) + Λ ΔJ(z̃_k), the step map's own ΔJ in wide numbers
    w_clock       the same along a wide state that steps at the times of float64's clock
    w_factors     the same with d̃_k − 1, d̃_k the determinant that float64 computes
    w_closed      the same with the ΔJ that float64 computes from its closed form
    f_plain       Π d̃_k in float64
    f_sum, f_rest Σ log1p of float64's ΔJ, in float64, with Knuth's two-sum: the plain additions'
                  errors are summed apart, and Λ = expm1(f_sum + f_rest)

The error bounds of Λ₂ and Λ₃. They are products along float64's states, so that no error of a state
is magnified. Their rounding is counted:

Let P̂' = P̂ (1 + e) + ρ be a step of the product as it was computed, P̂ = 1 + Λ̂, and let M ≤ 1/2
be the greatest |Λ̂| of all steps, which the kernel carries along. The step's operations, each
within u = 2^(1 − bits) of its exact result, are e, t = Λ̂ e, s = e + t and Λ̂ + s. From |Λ̂ + s| ≤
(1 + u) M it follows that |s| ≤ 2.01 M, |e| ≤ 4.02 M, |t| ≤ 2.02 M, so |ρ| ≤ 12 u M; in fixed point
additions are exact, e and t are within a unit 2^−bits each, and |ρ| ≤ 3 units. If e itself is
within B of its exact value (see `verify.kernels.rounding`), |ρ| grows by 2 B. As P̂' ≥ 1/2, every
step multiplies by 1 + θ at most beside the exact factor, |θ| ≤ 2.01 |ρ|; after N steps the product
is within 1.5 · 1.01 · N |θ| ≤ 4 N |ρ| of the exact one, as long as this is below 1/100. Where M >
1/2, or B is not known, a rerun with more digits estimates the error instead.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import ClassVar

import flint

from verify.arithmetic.arb import bounds, is_representable
from verify.arithmetic.exact import magnitude
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number_system import Arithmetic, SystemNumber, UnsupportedError
from verify.kernels.kernel import Kernel, KernelWriter
from verify.kernels.rounding import PRECISION_BITS
from verify.kernels.step.kinds import may_leave_range
from verify.kernels.step.shared_part import common_power
from verify.kernels.stepping import KernelRun, RunOutcome, limits
from verify.runs.estimates import working_digits
from verify.runs.proved_values import prove_observables
from verify.scenes.results.separation import SeparationResult
from verify.scenes.results.separation_parts import Parts
from verify.schemes import get
from verify.schemes.maps.step_map import StepMap
from verify.studies.separation import way
from verify.studies.separation.chain import Entries, Links, exact_links, links_of
from verify.studies.separation.mixed_run import marks_of

WORKING = frozenset({"lambda", "lambda_plain"})  # with these `verify run` steps in float64, too
POINTS = 2048  # checkpoints of a run
# Knuth's two-sum of f_sum and f_log; `f_rest` collects the errors of the additions.
_CLOSED_SUM = (
    "f_log = f_log1p(f_dj)",
    "f_total = f_sum + f_log",
    "f_part = f_total - f_sum",
    "f_rest = f_rest + ((f_sum - (f_total - f_part)) + (f_log - f_part))",
    "f_sum = f_total",
)


@dataclass(frozen=True)
class Determinants(way.Way):
    """Λ = Π det J − 1 of a run in the plane."""

    count: int = 2

    result: ClassVar = SeparationResult
    observable: ClassVar = "lambda"
    observables: ClassVar = frozenset({"lambda"})
    points: ClassVar = POINTS
    parts: ClassVar = Parts.rounding
    # A difference of two links is rounding, some 16 digits below 1; a long run magnifies it.
    cancelled: ClassVar = 14
    vanishes: ClassVar = "ΔJ ≡ 0"

    # -- the kernel ---------------------------------------------------------------------------

    def step(self, step_map: StepMap, arithmetic: Arithmetic, exactly: bool) -> Kernel:
        """Return the arithmetic's own kernel, not compiled; ΔJ is not divided by a power of h."""
        observables = self.observables if exactly else WORKING
        # Only the kernel's lines are needed here; they are compiled with those of the way.
        uncompiled = replace(arithmetic, compile=lambda *_: lambda *_: ())
        return KernelWriter(step_map, uncompiled, observables, False, scaled=False).kernel()

    def lines(
        self, narrow: way.Side, wide: way.Side | None, clocked: way.Side | None
    ) -> way.KernelLines:
        start: dict[str, int] = {}
        inside = [f"f_det = {narrow.output('det')}", f"f_dj = {narrow.output('dj')}"]
        if wide:
            _check_range(wide)
            inside += _accumulate_lines("trajectory", wide.output("dj"), start)
        if clocked:
            inside += _accumulate_lines("clock", clocked.output("dj"), start)
        inside += [
            "w_factor = wide(f_det) - w_one",
            *_accumulate_lines("factors", "w_factor", start),
        ]
        start["f_plain"] = 1
        inside.append("f_plain = f_plain * f_det")
        step = narrow.step
        closed = not step.program.is_constant(step.outputs["dj"], 0)
        if closed:
            inside += [
                "w_factor = wide(f_dj)",
                *_accumulate_lines("closed", "w_factor", start),
                *_CLOSED_SUM,
            ]
            start |= {"f_sum": 0, "f_rest": 0}
        followed = tuple(name for name in way.FOLLOWED if f"w_{name}" in start)
        return way.KernelLines(inside, start, followed, closed)

    def limits(
        self, kernel: way.MixedKernel, arithmetic: Arithmetic, inputs: Mapping[str, float]
    ) -> list[SystemNumber]:
        """Return the limits of p, q and Λ; UnsupportedError if they start beyond them."""
        if not isinstance(kernel.wide, Kernel) or not kernel.limits:
            return []
        rational_inputs = {n: Fraction(x) for n, x in kernel.inputs(inputs).items()}
        room = limits(kernel.wide, rational_inputs, {n: Fraction(inputs[n]) for n in ("p", "q")})
        if room is None:
            name = arithmetic.name
            raise UnsupportedError(f"a step from the start may leave the range of {name}")
        return [float(room.p), float(room.q), arithmetic.number(room.part)]

    # -- reading its states -------------------------------------------------------------------

    def read(self, state: way.State, name: str, arithmetic: Arithmetic) -> Entries:
        return (arithmetic.exact(state[f"w_{name}"]),)

    def plain(self, state: way.State) -> tuple[float, ...]:
        return (state["f_plain"] - 1.0,)

    def closed_form(self, state: way.State) -> tuple[float, ...]:
        try:
            return (math.expm1(state["f_sum"] + state["f_rest"]),)
        except OverflowError:
            return (math.inf,)

    # -- error bounds -------------------------------------------------------------------------

    def bounds(self, run: way.SteppedRun) -> Mapping[str, Fraction | None]:
        bounds_by_name: dict[str, Fraction | None] = {}
        for name in run.kernel.followed:
            # The clock's link has a wide state of its own, whose error is not counted.
            error: Fraction | None = None if name == "clock" else Fraction(0)
            if name == "trajectory":
                error = _error_of_delta_j(run)
            top = run.arithmetic.exact(run.last[f"w_{name}_top"])
            bounds_by_name[name] = _bound_product(run.steps, top, error, run.arithmetic)
        if any(bound is None for name, bound in bounds_by_name.items() if name != "clock"):
            return dict.fromkeys(bounds_by_name)
        return bounds_by_name

    def hidden_size(self, run: way.SteppedRun, name: str) -> Fraction:
        if run.arithmetic.absolute:
            return _unit(run.arithmetic)
        sizes = (abs(run.arithmetic.exact(state[f"w_{name}"])) for state in run.states)
        return _unit(run.arithmetic) * max(sizes)

    # -- runs in exact arithmetic's stead -----------------------------------------------------

    def prove_links(self, run: KernelRun, step_map: StepMap | None, digits: int) -> Links | None:
        """Return Λ at every checkpoint where ΔJ is a constant, else None."""
        h, marks = run.start["h"], marks_of(run.steps, POINTS)
        digits += len(str(run.steps))
        if step_map is None or not prove_observables(step_map, self.observables, h, 1, digits):
            return None
        if step_map.preserves_area:
            return exact_links([(Fraction(0),)] * len(marks), self.vanishes)
        values = [
            prove_observables(step_map, self.observables, h, n, digits)["lambda"] for n in marks
        ]
        worst = max(bound for _, bound in values)
        return links_of([(x,) for x, _ in values], worst, "enclosed", "ΔJ is constant")

    def values(self, run: RunOutcome, last: Fraction) -> list[Entries]:
        return [*((note["lambda"],) for note in run.trail[:-1]), (last,)]

    def digits_beside(
        self, run: KernelRun, step_map: StepMap, link_digits: int, compiled: bool
    ) -> int:
        """Return the digits beside float64, as few as suffice for compiled kernels.

        Those take longer the more digits there are. A fixed-point system has them after the point.
        """
        if not compiled:
            return working_digits(link_digits, run.steps)
        # Along float64's states only the number of roundings grows: N times at most 10^6 units.
        size = run.start["h"] ** _power_of_area(step_map, run.scheme)
        return link_digits + max(0, -magnitude(size)) + len(str(run.steps)) + 6


def _check_range(wide: way.Side) -> None:
    """Raise UnsupportedError if an operation may leave a limited range.

    The state's limits alone must keep all operations within it.
    """
    program, arithmetic = wide.step.program, wide.arithmetic
    operations = (program.ops[i] for i in program.live([wide.step.outputs["dj"]]))
    partial = {
        op.function.name if op.kind == "call" else op.kind
        for op in operations
        if may_leave_range(op)
    }
    if arithmetic.absolute and partial:
        raise UnsupportedError(
            f"{', '.join(sorted(partial))} may leave the range of {arithmetic.name}"
        )


def _accumulate_lines(name: str, factor: str, start: dict[str, int]) -> list[str]:
    """Return lines for Λ ← Λ + e + Λ e and for the greatest |Λ|, which the error bound needs."""
    lam, top = f"w_{name}", f"w_{name}_top"
    start |= {lam: 0, top: 0}
    return [
        f"{lam} = {lam} + ({factor} + {lam} * {factor})",
        f"w_size = abs({lam})",
        f"if w_size > {top}: {top} = w_size",
    ]


def _error_of_delta_j(run: way.SteppedRun) -> Fraction | None:
    """Return B, the error of one wide ΔJ over the region that the float64 states have visited."""
    with working_precision(PRECISION_BITS):
        # A float64 becomes a fixed-point number, which cuts it below its last binary place.
        cut = flint.arb(2) ** -run.arithmetic.bits if run.arithmetic.absolute else flint.arb(0)
        values = run.analyse_values([run.kernel.wide.outputs["dj"]], cut)
        return bounds(values[0].error)[1] if values and is_representable(values[0].error) else None


def _bound_product(
    steps: int, top: Fraction, error: Fraction | None, arithmetic: Arithmetic
) -> Fraction | None:
    """Return the bound of the module's docstring; M = `top`, B = `error`."""
    if error is None or top > Fraction(1, 2):
        return None
    rounding = 3 * _unit(arithmetic) if arithmetic.absolute else 12 * _unit(arithmetic) * top
    # 4 N |ρ|, where |ρ| grows by 2 B for an inexact factor.
    bound = 4 * steps * (rounding + 2 * error)
    return bound if bound <= Fraction(1, 100) else None


def _unit(arithmetic: Arithmetic) -> Fraction:
    """Return u of the module's docstring: a bound of the error of one operation.

    It is 2^−bits in fixed point, else 2^(1 − bits), twice the error of rounding to nearest.
    """
    return Fraction(1 if arithmetic.absolute else 2, 2**arithmetic.bits)


def _power_of_area(step_map: StepMap, scheme: str) -> int:
    """Return about the power of h in Λ: r − 1 if every term of ΔJ has h^r.

    If the terms show no common power, it is taken from the scheme's order.
    """
    if step_map.preserves_area:
        return 0
    power = common_power(step_map)
    return power - 1 if power else 1 + (get(scheme).order or 0)
