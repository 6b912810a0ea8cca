"""Λ₂, Λ₃ and Λ₄ of the chain that splits rounding off truncation; see
`verify.studies.separation.separate`.

How far they are known. Λ₄ is a float64, and so exact. Λ₂ and Λ₃ are products along given float64
states, so that nothing is magnified, and their rounding is counted:

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
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Generic, Literal, TypeVar

import flint

from verify import arithmetic as number_systems
from verify.arithmetic.arb import bounds, in_reach
from verify.arithmetic.number import Number
from verify.arithmetic.number_system import Arithmetic, UnsupportedError
from verify.arithmetic.systems import float64
from verify.kernels.rounding import PRECISION, analyse, rounding_of
from verify.kernels.stepping import KernelRun, limits
from verify.lockstep import Course
from verify.runs.estimated import digits_of
from verify.studies.separation.kernel import MixedKernel, mixed_kernel
from verify.studies.separation.mixed_run import (
    COUNTED,
    MORE_DIGITS,
    RERUN,
    Advance,
    MixedRun,
    State,
    Stopped,
    named_inputs,
    visited,
)
from verify.studies.separation.trail import Trail

Kind = Literal["enclosed", "estimated"]
_WIDE = ("clock", "trajectory", "determinant", "closed")


@dataclass(frozen=True)
class Link:
    """Λ at every checkpoint, as exact rationals, each within `bound` of what it stands for.

    Two links that a proof shows to be equal are the same object.
    """

    trail: Trail
    bound: Fraction
    kind: Kind
    method: str


L = TypeVar("L")  # Link, or one for each entry of W


@dataclass(frozen=True)
class Working(Generic[L]):
    """What one run of the mixed kernel found; a link is None where it was not followed.

    `factors`: each step's determinant, or Jacobian, is float64's; `closed_factors`: its ΔJ, or S.
    None, as `closed_form`, where some 1 + ΔJ ≤ 0, which has no logarithm, and where S ≡ 0.
    """

    clock: L | None
    trajectory: L | None
    factors: L
    plain: L
    closed_factors: L | None
    closed_form: L | None


def exact_link(trail: Sequence[Fraction], method: str) -> Link:
    return Link(Trail.of(trail), Fraction(0), "enclosed", method)


class WorkingRun(MixedRun[MixedKernel]):
    """The float64 run of a run in the plane."""

    def step_through(self, arithmetic: Arithmetic, advance: Advance) -> Course[Working[Link]]:
        """All steps; raises Stopped where float64 leaves its range."""
        kernel = self._kernel(arithmetic)
        states = yield from self._states(kernel, arithmetic, advance)
        bound_of = self._bounds(kernel, arithmetic, states[-1])
        unknown = {name for name, bound in bound_of.items() if bound is None}
        if unknown:
            unknown = unknown if unknown == {"clock"} else set(bound_of)
            finer = number_systems.get(arithmetic.name, digits_of(arithmetic) + MORE_DIGITS)
            again = yield from self._states(self._kernel(finer), finer, lambda _: None)
            bound_of |= {n: _apart(n, states, again, arithmetic, finer) for n in unknown}

        def link(name: str) -> Link | None:
            bound = bound_of.get(name)
            if bound is None:
                return None
            trail = Trail.of(arithmetic.exact(state[f"w_{name}"]) for state in states)
            if name in unknown:
                return Link(trail, bound, "estimated", RERUN)
            return Link(trail, bound, "enclosed", COUNTED)

        determinant = link("determinant")
        assert determinant is not None  # noqa: S101 - every kernel has it
        plain = exact_link([Fraction(s["f_plain"] - 1.0) for s in states], "a float64")
        delta_j: Link | None = exact_link([Fraction(0)] * len(states), "ΔJ ≡ 0")
        closed = delta_j
        if kernel.closed:
            sums = [_expm1(s["f_sum"] + s["f_rest"]) for s in states]
            finite = all(map(math.isfinite, sums))
            delta_j = link("closed") if finite else None
            closed = exact_link([Fraction(x) for x in sums], "a float64") if finite else None
        return Working(link("clock"), link("trajectory"), determinant, plain, delta_j, closed)

    def _kernel(self, arithmetic: Arithmetic) -> MixedKernel:
        return mixed_kernel(self.run.hamiltonian, self.run.scheme, arithmetic, self.follow)

    def _limits(self, kernel: MixedKernel, arithmetic: Arithmetic) -> list[Number]:
        """What the kernel compares p, q and Λ with; UnsupportedError where they start beyond it."""
        if not kernel.limits:
            return []
        inputs = {n: Fraction(x) for n, x in named_inputs(kernel, self.inputs).items()}
        found = limits(kernel.wide, inputs, {n: Fraction(self.inputs[n]) for n in ("p", "q")})
        if found is None:
            name = arithmetic.name
            raise UnsupportedError(f"a step from the start may leave the range of {name}")
        return [float(found.p), float(found.q), arithmetic.number(found.part)]

    # -- bounds -------------------------------------------------------------------------------

    def _bounds(
        self, kernel: MixedKernel, arithmetic: Arithmetic, last: State
    ) -> dict[str, Fraction | None]:
        """A rigorous bound of every wide Λ, or None where there is none."""
        found: dict[str, Fraction | None] = {}
        for name in _WIDE:
            if f"w_{name}" in last:
                # What a wide state does to the steps after it is not counted.
                own: Fraction | None = None if name == "clock" else Fraction(0)
                if name == "trajectory":
                    own = self._of_delta_j(kernel, arithmetic, last)
                top = arithmetic.exact(last[f"w_{name}_top"])
                found[name] = _accumulated(self.run.steps, top, own, arithmetic)
        return found

    def _of_delta_j(
        self, kernel: MixedKernel, arithmetic: Arithmetic, last: State
    ) -> Fraction | None:
        """B: the error of one wide ΔJ, all over the region that the float64 states have visited."""
        lowering, root = kernel.wide.lowering, kernel.wide.outputs["dj"]
        with flint.ctx.workprec(PRECISION):
            # A float64 goes to a fixed-point number but for what is below its last place.
            cut = flint.arb(2) ** -arithmetic.bits if arithmetic.absolute else flint.arb(0)
            inputs = visited(kernel, self.inputs, last, cut)
            live, rounding = lowering.live([root]), rounding_of(arithmetic)
            found = analyse(lowering.program, live, inputs, rounding)
            error = None if found is None else found[root].error
            return None if error is None or not in_reach(error) else bounds(error)[1]


def rounded_inputs(run: KernelRun) -> dict[str, float]:
    """The start and the parameters that the kernel takes, as float64; Stopped where one is not."""
    exact = {**run.start, **{n: run.parameters[n] for n in run.hamiltonian.parameters}}
    number = float64.make(17).number
    found: dict[str, float] = {name: number(value) for name, value in exact.items()}
    for name, value in found.items():
        if not math.isfinite(value):
            raise Stopped("left range", 1, f"{name} is beyond the range of float64")
    return found


def _accumulated(
    steps: int, top: Fraction, own: Fraction | None, arithmetic: Arithmetic
) -> Fraction | None:
    """The bound of the module's docstring; M = `top`, B = `own`."""
    if own is None or top > Fraction(1, 2):
        return None
    rounded = 3 * _unit(arithmetic) if arithmetic.absolute else 12 * _unit(arithmetic) * top
    bound = 4 * steps * (rounded + 2 * own)
    return bound if bound <= Fraction(1, 100) else None


def _apart(
    name: str, first: Sequence[State], second: Sequence[State], coarse: Arithmetic, fine: Arithmetic
) -> Fraction:
    """Twice the greatest difference of two runs, and the last bits that it may hide."""
    x = [coarse.exact(state[f"w_{name}"]) for state in first]
    y = [fine.exact(state[f"w_{name}"]) for state in second]
    apart = max(abs(a - b) for a, b in zip(x, y, strict=True))
    return 2 * apart + _unit(coarse) * (1 if coarse.absolute else max(map(abs, x)))


def _unit(arithmetic: Arithmetic) -> Fraction:
    """One operation's error at most: relative, and twice that of rounding to nearest; or a unit."""
    return Fraction(1 if arithmetic.absolute else 2, 2**arithmetic.bits)


def _expm1(x: float) -> float:
    try:
        return math.expm1(x)
    except OverflowError:
        return math.inf
