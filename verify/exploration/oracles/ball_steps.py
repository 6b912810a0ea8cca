"""Steps of a map in ball arithmetic, with the Jacobian of each, in the plane and in n degrees.

No kernel is written for them: an oracle for the number systems that shares no code with those, and
rigorous. In the plane the ring's own elements are enclosed, term by term; in n degrees of freedom a
step is made as told below. ΔJ is taken from the entries of J, not from its closed form.

A step in balls, with its derivatives by z: what a scheme's step is made of, read with balls.

A value is a change of one coordinate and its gradient. Nothing of a kernel's program is in it, and
no Jacobian that is written out: the slopes' own derivatives are enclosed at each stage.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import combinations

import flint

from verify.algebra.enclosure import Enclosures, enclose_all, enclose_over
from verify.algebra.ring import Poly
from verify.arithmetic.arb import Ball, rational_ball, shown
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.property import Silent, known, only_if
from verify.hamiltonians.canonical_field import CanonicalField
from verify.schemes.degrees.canonical_map import CanonicalMap
from verify.schemes.step_algebra import Number, StepAlgebra
from verify.schemes.step_map import StepMap


@dataclass(frozen=True)
class Change:
    """A ball, and balls of its derivatives by each coordinate at the beginning of the step."""

    value: Ball
    gradient: tuple[Ball, ...]

    def plus(self, factor: Ball, other: "Change") -> "Change":
        """self + factor · other."""
        pairs = zip(self.gradient, other.gradient, strict=True)
        return Change(self.value + factor * other.value, tuple(x + factor * y for x, y in pairs))


class BallAlgebra(StepAlgebra[Change]):
    """At a point of balls, with t where H depends on it; in flint's present precision."""

    def __init__(self, field: CanonicalField, point: Mapping[str, Ball], h: Ball) -> None:
        self.field, self.point, self.h = field, point, h

    @property
    def nothing(self) -> Change:
        return Change(flint.arb(0), (flint.arb(0),) * self.size)

    @property
    def size(self) -> int:
        return len(self.field.names)

    def along_flow(self, eta: int) -> list[Change]:
        found, power = [self.nothing] * self.size, flint.arb(1)
        for n in range(1, eta + 1):
            power *= self.h
            terms = self._at(_of_flow(self.field, n), self.point)
            found = [x.plus(power, y) for x, y in zip(found, terms, strict=True)]
        return found

    def slopes(
        self, changes: Sequence[Change], clock: Number, places: Sequence[int]
    ) -> list[Change]:
        box = dict(self.point)
        for name, change in zip(self.field.names, changes, strict=True):
            box[name] = box[name] + change.value
        if self.field.timed:
            box["t"] = box["t"] + self._number(clock) * self.h
        found = self._at(_of_slopes(self.field, tuple(places)), box)
        return [Change(x.value, self._chained(x.gradient, changes)) for x in found]

    def moved(self, change: Change, weights: Sequence[Number], slopes: Sequence[Change]) -> Change:
        for weight, slope in zip(weights, slopes, strict=True):
            change = change.plus(self.h * self._number(weight), slope)
        return change

    def between(self, x: Change, y: Change, share: Fraction) -> Change:
        return x.plus(rational_ball(share), y)

    def solved(
        self, count: int, right: Callable[[StepAlgebra[Change], Sequence[Change]], list[Change]]
    ) -> list[Change]:
        raise Silent  # equations are not solved here

    def closed(self, step: CanonicalMap) -> list[Change]:
        """z' − z of a map that is written out."""
        return self._at(_of_closed(step), {**self.point, "h": self.h})

    def _number(self, x: Number) -> Ball:
        if isinstance(x, Fraction):
            return rational_ball(x)
        return known(enclose_over(self.field.ring, x, {}))

    def _at(self, wanted: Enclosures, box: Mapping[str, Ball]) -> list[Change]:
        """Elements with their gradients; Silent where one is not defined."""
        balls = known(wanted.over(box))
        width = self.size + 1
        rows = [balls[k : k + width] for k in range(0, len(balls), width)]
        return [Change(row[0], tuple(row[1:])) for row in rows]

    def _chained(self, gradient: Sequence[Ball], changes: Sequence[Change]) -> tuple[Ball, ...]:
        """The derivative of f(z + change): f_j (δ_jm + ∂change_j/∂z_m), summed over j."""
        found = list(gradient)
        for slope, change in zip(gradient, changes, strict=True):
            found = [x + slope * y for x, y in zip(found, change.gradient, strict=True)]
        return tuple(found)


@lru_cache(maxsize=64)
def _of_slopes(field: CanonicalField, places: tuple[int, ...]) -> Enclosures:
    return _with_gradients(field, [field.slopes[k] for k in places])


@lru_cache(maxsize=64)
def _of_flow(field: CanonicalField, n: int) -> Enclosures:
    return _with_gradients(field, field.term(n))


@lru_cache(maxsize=64)
def _of_closed(step: CanonicalMap) -> Enclosures:
    field = step.field
    pairs = zip(known(step.closed), field.start, strict=True)
    return _with_gradients(field, [x - z for x, z in pairs])


def _with_gradients(field: CanonicalField, elements: Sequence[Poly]) -> Enclosures:
    every = [y for x in elements for y in (x, *field.gradient(x))]
    return Enclosures(field.ring, every)


