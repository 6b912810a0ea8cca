"""Numbers as they are printed: which of them are rounded, to which digit, and which are exact.

A decimal that stands for an algebraic number is rounded; 0.5 is not. A short one does not show
which it is, so it is a matter of reading. First, numbers with few digits are exact, by themselves
or among others: 0.037109375 among numbers of 17 digits has lost zeros at its end, or is 19/512.
Then they are not. Quotients are exact, and yet some stand for irrational numbers, as
2365592473904/8146167614645 does: where a table does not hold with them they are taken to be known
to 100/q², q being the denominator: a continued fraction has 1/q², and some are less good.
"""

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, lru_cache

import sympy

from verify.algebra.formula import parse, symbol
from verify.arithmetic.exact import rational
from verify.arithmetic.number_system import E
from verify.effort import limit_effort
from verify.errors import InputError

FIRST, LAST = 7, 3  # places up to which a decimal is exact, as it is read first, and last
_SHORTEST = 2  # and where it is a question whether even such as 0.333 are rounded
LARGEST = 10**6
_OF_QUOTIENTS = 1000  # units
_LONG = 10**6  # what a quotient is divided by that may stand for another number
_QUOTIENT = re.compile(r"[+-]?\d{6,}/(\d{7,40})", re.ASCII)
_DECIMAL = re.compile(r"[+-]?(\d*)\.(\d*)(?:[eE]([+-]?\d{1,3}))?", re.ASCII)
_FEWER = 5  # digits than the longest number has
_OF_DOUBLES = 16, 17  # digits of a double that is printed so that it is read back


@dataclass(frozen=True)
class PrintedNumbers:
    """`numbers`: by name, decimals as printed, or exact formulas of numbers.

    `exact_up_to`: a decimal with so many places, or fewer, is exact; and so is one with so many
    digits as `exact_digits`, or fewer. `exact_quotients`: whether long quotients are. `tentative`:
    whether nobody asks which numbers would be right where these are refuted.
    """

    numbers: Mapping[str, str]
    exact_up_to: int = 0
    exact_digits: int = 0
    exact_quotients: bool = True
    tentative: bool = False

    @cached_property
    def units(self) -> dict[str, Fraction]:
        """The precision of each number that is rounded: one unit of its last digit, or half an ulp
        where that is more and a program has printed a double."""
        units_by_name = ((name, precision_unit(text)) for name, text in self.numbers.items())
        threshold = Fraction(1, 10**self.exact_up_to) if self.exact_up_to else None
        decimals = {
            name: unit
            for name, unit in units_by_name
            if unit is not None
            and (threshold is None or unit < threshold)
            and _digits(self.numbers[name]) > self.exact_digits
        }
        if self.exact_quotients:
            return decimals
        quotients = ((name, unit_of_quotient(text)) for name, text in self.numbers.items())
        return decimals | {name: unit for name, unit in quotients if unit is not None}

    @cached_property
    def values(self) -> dict[str, Fraction]:
        """The rounded numbers exactly as they are printed."""
        numbers = {name: rational(self.numbers[name].replace(" ", ""), name) for name in self.units}
        for name, x in numbers.items():
            _check_size(x, name, self.numbers[name])
        return numbers

    @cached_property
    def last_digits(self) -> dict[str, Fraction]:
        """One unit of the last digit of each of them; of a quotient its precision."""
        return {name: unit_of(self.numbers[name]) or unit for name, unit in self.units.items()}

    @cached_property
    def digits(self) -> int:
        """The number of decimals after the point of the number that has fewest."""
        return min(places_of(unit) for unit in self.last_digits.values())

    @cached_property
    def slack(self) -> int:
        """The number of units within which a number is right: many for quotients, which promise no
        digits."""
        quotients = (unit_of_quotient(self.numbers[name]) for name in self.units)
        return _OF_QUOTIENTS if any(quotients) else 1

    @cached_property
    def _exact(self) -> dict[sympy.Symbol, sympy.Expr]:
        return {
            symbol(name): parse(text, (), source=name)
            for name, text in self.numbers.items()
            if name not in self.units
        }

    def entry(self, text: str, source: str = "sizes") -> sympy.Expr:
        """Return a formula in the numbers, in the symbols of those that are rounded."""
        expression = parse(text, self.numbers, source=source)
        with limit_effort(source, text, "to expand it"):
            expression = (
                sympy.expand(expression.subs(self._exact))
                if expression.free_symbols
                else expression
            )
        if expression.is_Rational:
            _check_size(Fraction(int(expression.p), int(expression.q)), source, text)
        return expression

    def at_print(self, entry: sympy.Expr) -> sympy.Expr:
        """Return an entry with the rounded numbers as they are printed."""
        values = self.values.items()
        substitutions = {symbol(n): sympy.Rational(x.numerator, x.denominator) for n, x in values}
        return entry.subs(substitutions)

    @property
    def closely(self) -> "PrintedNumbers":
        """The same with almost all of them rounded: then they must be so to half a unit."""
        return replace(
            self, exact_up_to=_SHORTEST, exact_digits=0, exact_quotients=False, tentative=True
        )

    def with_number(self, name: str, text: str) -> "PrintedNumbers":
        """Return the same with one of them printed so, to see whether it holds."""
        return replace(self, numbers={**self.numbers, name: text}, tentative=True)

    def of_a_method(self) -> list["PrintedNumbers"]:
        """Return the readings for the numbers of a single method: those with few digits are exact,
        and long quotients are where the method holds so."""
        longest = max((_digits(x) for x in self.numbers.values() if unit_of(x)), default=0)
        first = replace(
            self, exact_up_to=FIRST, exact_digits=max(FIRST, longest - _FEWER), tentative=True
        )
        last = replace(first, exact_up_to=0, exact_digits=FIRST, exact_quotients=False)
        return [first] if first.units == last.units else [first, last]

    def readings(self) -> list["PrintedNumbers"]:
        """Return the same as they may be read: with more of the decimals exact first."""
        longest = max((_digits(x) for x in self.numbers.values() if unit_of(x)), default=0)
        first = replace(self, exact_up_to=FIRST, exact_digits=longest - _FEWER)
        last = replace(self, exact_up_to=LAST, exact_quotients=False)
        return [first] if first.units == last.units else [replace(first, tentative=True), last]


