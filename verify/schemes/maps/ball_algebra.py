"""A step and its Jacobian in balls: the operations of a scheme's step, evaluated in ball
arithmetic.

A value is the change of one coordinate with its gradient by z. Derivatives are propagated from
stage to stage, so that the map's Jacobian is never written out. No code is shared with the kernels.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import islice

import flint

from verify.algebra.enclosure import Enclosures, enclose_over, points
from verify.algebra.ring import Poly
from verify.arithmetic.arb import Ball, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.hamiltonians.canonical_field import CanonicalField, PlainField
from verify.schemes.maps.closed_form import ClosedForm
from verify.schemes.steps.step_algebra import Number, Step, StepAlgebra


class UndefinedError(ArithmeticError):
    """A step may be undefined somewhere in a box, or it solves equations."""


@dataclass(frozen=True)
class Change:
    """A ball, and balls of its derivatives by each coordinate at the beginning of the step."""

    value: Ball
    gradient: tuple[Ball, ...]

    def plus(self, factor: Ball, other: "Change") -> "Change":
        """Return self + factor · other."""
        pairs = zip(self.gradient, other.gradient, strict=True)
        return Change(self.value + factor * other.value, tuple(x + factor * y for x, y in pairs))


class BallAlgebra(StepAlgebra[Change]):
    """The step algebra over a box, given as balls of z, and of t if H depends on it.

    It works at flint's present precision.
    """

    def __init__(self, field: PlainField, point: Mapping[str, Ball], h: Ball) -> None:
        self.field, self.point, self.h = field, point, h

    @property
    def nothing(self) -> Change:
        return Change(flint.arb(0), (flint.arb(0),) * self.size)

    @property
    def size(self) -> int:
        return len(self.field.names)

    def along_flow(self, eta: int) -> list[Change]:
        changes, power = [self.nothing] * self.size, flint.arb(1)
        for n in range(1, eta + 1):
            power *= self.h
            terms = self._evaluate(_flow_enclosures(self.field, n), self.point)
            changes = [x.plus(power, y) for x, y in zip(changes, terms, strict=True)]
        return changes

    def slopes(
        self, changes: Sequence[Change], clock: Number, places: Sequence[int]
    ) -> list[Change]:
        box = dict(self.point)
        for name, change in zip(self.field.names, changes, strict=True):
            box[name] = box[name] + change.value
        if self.field.timed:
            box["t"] = box["t"] + self._number(clock) * self.h
        elements = self._evaluate(_slope_enclosures(self.field, tuple(places)), box)
        return [Change(x.value, self._chain(x.gradient, changes)) for x in elements]

    def move(self, change: Change, weights: Sequence[Number], slopes: Sequence[Change]) -> Change:
        for weight, slope in zip(weights, slopes, strict=True):
            change = change.plus(self.h * self._number(weight), slope)
        return change

    def add_share(self, x: Change, y: Change, share: Fraction) -> Change:
        return x.plus(rational_ball(share), y)

    def solve(
        self, count: int, right: Callable[[StepAlgebra[Change], Sequence[Change]], list[Change]]
    ) -> list[Change]:
        raise UndefinedError  # balls solve no equations

    def from_closed_form(self, closed_form: ClosedForm) -> list[Change]:
        """Return z' − z of a map that is written out."""
        return self._evaluate(_closed_form_enclosures(closed_form), {**self.point, "h": self.h})

    def _number(self, x: Number) -> Ball:
        if isinstance(x, Fraction):
            return rational_ball(x)
        ball = enclose_over(self.field.ring, x, {})
        if ball is None:
            raise UndefinedError
        return ball

    def _evaluate(self, enclosures: Enclosures, box: Mapping[str, Ball]) -> list[Change]:
        """Return elements with their gradients; UndefinedError if one may be undefined."""
        balls = enclosures.enclose_over(box)
        if balls is None or not all(x.is_finite() for x in balls):
            raise UndefinedError
        width = self.size + 1
        rows = [balls[k : k + width] for k in range(0, len(balls), width)]
        return [Change(row[0], tuple(row[1:])) for row in rows]

    def _chain(self, gradient: Sequence[Ball], changes: Sequence[Change]) -> tuple[Ball, ...]:
        """Return the derivative of f(z + change): f_j (δ_jm + ∂change_j/∂z_m), summed over j."""
        total = list(gradient)
        for slope, change in zip(gradient, changes, strict=True):
            total = [x + slope * y for x, y in zip(total, change.gradient, strict=True)]
        return tuple(total)


