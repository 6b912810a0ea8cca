"""A step read as a closed form: in a ring if H is a polynomial, else as expressions.

A composition may double in length with every stage when it is written out, so that the attempt ends
at a size limit.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, NoReturn

from verify.algebra.formula import symbol
from verify.algebra.ring import Poly
from verify.hamiltonians.canonical_field import PlainField
from verify.lazy_sympy import sympy
from verify.schemes.maps.closed_form import arguments, terms_of
from verify.schemes.steps.step_algebra import Number, StepAlgebra

if TYPE_CHECKING:
    from verify.schemes.steps.step_algebra import Step


class TooLongError(Exception):
    """A closed form is longer than allowed, or there is none."""


class _Writing:
    def __init__(self, field: PlainField) -> None:
        self.field, self.ring = field, field.ring

    @property
    def size(self) -> int:
        return len(self.field.names)

    def number(self, x: Number) -> Poly:
        return self.ring.constant(x) if isinstance(x, Fraction) else x

    def solve(self, *_: object) -> NoReturn:
        """Raise TooLongError: equations have no closed form."""
        raise TooLongError


class _Counting(_Writing, StepAlgebra[None]):
    """A step algebra that counts the terms of a step."""

    terms = 0

    @property
    def nothing(self) -> None:
        return None

    def along_flow(self, eta: int) -> list[None]:
        for n in range(1, eta + 1):
            self.terms += terms_of(self.ring, self.field.term(n))
        return [None] * self.size

    def slopes(self, changes: Sequence[None], clock: Number, places: Sequence[int]) -> list[None]:
        self.terms += terms_of(self.ring, [self.field.slopes[k] for k in places])
        return [None] * len(places)

    def shear(
        self, changes: Sequence[None], size: Number, clock: Number, places: Sequence[int]
    ) -> list[None]:
        self.terms += self.size + terms_of(self.ring, self.field.shears(size, places))
        return list(changes)

    def move(self, change: None, weights: Sequence[Number], slopes: Sequence[None]) -> None:
        self.terms += 1 + sum(w != 0 for w in weights)

    def add_share(self, x: None, y: None, share: Fraction) -> None:
        self.terms += 2

    def solve(self, count: int, *_: object) -> list[None]:  # type: ignore[override]
        return [None] * count


def terms_in(field: PlainField, step: Step) -> int:
    """Return the number of terms in the slopes and sums of a step, not written out."""
    counting = _Counting(field)
    step(counting)
    return counting.terms


class RingAlgebra(_Writing, StepAlgebra[Poly]):
    """Changes of z as elements of the field's ring, for a polynomial H; `most` limits terms."""

    def __init__(self, field: PlainField, most: int) -> None:
        super().__init__(field)
        self.most, self.h = most, field.ring.variable("h")

    @property
    def nothing(self) -> Poly:
        return self.ring.zero

    def along_flow(self, eta: int) -> list[Poly]:
        return self.field.flow_changes(eta)

    def slopes(self, changes: Sequence[Poly], clock: Number, places: Sequence[int]) -> list[Poly]:
        point = dict(zip(self.field.names, changes, strict=True))
        if self.field.timed:
            point["t"] = self.h * self.number(clock)
        shifted = {n: self.ring.variable(n) + x for n, x in point.items() if not x.is_zero()}
        elements = [self.field.slopes[k] for k in places]
        return [self._evaluate(x, list(shifted.items())) for x in elements]

    def move(self, change: Poly, weights: Sequence[Number], slopes: Sequence[Poly]) -> Poly:
        for weight, slope in zip(weights, slopes, strict=True):
            change = self._short(change + self.ring.reduce(self.h * self.number(weight) * slope))
        return change

    def add_share(self, x: Poly, y: Poly, share: Fraction) -> Poly:
        return x + self.ring.constant(share) * y

    def _evaluate(self, x: Poly, point: list[tuple[str, Poly]]) -> Poly:
        """Return the polynomial at a point, by Horner's rule in one variable after the other."""
        if not point:
            return x
        (name, value), *others = point
        powers, total = self.ring.powers(x, name), self.ring.zero
        for n in range(max(powers, default=0), -1, -1):
            inner = self._evaluate(powers[n], others) if n in powers else self.ring.zero
            total = self._short(self.ring.multiply(total, value) + inner)
        return total

    def _short(self, x: Poly) -> Poly:
        if len(x) > self.most:
            raise TooLongError
        return x


