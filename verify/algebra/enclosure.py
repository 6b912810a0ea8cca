"""Enclosing a ring element at a rational point by ball arithmetic, and points to look at."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property, lru_cache
from itertools import product

import flint

from verify.algebra.differential_ring import DifferentialRing
from verify.algebra.generator import Generator, Poly, terms_of
from verify.arithmetic.flint_precision import working_precision
from verify.functions import in_rings
from verify.functions.function import Function

Ball = flint.arb
_FAR_POINTS = 200


def enclose(
    ring: DifferentialRing, x: Poly, point: Mapping[str, Fraction], precision: int
) -> Ball | None:
    """A ball (flint.arb) that contains x at the point, or None where x is not defined.

    Leaves flint's global context as it was. A polynomial in the variables is evaluated exactly.
    """
    if ring.in_variables(x):
        at = [flint.fmpq()] * ring.room
        for name, power in zip(ring.variables, x.degrees()[ring.room :], strict=True):
            value = point[name] if power > 0 else Fraction()  # the degree of 0 is −1
            at.append(flint.fmpq(value.numerator, value.denominator))
        with working_precision(precision):
            return flint.arb(x(*at))
    found = Enclosures(ring, [x]).at(point, precision)
    return None if found is None else found[0]


def enclosed(
    ring: DifferentialRing, x: Poly, point: Mapping[str, Fraction], precision: int
) -> Ball:
    """As `enclose`, of what is defined there; ValueError where it may not be."""
    ball = enclose(ring, x, point, precision)
    if ball is None:
        raise ValueError(f"an element is not defined at {dict(point)}")
    return ball


def enclose_over(ring: DifferentialRing, x: Poly, box: Mapping[str, Ball]) -> Ball | None:
    """A ball that contains x at every point of a box of balls, or None where x may be undefined.

    In flint's present precision.
    """
    found = enclose_all(ring, [x], box)
    return None if found is None else found[0]


def enclose_all(
    ring: DifferentialRing, elements: Sequence[Poly], box: Mapping[str, Ball]
) -> list[Ball] | None:
    """A ball for each of the elements, as `enclose_over`; None where one may be undefined."""
    return Enclosures(ring, elements).over(box)


def power_of(x: Ball, n: int) -> Ball:
    """xⁿ of a ball, n ≥ 1, as narrow as its squares are."""
    # arb's own ** goes by the logarithm for an exponent that it does not see to be an integer,
    # and is then undefined around 0.
    half = square(power_of(x, n // 2)) if n > 1 else flint.arb(1)
    return half * x if n % 2 else half


def _of_balls(function: Function) -> Callable[[Ball, int], Ball]:
    """The function as it is of balls, in the form that a root has, of a degree."""
    of_balls: Callable[[Ball], Ball] = function.of_balls(flint.arb)
    return lambda x, _: of_balls(x)


def square(x: Ball) -> Ball:
    """x² of a ball: as narrow as its ends are, which x · x is not."""
    low, high = x.abs_lower(), x.abs_upper()
    return (low * low).union(high * high)


BALLS: dict[str, Callable[[Ball, int], Ball]] = {
    **{name: _of_balls(function) for name, function in in_rings().items()},
    "root": lambda x, n: x.root(n),
    "inverse": lambda x, _: 1 / x,
}


def points(names: Sequence[str]) -> Iterator[dict[str, Fraction]]:
    """Rational points to look for a witness at: small ones first, then ever farther ones.

    Without a pattern that a formula could share, and of both signs, since a root or a logarithm
    may be defined on one side only, or far out; the same points in every call.
    """
    for values in _halton_points(len(names)):
        yield dict(zip(names, values, strict=True))
    state = 12345
    for count in range(_FAR_POINTS):
        point = {}
        for name in names:
            state = (1103515245 * state + 12345) % 2**31
            reach = 2 + 10 * count // _FAR_POINTS  # up to 2^reach, and down to 2^−reach
            scale = Fraction(2) ** (state // 4096 % (2 * reach) - reach + 1)
            value = Fraction(state % 4096 + 1, 4096) * scale
            point[name] = value if state >> 29 & 1 else -value
        yield point


@lru_cache(maxsize=16)
def _halton_points(count: int) -> list[tuple[Fraction, ...]]:
    """So many coordinates of each of the first points."""
    primes = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29)
    size = [Fraction(primes[(k + 3) % 10], primes[(k + 6) % 10]) for k in range(count)]
    signs = list(product((1, -1), repeat=min(count, 4))) or [()]
    found = []
    for scale in (Fraction(1), Fraction(1, 16)):
        for sign in signs:
            full = (*sign, *(1 for _ in range(count - len(sign))))
            found.append(tuple(scale * s * v for s, v in zip(full, size, strict=True)))
    return found


Terms = list[tuple[flint.fmpq, list[tuple[int, int]]]]  # coefficients, generators with their powers


class Enclosures:
    """Some elements of a ring that are enclosed again and again, over other boxes: read once.

    Equal elements are evaluated once.
    """

    def __init__(self, ring: DifferentialRing, elements: Sequence[Poly]) -> None:
        self.ring, self.elements = ring, elements

    @cached_property
    def _generators(self) -> list[tuple[Generator, Terms]]:
        used = self.ring.generators_in(*self.elements)
        return [(g, [] if g.argument is None else _terms(g.argument)) for g in used]

    @cached_property
    def _distinct(self) -> tuple[list[Terms], list[int]]:
        """The terms of those elements that differ, and of each element its number among them."""
        distinct: list[Poly] = []
        numbers = []
        for x in self.elements:
            if x not in distinct:
                distinct.append(x)
            numbers.append(distinct.index(x))
        return [_terms(x) for x in distinct], numbers

    def at(self, point: Mapping[str, Fraction], precision: int) -> list[Ball] | None:
        """Balls that contain them at the point, or None where one is not defined there."""
        with working_precision(precision):
            return self.over(
                {
                    name: flint.arb(flint.fmpq(at.numerator, at.denominator))
                    for name, at in point.items()
                }
            )

    def over(self, box: Mapping[str, Ball]) -> list[Ball] | None:
        """Balls that contain them at every point of the box, or None where one may be undefined.

        In flint's present precision.
        """
        at = _Point()
        for g, argument in self._generators:
            value = _value(g, argument, at, box)
            if not value.is_finite():
                return None
            at.values[g.index] = value
        terms, numbers = self._distinct
        found = [at(own) for own in terms]
        return [found[k] for k in numbers]


class _Point:
    """The balls of generators, and their powers as far as they were asked for."""

    def __init__(self) -> None:
        self.values: dict[int, Ball] = {}
        self.powers: dict[tuple[int, int], Ball] = {}

    def __call__(self, terms: Terms) -> Ball:
        total, powers = flint.arb(0), self.powers
        for coefficient, factors in terms:
            term = flint.arb(coefficient)
            for factor in factors:
                known = powers.get(factor)
                if known is None:
                    known = powers[factor] = power_of(self.values[factor[0]], factor[1])
                term *= known
            total += term
        return total


def _value(g: Generator, argument: Terms, at: _Point, box: Mapping[str, Ball]) -> Ball:
    if g.kind == "variable":
        return box[g.name]
    if g.kind == "pi":
        return flint.arb.pi()
    return BALLS[g.kind](at(argument), g.degree)


def _terms(x: Poly) -> Terms:
    present = [index for index, degree in enumerate(x.degrees()) if degree > 0]
    return [
        (coefficient, [(index, int(n)) for index in present if (n := monomial[index])])
        for monomial, coefficient in terms_of(x)
    ]