def _check_size(x: Fraction, name: str, text: str) -> None:
    """Raise InputError for a number that is beyond all coefficients, and would fill memory in
    powers."""
    if abs(x) > LARGEST:
        raise InputError(name, text, f"is beyond {LARGEST:,}, which no coefficient is")


def unit_of(text: str) -> Fraction | None:
    """Return one unit of the last digit of a decimal with a point; None for anything else.

    >>> unit_of("-1.250"), unit_of("3/4")
    (Fraction(1, 1000), None)
    """
    match = _DECIMAL.fullmatch(text.replace(" ", ""))
    if match is None or not match[1] + match[2]:
        return None
    return Fraction(10) ** (int(match[3] or 0) - len(match[2]))


def places_of(unit: Fraction) -> int:
    """Return the decimal places of a number that is known to that unit.

    >>> places_of(Fraction(1, 1000)), places_of(Fraction(1, 800)), places_of(Fraction(1))
    (3, 2, 0)
    """
    places = 0
    while Fraction(1, 10 ** (places + 1)) >= unit:
        places += 1
    return places


def precision_unit(text: str) -> Fraction | None:
    """Return `unit_of`; but for a decimal that a program has printed from a double, as
    0.054293734116568765, at least half an ulp, to which such digits are known."""
    unit = unit_of(text)
    if unit is None or _digits(text) not in _OF_DOUBLES:
        return unit
    # If the decimal is the shortest text of a double, a program has printed it.
    x = float(text.replace(" ", ""))
    if rational(repr(x)) != rational(text.replace(" ", "")):
        return unit
    return max(unit, Fraction(math.ulp(x)) / 2)


def _digits(text: str) -> int:
    """Return the number of significant digits of a decimal."""
    mantissa = text.lower().replace(" ", "").lstrip("+-").partition("e")[0]
    return len(mantissa.replace(".", "").lstrip("0"))


def unit_of_quotient(text: str) -> Fraction | None:
    """Return the precision of a long quotient that stands for another number; None for anything
    else."""
    match = _QUOTIENT.fullmatch(text.replace(" ", ""))
    return Fraction(100, int(match[1]) ** 2) if match and int(match[1]) >= _LONG else None


def rounded_to(x: Fraction, unit: Fraction) -> str:
    """Return a number to the place of that unit.

    >>> rounded_to(Fraction(-2, 3), Fraction(1, 1000))
    '−0.667'
    """
    places = max(places_of(unit), 0)
    whole = round(x * 10**places)
    digits = str(abs(whole)).rjust(places + 1, "0")
    cut = len(digits) - places
    return f"{'−' if whole < 0 else ''}{digits[:cut]}.{digits[cut:]}".rstrip(".")


# -- entries as polynomials in the numbers --------------------------------------------------------


def power(x: E, n: int) -> E:
    """Return xⁿ, n ≥ 1, by products: of a ball with 0 in it, powers may be undefined."""
    result = x
    for _ in range(n - 1):
        result = result * x
    return result


def evaluate(
    expression: sympy.Expr, values: Mapping[str, E], number: Callable[[sympy.Expr], E]
) -> E:
    """Return a polynomial in the numbers, at `values`; `number` converts its coefficients."""
    total: E | None = None
    for powers, coefficient in _terms(expression):
        term = number(coefficient)
        for name, n in powers:
            term = term * power(values[name], n)
        total = term if total is None else total + term
    return number(sympy.S.Zero) if total is None else total


@lru_cache(maxsize=4096)
def _terms(expression: sympy.Expr) -> tuple[tuple[tuple[tuple[str, int], ...], sympy.Expr], ...]:
    """Return ((number, exponent), …) and the coefficient, of each term."""
    if not expression.free_symbols:
        return (((), expression),)
    names = sorted(expression.free_symbols, key=lambda x: x.name)
    try:
        with limit_effort("entry", str(expression), "to expand it"):
            polynomial = sympy.Poly(expression, *names)
    except sympy.PolynomialError:
        problem = "is no polynomial in the numbers that are rounded; give it as one of `numbers`"
        raise InputError("entry", str(expression), problem) from None
    return tuple(
        (tuple((x.name, e) for x, e in zip(names, powers, strict=True) if e), coefficient)
        for powers, coefficient in polynomial.terms()
    )


def entries_at(
    entries: Sequence[sympy.Expr], values: Mapping[str, E], number: Callable[[sympy.Expr], E]
) -> list[E]:
    """Return the values of all entries."""
    return [evaluate(entry, values, number) for entry in entries]
