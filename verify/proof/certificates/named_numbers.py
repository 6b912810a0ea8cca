"""Algebraic numbers of a certificate: each name is checked to stand for one root of a polynomial.

`numbers` is a list of [name, polynomial, low, high]. The polynomial is the list of its coefficients
c₀, c₁, …, whole numbers. Its values at the ends of the interval have different signs, so that it
has a root between them. Its derivative f has one sign between them, so that there is no second
root: all coefficients of the polynomial (1 + x)ⁿ f((low + high·x)/(1 + x)) have one sign or are 0,
and x > 0 between the ends.

A multiple of a number's polynomial has the value 0: `QuotientRing` reduces by such multiples.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from keyword import iskeyword
from math import lcm

from verify.proof.certificates.readers import (
    RESERVED,
    Monomial,
    Poly,
    array_of,
    bits_of,
    need,
    number_of,
    short,
    text_of,
)

MOST_NUMBERS = 8
MOST_DEGREE = 32
_MOST_DIGITS = 200  # limit for numerators and denominators of coefficients and ends
_MOST_BITS = 1 << 14  # limit for a coefficient in a reduced polynomial
_MOST_WORK = 100_000  # limit in terms, long ones counting more; it takes some seconds
# Printed formulas use p1, q2, P1, … for the points of a scheme, and H, T, V for functions.
_NAME = re.compile(r"(?![pq][0-9]*$)[a-z][a-z0-9_]{0,31}")


@dataclass(frozen=True)
class AlgebraicNumber:
    """The only root, between `low` and `high`, of the polynomial with coefficients c₀, c₁, …."""

    name: str
    polynomial: tuple[int, ...]
    low: Fraction
    high: Fraction

    @property
    def ends(self) -> str:
        """The interval as text."""
        return f"[{self.low}, {self.high}]"


def read_numbers(data: object) -> tuple[AlgebraicNumber, ...]:
    """Read the numbers; ValueError unless each has a new name and is a single root."""
    listed = array_of(data, "numbers")
    need(len(listed) <= MOST_NUMBERS, f"numbers: there are more than {MOST_NUMBERS}")
    numbers: dict[str, AlgebraicNumber] = {}
    for listed_number in listed:
        entry = array_of(listed_number, "numbers")
        need(len(entry) == 4, "numbers: each is a name, a polynomial and the ends of an interval")
        name, problem = text_of(entry[0], "numbers"), f"numbers: {short(entry[0])} is no new name"
        new = _NAME.fullmatch(name) and not iskeyword(name) and name not in {*RESERVED, *numbers}
        need(new, problem)
        coefficients = [_read_limited(x, name) for x in array_of(entry[1], f"numbers: {name}")]
        integral = all(x.denominator == 1 for x in coefficients)
        need(integral, f"numbers: the polynomial of {name} has whole coefficients c0, c1, …")
        fits = 1 < len(coefficients) <= MOST_DEGREE + 1 and coefficients[-1] != 0
        problem = f"a degree of 1 to {MOST_DEGREE}, and its last coefficient is not 0"
        need(fits, f"numbers: the polynomial of {name} has {problem}")
        low, high = _read_limited(entry[2], name), _read_limited(entry[3], name)
        numbers[name] = AlgebraicNumber(name, tuple(map(int, coefficients)), low, high)
        check_root(numbers[name])
    return tuple(numbers.values())


def _read_limited(data: object, name: str) -> Fraction:
    long = isinstance(data, str) and len(data) > 2 * _MOST_DIGITS
    need(not long, f"numbers: one of {name} has more than {_MOST_DIGITS} digits")
    return number_of(data, f"numbers: {name}")


def check_root(number: AlgebraicNumber) -> None:
    """Raise ValueError unless the polynomial has one root in the interval, and none at an end."""
    name, low, high = number.name, number.low, number.high
    need(low < high, f"numbers: {name} is in no interval, {number.ends}")
    first, last = (_value(number.polynomial, x) for x in (low, high))
    problem = f"the polynomial of {name} has no two signs at the ends of {number.ends}"
    need(first * last < 0, f"numbers: {problem}")
    slope = [k * c for k, c in enumerate(number.polynomial)][1:]
    # If all coefficients have one sign, f has this sign for all x > 0, that is, in the interval.
    signs = {c > 0 for c in _between(slope, low, high) if c}
    problem = f"the polynomial of {name} is not seen to have one root alone in {number.ends}"
    need(len(signs) == 1, f"numbers: {problem}")


def _value(polynomial: Sequence[int], x: Fraction) -> Fraction:
    total = Fraction(0)
    for c in reversed(polynomial):
        total = total * x + c
    return total


def _between(polynomial: Sequence[int], low: Fraction, high: Fraction) -> list[int]:
    """Return the coefficients of (d + d·x)ⁿ f((low + high·x)/(1 + x)), d the lcm below."""
    d = lcm(low.denominator, high.denominator)
    a, b = int(low * d), int(high * d)
    total, unit = [polynomial[-1]], [1]
    for c in reversed(polynomial[:-1]):
        total, unit = _times(total, a, b), _times(unit, d, d)
        total = [x + c * y for x, y in zip(total, unit, strict=True)]
    return total


def _times(polynomial: Sequence[int], u: int, v: int) -> list[int]:
    """Multiply the polynomial by u + v·x."""
    pairs = zip([*polynomial, 0], [0, *polynomial], strict=True)
    return [u * x + v * y for x, y in pairs]


class QuotientRing:
    """Arithmetic of polynomials in the numbers, reduced by the numbers' polynomials."""

    def __init__(self, numbers: Sequence[AlgebraicNumber]) -> None:
        self.numbers = numbers
        self.work = 0

    def reduce(self, x: Poly) -> Poly:
        """Reduce x by multiples of the numbers' polynomials."""
        for number in self.numbers:
            x = self._lower_powers(x, number)
        return x

    def product(self, x: Poly, y: Poly) -> Poly:
        """Return x·y, reduced."""
        terms = ((m + n, c * d) for m, c in x.items() for n, d in y.items())
        return self.reduce(self._collect(terms))

    def sum(self, *parts: tuple[int, Poly]) -> Poly:
        """Return Σ sign·x over the parts."""
        return self._collect((m, sign * c) for sign, x in parts for m, c in x.items())

    def _lower_powers(self, x: Poly, number: AlgebraicNumber) -> Poly:
        *tail, first = number.polynomial
        shares = [Fraction(-c, first) for c in tail]
        powers: dict[int, Poly] = {}
        for names, c in x.items():
            key = tuple(name for name in names if name != number.name)
            powers.setdefault(len(names) - len(key), {})[key] = c
        # wⁿ = −(c₀ + … + c_(d−1) w^(d−1)) w^(n−d)/c_d, from the highest power down.
        for n in range(max(powers, default=0), len(tail) - 1, -1):
            top = powers.pop(n, {})
            for k, share in enumerate(shares, start=n - len(tail)):
                target = powers.setdefault(k, {}) if share else {}
                for key, c in top.items() if share else ():
                    target[key] = self._count_work(target.get(key, Fraction(0)) + c * share)
        return self._collect(
            (key + (number.name,) * n, c) for n, part in powers.items() for key, c in part.items()
        )

    def _collect(self, terms: Iterable[tuple[Monomial, Fraction]]) -> Poly:
        total: Poly = {}
        for names, c in terms:
            key = tuple(sorted(names))
            self.work += len(names) // 8
            total[key] = self._count_work(total.get(key, Fraction(0)) + c)
        return {names: c for names, c in total.items() if c}

    def _count_work(self, c: Fraction) -> Fraction:
        bits = bits_of(c)
        self.work += 1 + bits // 64
        need(bits <= _MOST_BITS and self.work <= _MOST_WORK, "is too large to be checked here")
        return c