@dataclass(frozen=True)
class Written:
    """An expression, and the number of occurrences of coordinates in it."""

    expression: sympy.Expr
    count: int


class FormulaAlgebra(_Writing, StepAlgebra[Written]):
    """Changes of z as expressions; `most` limits the occurrences of coordinates in each."""

    def __init__(self, field: PlainField, most: int | None = None) -> None:
        super().__init__(field)
        self.most, self.h = most, symbol("h")

    @property
    def nothing(self) -> Written:
        return Written(sympy.S.Zero, 0)

    def along_flow(self, eta: int) -> list[Written]:
        return [self._substitute(x, {}) for x in self.field.flow_changes(eta)]

    def slopes(
        self, changes: Sequence[Written], clock: Number, places: Sequence[int]
    ) -> list[Written]:
        point = self._point(changes, clock)
        return [self._substitute(self.field.slopes[k], point) for k in places]

    def shear(
        self, changes: Sequence[Written], size: Number, clock: Number, places: Sequence[int]
    ) -> list[Written]:
        point, result = self._point(changes, clock), list(changes)
        for k, x in zip(places, self.field.shears(size, places), strict=True):
            move = self._substitute(x, point)
            total = changes[k].expression + move.expression
            result[k] = Written(total, changes[k].count + move.count)
        return result

    def _point(self, changes: Sequence[Written], clock: Number) -> dict[str, Written]:
        point = dict(zip(self.field.names, changes, strict=True))
        if self.field.timed and clock != 0:
            point["t"] = Written(self.h * self.ring.expression(self.number(clock)), 0)
        return point

    def move(
        self, change: Written, weights: Sequence[Number], slopes: Sequence[Written]
    ) -> Written:
        total, count = [change.expression], change.count
        for weight, slope in zip(weights, slopes, strict=True):
            if weight != 0:
                share = self.ring.expression(self.number(weight))
                total.append(self.h * share * slope.expression)
                count += slope.count
        return Written(sympy.Add(*total), count)

    def add_share(self, x: Written, y: Written, share: Fraction) -> Written:
        exact = sympy.Rational(share.numerator, share.denominator)
        return Written(x.expression + exact * y.expression, x.count + y.count)

    def _substitute(self, x: Poly, point: Mapping[str, Written]) -> Written:
        """Return the element with each coordinate moved by its change in `point`."""
        expression = self.ring.expression(x)
        nodes = list(sympy.preorder_traversal(expression)) if self.most is not None else []
        # Substitution multiplies sizes: the count is known before the expression is built.
        sizes = dict.fromkeys(self.field.names, 1)
        sizes |= {n: 1 + y.count for n, y in point.items() if n in sizes}
        count = sum(nodes.count(symbol(n)) * size for n, size in sizes.items())
        if self.most is not None and count > self.most:
            raise TooLongError
        moves = {symbol(n): symbol(n) + y.expression for n, y in point.items() if y.expression != 0}
        return Written(expression.xreplace(moves), count)


def is_polynomial(field: PlainField) -> bool:
    """Return True if f is a polynomial in z and t: neither occurs in a generator."""
    inside = arguments(field.ring, *field.slopes)
    moving = [*field.names, *("t" * field.timed)]
    return not any(field.ring.depends(a, name) for a in inside for name in moving)


def expressions_of(field: PlainField, step: Step, most: int | None = None) -> list[sympy.Expr]:
    """Return z' as expressions; TooLongError if coordinates occur more than `most` times."""
    changes = step(FormulaAlgebra(field, most))
    if most is not None and sum(1 + x.count for x in changes) > most:
        raise TooLongError
    pairs = zip(field.names, changes, strict=True)
    return [symbol(name) + x.expression for name, x in pairs]


def elements_of(field: PlainField, step: Step, most: int) -> tuple[Poly, ...]:
    """Return z' of a polynomial H in its field's ring; TooLongError beyond `most` terms."""
    changes = step(RingAlgebra(field, most))
    return tuple(x + y for x, y in zip(field.start, changes, strict=True))