BITS = 320
_SHARP = 120  # bits that a ball must know to be worth comparing
Matrix = flint.arb_mat
Point = dict[str, Ball]


@dataclass(frozen=True)
class BallState:
    """After so many steps: the point by name (with t where H depends on it), the Jacobian of all of
    them, `matrix`, that of the last, `own`, and Π det J_k over them."""

    point: Point
    matrix: Matrix
    own: Matrix
    product: Ball

    def sharp(self) -> "BallState":
        """The same; Silent where a number is too wide to be told from others.

        In the plane the product stands for the Jacobian, whose entries may be wide where it is not.
        """
        planar = self.matrix.nrows() == 2
        only_if(all(map(sharp, self.point.values())))
        only_if(all(map(sharp, [self.product] if planar else self.matrix.entries())))
        return self


def ball_steps(
    step: StepMap | CanonicalMap, start: Mapping[str, Fraction], steps: int, bits: int = BITS
) -> Sequence[BallState]:
    """The states after 0, 1, … steps; Silent where the map solves equations, or is not defined.

    `start`: the coordinates, h, which may be negative, and t where H depends on it.
    """
    only_if(not step.implicit)
    with working_precision(bits):
        point = {name: rational_ball(x) for name, x in start.items() if name != "h"}
        one = identity(len(step.hamiltonian.coordinates))
        states = [BallState(point, one, one, flint.arb(1))]
        for _ in range(steps):
            states.append(stepped(step, states[-1], rational_ball(start["h"])))
    return states


def stepped(step: StepMap | CanonicalMap, state: BallState, h: Ball) -> BallState:
    """One step from a state, in flint's present precision; Silent where it is not defined."""
    if isinstance(step, StepMap):
        point, own, determinant = _by_substeps(step, state.point, h)
    else:
        point, own = _by_changes(step, state.point, h)
        determinant = own.det()
    if "t" in point:
        point["t"] += h
    return BallState(point, own * state.matrix, own, state.product * determinant)


def _by_substeps(step: StepMap, start: Point, h: Ball) -> tuple[Point, Matrix, Ball]:
    """Where a step in the plane ends, at the same t, its Jacobian, and det J part by part."""
    point, own, determinant = dict(start), identity(2), flint.arb(1)
    for part in step.substeps:
        wanted = part.p_next, part.q_next, *part.jacobian
        p, q, *entries = _finite(known(enclose_all(part.ring, wanted, {**point, "h": h})))
        point |= {"p": p, "q": q}
        jacobian = Matrix(2, 2, entries)
        own, determinant = jacobian * own, determinant * jacobian.det()
    return point, own, determinant


def _by_changes(step: CanonicalMap, start: Point, h: Ball) -> tuple[Point, Matrix]:
    """The same in n degrees of freedom, without det J."""
    names, point = step.field.names, dict(start)
    algebra = BallAlgebra(step.field, point, h)
    changes = algebra.closed(step) if step.step is None else step.step(algebra)
    _finite([x for change in changes for x in (change.value, *change.gradient)])
    for name, change in zip(names, changes, strict=True):
        point[name] += change.value
    return point, Matrix([list(change.gradient) for change in changes]) + identity(len(names))


def _finite(balls: Sequence[Ball]) -> Sequence[Ball]:
    """The same; Silent where one is not finite."""
    only_if(all(x.is_finite() for x in balls))
    return balls


def identity(size: int) -> Matrix:
    """The matrix 1."""
    return Matrix([[int(a == b) for b in range(size)] for a in range(size)])


def omega(size: int) -> Matrix:
    """Ω of Σ dp_i∧dq_i, of z = (p1 … pn, q1 … qn)."""
    n = size // 2
    return Matrix([[(b == a + n) - (a == b + n) for b in range(size)] for a in range(size)])


def defect(jacobian: Matrix) -> Matrix:
    """JᵀΩJ − Ω, in flint's present precision."""
    canonical = omega(jacobian.nrows())
    return jacobian.transpose() * canonical * jacobian - canonical


def entries(form: Matrix) -> Iterator[Ball]:
    """Those of an antisymmetric matrix above its diagonal."""
    for a, b in combinations(range(form.nrows()), 2):
        yield form[a, b]


def largest(form: Matrix) -> Ball:
    """The greatest |entry|."""
    found = flint.arb(0)
    for x in entries(form):
        found = found.max(abs(x))
    return found


def overlap(x: Matrix, y: Matrix) -> bool:
    """Whether two matrices may be the same."""
    return all(a.overlaps(b) for a, b in zip(x.entries(), y.entries(), strict=True))


def unlike(found: Ball, wanted: Ball) -> str:
    """`found` and what it should be, with their difference, which 12 digits may not show."""
    with working_precision(BITS):
        difference = found - wanted
    given = f"{shown(found, 12)}, and should be {shown(wanted, 12)}"
    return f"{given} (too large by {shown(difference, 3)})"


def sharp(x: Ball) -> bool:
    """Whether a ball is narrow: relative to numbers beyond 1, and absolute below."""
    return bool(x.is_finite()) and x.rad() * 2**_SHARP < 1 + x.abs_lower()