@lru_cache(maxsize=64)
def _slope_enclosures(field: PlainField, places: tuple[int, ...]) -> Enclosures:
    return _with_gradients(field, [field.slopes[k] for k in places])


@lru_cache(maxsize=64)
def _flow_enclosures(field: PlainField, n: int) -> Enclosures:
    return _with_gradients(field, field.term(n))


@lru_cache(maxsize=64)
def _closed_form_enclosures(closed_form: ClosedForm) -> Enclosures:
    return _with_gradients(closed_form.field, closed_form.increments)


def _with_gradients(field: PlainField, elements: Sequence[Poly]) -> Enclosures:
    with_slopes = [y for x in elements for y in (x, *field.gradient(x))]
    return Enclosures(field.ring, with_slopes)


def step_in_balls(
    field: PlainField,
    step: Step | ClosedForm,
    point: Mapping[str, Ball],
    h: Ball,
) -> tuple[list[Ball], flint.arb_mat]:
    """Return z' − z and K = J − 1 over a box, at flint's present precision.

    Raises UndefinedError if the step may be undefined there, or solves equations.
    """
    algebra = BallAlgebra(field, point, h)
    changes = algebra.from_closed_form(step) if isinstance(step, ClosedForm) else step(algebra)
    return [x.value for x in changes], flint.arb_mat([list(x.gradient) for x in changes])


_POINTS, _BITS = 8, 128  # tested points, and their precision
Point = Mapping[str, Ball]


def may_preserve(field: PlainField, step: Step) -> bool:
    """Return False if S = JᵀΩJ − Ω is shown not to be 0 at a tested point, else True.

    Most steps that are not symplectic are refuted at the first point.
    """
    n = len(field.names) // 2
    omega = flint.arb_mat(2 * n, 2 * n)
    for i in range(n):
        omega[i, n + i], omega[n + i, i] = flint.arb(1), flint.arb(-1)

    def gap(_: Point, __: Sequence[Ball], slopes: flint.arb_mat) -> Sequence[Ball]:
        # S = KᵀΩ + ΩK + KᵀΩK with K = J − 1: no entry near 1 cancels.
        across = slopes.transpose() * omega
        entries: Sequence[Ball] = (across + omega * slopes + across * slopes).entries()
        return entries

    return _may_vanish(field, step, gap)


def may_conserve(field: CanonicalField, step: Step | ClosedForm) -> bool:
    """Return False if a step is shown to change H at a tested point, else True."""
    energy = Enclosures(field.ring, [field.energy])

    def gap(point: Point, changes: Sequence[Ball], _: flint.arb_mat) -> Sequence[Ball]:
        end_point = {name: point[name] + x for name, x in zip(field.names, changes, strict=True)}
        before, after = energy.enclose_over(point), energy.enclose_over({**point, **end_point})
        return [after[0] - before[0]] if before and after else []

    return _may_vanish(field, step, gap)


def may_be_uniform(field: PlainField, step: Step | ClosedForm) -> bool:
    """Return False if det J is shown to differ between tested points, else True."""
    first: list[Ball] = []

    def gap(_: Point, __: Sequence[Ball], slopes: flint.arb_mat) -> Sequence[Ball]:
        size = slopes.nrows()
        one = flint.arb_mat([[flint.arb(i == j) for j in range(size)] for i in range(size)])
        first.append((one + slopes).det())
        return [first[-1] - first[0]]

    return _may_vanish(field, step, gap)


def _may_vanish(
    field: PlainField,
    step: Step | ClosedForm,
    gap: Callable[[Point, Sequence[Ball], flint.arb_mat], Sequence[Ball]],
) -> bool:
    """Return False if a ball of `gap` excludes 0 at a tested point, else True."""
    names, h = [name for name in field.ring.variables if name != "h"], Fraction(1, 16)
    with working_precision(_BITS):
        # One h is enough: a defect that is not 0 at h = 1/16 is not identically 0.
        for numbers in islice(points(names), _POINTS):
            point = {name: rational_ball(x) for name, x in numbers.items()}
            try:
                balls = gap(point, *step_in_balls(field, step, point, rational_ball(h)))
            except UndefinedError:
                continue
            if any(x.is_finite() and not x.contains(0) for x in balls):
                return False
    return True
