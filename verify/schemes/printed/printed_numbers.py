"""Numbers as they are printed: which of them are rounded, to which digit, and which are exact.

A decimal that stands for an algebraic number is rounded; 0.5 is not. A short decimal does not show
which it is, so that there are two readings. In the first, numbers with few digits are exact, either
absolutely or beside longer ones: 0.037109375 among numbers of 17 digits has lost zeros at its end,
or is 19/512. In the last reading they are rounded. Quotients are exact, but some stand for
irrational numbers, as 2365592473904/8146167614645 does: if a table does not hold with them, they
are taken to be accurate to 100/q², q the denominator. (A continued fraction has 1/q²; some are
worse.)
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

FIRST, LAST = 7, 3  # most places of an exact decimal, in the first and in the last reading
_FEWEST_ROUNDED_PLACES = 2  # the same in the strictest reading, in which 0.333 is rounded
LARGEST = 10**6
_QUOTIENT_SLACK = 1000  # units within which a long quotient counts as right
_LEAST_DENOMINATOR = 10**6  # a quotient with this denominator may stand for another number
_QUOTIENT = re.compile(r"[+-]?\d{6,}/(\d{7,40})", re.ASCII)
_DECIMAL = re.compile(r"[+-]?(\d*)\.(\d*)(?:[eE]([+-]?\d{1,3}))?", re.ASCII)
_MISSING_DIGITS = 5  # digits by which an exact number is shorter than the longest one
_DOUBLE_DIGITS = 16, 17  # the digits of a double that is printed to be read back unchanged


@dataclass(frozen=True)
class PrintedNumbers:
    """`numbers`: by name, decimals as printed, or exact formulas of numbers.

    - `exact_up_to`: the largest number of places of an exact decimal; 0 for no such limit.
    - `exact_digits`: the largest number of significant digits of an exact decimal.
    - `exact_quotients`: True if long quotients are exact.
    - `tentative`: True if a refutation needs no search for the right numbers.
    """

    numbers: Mapping[str, str]
    exact_up_to: int = 0
    exact_digits: int = 0
    exact_quotients: bool = True
    tentative: bool = False

    @cached_property
    def units(self) -> dict[str, Fraction]:
        """The precision of each rounded number: one unit of its last digit.

        For a double that a program has printed it is half an ulp if that is more.
        """
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
        """The exact values of the rounded numbers as they are printed."""
        numbers = {name: rational(self.numbers[name].replace(" ", ""), name) for name in self.units}
        for name, x in numbers.items():
            _check_size(x, name, self.numbers[name])
        return numbers

    @cached_property
    def last_digits(self) -> dict[str, Fraction]:
        """One unit of the last digit of each rounded number; for a quotient its precision."""
        return {name: unit_of(self.numbers[name]) or unit for name, unit in self.units.items()}

    @cached_property
    def digits(self) -> int:
        """The fewest decimal places of a rounded number."""
        return min(places_of(unit) for unit in self.last_digits.values())

    @cached_property
    def slack(self) -> int:
        """The number of units within which a number is right: 1, or 1000 with quotients."""
        quotients = (unit_of_quotient(self.numbers[name]) for name in self.units)
        return _QUOTIENT_SLACK if any(quotients) else 1

    @cached_property
    def _exact(self) -> dict[sympy.Symbol, sympy.Expr]:
        return {
            symbol(name): parse(text, (), source=name)
            for name, text in self.numbers.items()
            if name not in self.units
        }

    def entry(self, text: str, source: str = "sizes") -> sympy.Expr:
        """Return a formula in the numbers as an expression; rounded numbers stay symbols."""
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
        """Return an entry with the printed values of the rounded numbers."""
        values = self.values.items()
        substitutions = {symbol(n): sympy.Rational(x.numerator, x.denominator) for n, x in values}
        return entry.subs(substitutions)

    @property
    def closely(self) -> "PrintedNumbers":
        """The strictest reading, in which almost all decimals and quotients are rounded."""
        return replace(
            self,
            exact_up_to=_FEWEST_ROUNDED_PLACES,
            exact_digits=0,
            exact_quotients=False,
            tentative=True,
        )

    def with_number(self, name: str, text: str) -> "PrintedNumbers":
        """Return the numbers with another text for one of them, for a trial."""
        return replace(self, numbers={**self.numbers, name: text}, tentative=True)

    def of_a_method(self) -> list["PrintedNumbers"]:
        """Return the readings of the numbers of a single method, the preferred one first.

        Numbers with few digits are exact. In the second reading long quotients are rounded.
        """
        longest = max((_digits(x) for x in self.numbers.values() if unit_of(x)), default=0)
        first = replace(
            self,
            exact_up_to=FIRST,
            exact_digits=max(FIRST, longest - _MISSING_DIGITS),
            tentative=True,
        )
        last = replace(first, exact_up_to=0, exact_digits=FIRST, exact_quotients=False)
        return [first] if first.units == last.units else [first, last]

    def readings(self) -> list["PrintedNumbers"]:
        """Return the readings of a table's numbers; the first has more exact decimals."""
        longest = max((_digits(x) for x in self.numbers.values() if unit_of(x)), default=0)
        first = replace(self, exact_up_to=FIRST, exact_digits=longest - _MISSING_DIGITS)
        last = replace(self, exact_up_to=LAST, exact_quotients=False)
        return [first] if first.units == last.units else [replace(first, tentative=True), last]


def _check_size(x: Fraction, name: str, text: str) -> None:
    """Raise InputError for a number too large for a coefficient: its powers would fill memory."""
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
    """Return the decimal places of a number that is accurate to that unit.

    >>> places_of(Fraction(1, 1000)), places_of(Fraction(1, 800)), places_of(Fraction(1))
    (3, 2, 0)
    """
    places = 0
    while Fraction(1, 10 ** (places + 1)) >= unit:
        places += 1
    return places


def precision_unit(text: str) -> Fraction | None:
    """Return the unit to which a decimal is accurate; None if it is no decimal with a point.

    It is `unit_of`; but at least half an ulp for a double that a program has printed, such as
    0.054293734116568765.
    """
    unit = unit_of(text)
    if unit is None or _digits(text) not in _DOUBLE_DIGITS:
        return unit
    # A decimal that is the shortest text of a double is taken for a program's.
    x = float(text.replace(" ", ""))
    if rational(repr(x)) != rational(text.replace(" ", "")):
        return unit
    return max(unit, Fraction(math.ulp(x)) / 2)


def _digits(text: str) -> int:
    """Return the number of significant digits of a decimal."""
    mantissa = text.lower().replace(" ", "").lstrip("+-").partition("e")[0]
    return len(mantissa.replace(".", "").lstrip("0"))


def unit_of_quotient(text: str) -> Fraction | None:
    """Return the accuracy of a long quotient as another number; None for any other text."""
    match = _QUOTIENT.fullmatch(text.replace(" ", ""))
    return (
        Fraction(100, int(match[1]) ** 2) if match and int(match[1]) >= _LEAST_DENOMINATOR else None
    )


def rounded_to(x: Fraction, unit: Fraction) -> str:
    """Return a number as a decimal rounded to the place of that unit.

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
    """Return xⁿ, n ≥ 1, by products, as the power of a ball that contains 0 may be undefined."""
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
    """Return ((number, exponent), …) and the coefficient for each term of a polynomial."""
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
