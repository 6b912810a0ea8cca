"""Enclosures of ring elements at rational points by ball arithmetic, and points to try."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property, lru_cache
from itertools import product

import flint

from verify.algebra.differential_ring import DifferentialRing
from verify.algebra.identities.polynomials import Generator, Poly, terms_of
from verify.arithmetic.flint_precision import working_precision
from verify.functions import in_rings
from verify.functions.function import Function

Ball = flint.arb
_FAR_POINTS = 200


def enclose(
    ring: DifferentialRing, x: Poly, point: Mapping[str, Fraction], precision: int
) -> Ball | None:
    """Return a ball (flint.arb) that contains x at the point, or None if x is not defined.

    `precision`: in bits. A polynomial in the variables is evaluated exactly, and rounded once.
    """
    if ring.in_variables(x):
        values = [flint.fmpq()] * ring.room
        for name, power in zip(ring.variables, x.degrees()[ring.room :], strict=True):
            value = point[name] if power > 0 else Fraction()  # the degree of 0 is −1
            values.append(flint.fmpq(value.numerator, value.denominator))
        with working_precision(precision):
            return flint.arb(x(*values))
    balls = Enclosures(ring, [x]).enclose_at(point, precision)
    return None if balls is None else balls[0]


def enclose_defined(
    ring: DifferentialRing, x: Poly, point: Mapping[str, Fraction], precision: int
) -> Ball:
    """Return a ball that contains x at the point. Raises ValueError if x may be undefined there."""
    ball = enclose(ring, x, point, precision)
    if ball is None:
        raise ValueError(f"an element is not defined at {dict(point)}")
    return ball


def enclose_over(ring: DifferentialRing, x: Poly, box: Mapping[str, Ball]) -> Ball | None:
    """Return a ball that contains x at every point of a box, or None if x may be undefined.

    The box has a ball for each variable. The computation is at flint's present precision.
    """
    balls = enclose_all(ring, [x], box)
    return None if balls is None else balls[0]


def enclose_all(
    ring: DifferentialRing, elements: Sequence[Poly], box: Mapping[str, Ball]
) -> list[Ball] | None:
    """Enclose each of the elements as `enclose_over` does; None if one may be undefined."""
    return Enclosures(ring, elements).enclose_over(box)


def power_of(x: Ball, n: int) -> Ball:
    """Return xⁿ of a ball, n ≥ 1, by squaring, which keeps the ball narrow."""
    # arb's ** uses the logarithm, which is undefined around 0, if it does not see that the exponent
    # is an integer.
    half = square(power_of(x, n // 2)) if n > 1 else flint.arb(1)
    return half * x if n % 2 else half


def _of_balls(function: Function) -> Callable[[Ball, int], Ball]:
    """Return the function on balls; a second argument, the degree of a root, is ignored."""
    of_balls: Callable[[Ball], Ball] = function.of_balls(flint.arb)
    return lambda x, _: of_balls(x)


def square(x: Ball) -> Ball:
    """Return x² of a ball, from the least and the greatest |x|; it is narrower than x · x."""
    low, high = x.abs_lower(), x.abs_upper()
    return (low * low).union(high * high)


BALLS: dict[str, Callable[[Ball, int], Ball]] = {
    **{name: _of_balls(function) for name, function in in_rings().items()},
    "root": lambda x, n: x.root(n),
    "inverse": lambda x, _: 1 / x,
}


def points(names: Sequence[str]) -> Iterator[dict[str, Fraction]]:
    """Yield rational points at which a witness is sought: first near 0, then farther and farther.

    Their coordinates have both signs, since a root or a logarithm may be defined on one side only,
    or far out; and no simple relations, which a formula might share. Every call yields the same
    points.
    """
    for values in _halton_points(len(names)):
        yield dict(zip(names, values, strict=True))
    state = 12345
    for count in range(_FAR_POINTS):
        point = {}
        for name in names:
            # A linear congruential generator with a fixed seed, so that witnesses are reproducible.
            state = (1103515245 * state + 12345) % 2**31
            reach = 2 + 10 * count // _FAR_POINTS  # sizes are from 2^−reach to 2^reach
            scale = Fraction(2) ** (state // 4096 % (2 * reach) - reach + 1)
            value = Fraction(state % 4096 + 1, 4096) * scale
            point[name] = value if state >> 29 & 1 else -value
        yield point


@lru_cache(maxsize=16)
def _halton_points(count: int) -> list[tuple[Fraction, ...]]:
    """Return the first points, near the origin, with `count` coordinates."""
    primes = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29)
    size = [Fraction(primes[(k + 3) % 10], primes[(k + 6) % 10]) for k in range(count)]
    signs = list(product((1, -1), repeat=min(count, 4))) or [()]
    values = []
    for scale in (Fraction(1), Fraction(1, 16)):
        for sign in signs:
            full = (*sign, *(1 for _ in range(count - len(sign))))
            values.append(tuple(scale * s * v for s, v in zip(full, size, strict=True)))
    return values


Terms = list[tuple[flint.fmpq, list[tuple[int, int]]]]  # (coefficient, [(generator, power), …])


class Enclosures:
    """Elements of a ring to be enclosed over many boxes; equal ones are evaluated once."""

    def __init__(self, ring: DifferentialRing, elements: Sequence[Poly]) -> None:
        self.ring, self.elements = ring, elements

    @cached_property
    def _generators(self) -> list[tuple[Generator, Terms]]:
        generators = self.ring.generators_in(*self.elements)
        return [(g, [] if g.argument is None else _terms(g.argument)) for g in generators]

    @cached_property
    def _distinct(self) -> tuple[list[Terms], list[int]]:
        """The terms of the distinct elements, and for each element its number among these."""
        distinct: list[Poly] = []
        numbers = []
        for x in self.elements:
            if x not in distinct:
                distinct.append(x)
            numbers.append(distinct.index(x))
        return [_terms(x) for x in distinct], numbers

    def enclose_at(self, point: Mapping[str, Fraction], precision: int) -> list[Ball] | None:
        """Return balls that contain the elements at the point; None if one may be undefined."""
        with working_precision(precision):
            return self.enclose_over(
                {
                    name: flint.arb(flint.fmpq(value.numerator, value.denominator))
                    for name, value in point.items()
                }
            )

    def enclose_over(self, box: Mapping[str, Ball]) -> list[Ball] | None:
        """Return balls that contain the elements over the box; None if one may be undefined in it.

        The computation is at flint's present precision.
        """
        balls_of_generators = _Point()
        for g, argument in self._generators:
            # Generators come oldest first: the generators of an argument have balls already.
            value = _value(g, argument, balls_of_generators, box)
            if not value.is_finite():
                return None
            balls_of_generators.values[g.index] = value
        terms, numbers = self._distinct
        balls = [balls_of_generators(terms_of_element) for terms_of_element in terms]
        return [balls[k] for k in numbers]


class _Point:
    """The balls of generators, and a cache of their powers."""

    def __init__(self) -> None:
        self.values: dict[int, Ball] = {}
        self.powers: dict[tuple[int, int], Ball] = {}

    def __call__(self, terms: Terms) -> Ball:
        total, powers = flint.arb(0), self.powers
        for coefficient, factors in terms:
            term = flint.arb(coefficient)
            for factor in factors:
                value = powers.get(factor)
                if value is None:
                    value = powers[factor] = power_of(self.values[factor[0]], factor[1])
                term *= value
            total += term
        return total


def _value(g: Generator, argument: Terms, point: _Point, box: Mapping[str, Ball]) -> Ball:
    if g.kind == "variable":
        return box[g.name]
    if g.kind == "pi":
        return flint.arb.pi()
    return BALLS[g.kind](point(argument), g.degree)


def _terms(x: Poly) -> Terms:
    present = [index for index, degree in enumerate(x.degrees()) if degree > 0]
    return [
        (coefficient, [(index, int(n)) for index in present if (n := monomial[index])])
        for monomial, coefficient in terms_of(x)
    ]
