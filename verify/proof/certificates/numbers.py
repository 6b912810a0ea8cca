"""Algebraic numbers of a certificate: each a name for one root of a polynomial, and shown to be.

`numbers` is a list of [name, polynomial, low, high]. The polynomial is its coefficients c₀, c₁, …,
whole numbers; at the ends of the interval it has values of two signs, and so a root between them.
Its derivative has one sign between them, and so there is no second one: of the polynomial
(1 + x)ⁿ f((low + high·x)/(1 + x)) of the derivative f all coefficients have one sign (or are 0),
and between the ends x > 0.

What is 0 by the polynomials is 0 of the numbers: `Residues` takes multiples of them away.
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
_MOST_DIGITS = 200  # of a coefficient, and of an end, above or below
_MOST_BITS = 1 << 14  # of a coefficient that reducing makes
_MOST_WORK = 100_000  # terms that are made, more for long ones: some seconds
# p1, q2, P1, … are a scheme's points, where its formulas are printed, and H, T, V functions.
_NAME = re.compile(r"(?![pq][0-9]*$)[a-z][a-z0-9_]{0,31}")


@dataclass(frozen=True)
class Number:
    """The one root of a polynomial, which is given by c₀, c₁, …, between `low` and `high`."""

    name: str
    polynomial: tuple[int, ...]
    low: Fraction
    high: Fraction

    @property
    def ends(self) -> str:
        """The interval."""
        return f"[{self.low}, {self.high}]"


def read_numbers(data: object) -> tuple[Number, ...]:
    """The numbers, each of a new name; ValueError unless each of them is one root."""
    given = array_of(data, "numbers")
    need(len(given) <= MOST_NUMBERS, f"numbers: there are more than {MOST_NUMBERS}")
    found: dict[str, Number] = {}
    for each in given:
        four = array_of(each, "numbers")
        need(len(four) == 4, "numbers: each is a name, a polynomial and the ends of an interval")
        name, said = text_of(four[0], "numbers"), f"numbers: {short(four[0])} is no new name"
        new = _NAME.fullmatch(name) and not iskeyword(name) and name not in {*RESERVED, *found}
        need(new, said)
        coefficients = [_limited(x, name) for x in array_of(four[1], f"numbers: {name}")]
        whole = all(x.denominator == 1 for x in coefficients)
        need(whole, f"numbers: the polynomial of {name} has whole coefficients c0, c1, …")
        fits = 1 < len(coefficients) <= MOST_DEGREE + 1 and coefficients[-1] != 0
        said = f"a degree of 1 to {MOST_DEGREE}, and its last coefficient is not 0"
        need(fits, f"numbers: the polynomial of {name} has {said}")
        low, high = _limited(four[2], name), _limited(four[3], name)
        found[name] = Number(name, tuple(map(int, coefficients)), low, high)
        check_root(found[name])
    return tuple(found.values())


def _limited(data: object, name: str) -> Fraction:
    long = isinstance(data, str) and len(data) > 2 * _MOST_DIGITS
    need(not long, f"numbers: one of {name} has more than {_MOST_DIGITS} digits")
    return number_of(data, f"numbers: {name}")


def check_root(number: Number) -> None:
    """ValueError unless the polynomial has one root in the interval, and is 0 at no end."""
    name, low, high = number.name, number.low, number.high
    need(low < high, f"numbers: {name} is in no interval, {number.ends}")
    first, last = (_value(number.polynomial, x) for x in (low, high))
    said = f"the polynomial of {name} has no two signs at the ends of {number.ends}"
    need(first * last < 0, f"numbers: {said}")
    slope = [k * c for k, c in enumerate(number.polynomial)][1:]
    signs = {c > 0 for c in _between(slope, low, high) if c}
    said = f"the polynomial of {name} is not seen to have one root alone in {number.ends}"
    need(len(signs) == 1, f"numbers: {said}")


def _value(polynomial: Sequence[int], x: Fraction) -> Fraction:
    total = Fraction(0)
    for c in reversed(polynomial):
        total = total * x + c
    return total


def _between(polynomial: Sequence[int], low: Fraction, high: Fraction) -> list[int]:
    """The coefficients of dⁿ (1 + x)ⁿ f((low + high·x)/(1 + x)), d the ends' denominator."""
    d = lcm(low.denominator, high.denominator)
    a, b = int(low * d), int(high * d)
    total, unit = [polynomial[-1]], [1]
    for c in reversed(polynomial[:-1]):
        total, unit = _times(total, a, b), _times(unit, d, d)
        total = [x + c * y for x, y in zip(total, unit, strict=True)]
    return total


def _times(polynomial: Sequence[int], u: int, v: int) -> list[int]:
    """The polynomial by u + v·x."""
    pairs = zip([*polynomial, 0], [0, *polynomial], strict=True)
    return [u * x + v * y for x, y in pairs]


class Residues:
    """Polynomials in the numbers, with no power of one that its own polynomial makes lower."""

    def __init__(self, numbers: Sequence[Number]) -> None:
        self.numbers = numbers
        self.work = 0

    def reduced(self, x: Poly) -> Poly:
        """x less multiples of the numbers' polynomials."""
        for number in self.numbers:
            x = self._lowered(x, number)
        return x

    def product(self, x: Poly, y: Poly) -> Poly:
        """x·y, reduced."""
        terms = ((m + n, c * d) for m, c in x.items() for n, d in y.items())
        return self.reduced(self._collected(terms))

    def sum(self, *parts: tuple[int, Poly]) -> Poly:
        """Σ sign·x."""
        return self._collected((m, sign * c) for sign, x in parts for m, c in x.items())

    def _lowered(self, x: Poly, number: Number) -> Poly:
        *tail, first = number.polynomial
        shares = [Fraction(-c, first) for c in tail]
        powers: dict[int, Poly] = {}
        for names, c in x.items():
            rest = tuple(name for name in names if name != number.name)
            powers.setdefault(len(names) - len(rest), {})[rest] = c
        for n in range(max(powers, default=0), len(tail) - 1, -1):
            top = powers.pop(n, {})
            for k, share in enumerate(shares, start=n - len(tail)):
                at = powers.setdefault(k, {}) if share else {}
                for rest, c in top.items() if share else ():
                    at[rest] = self._counted(at.get(rest, Fraction(0)) + c * share)
        return self._collected(
            (rest + (number.name,) * n, c) for n, part in powers.items() for rest, c in part.items()
        )

    def _collected(self, terms: Iterable[tuple[Monomial, Fraction]]) -> Poly:
        total: Poly = {}
        for names, c in terms:
            key = tuple(sorted(names))
            self.work += len(names) // 8
            total[key] = self._counted(total.get(key, Fraction(0)) + c)
        return {names: c for names, c in total.items() if c}

    def _counted(self, c: Fraction) -> Fraction:
        bits = bits_of(c)
        self.work += 1 + bits // 64
        need(bits <= _MOST_BITS and self.work <= _MOST_WORK, "is too large to be checked here")
        return c
