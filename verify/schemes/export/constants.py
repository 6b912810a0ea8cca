"""Numbers of a formula as correctly rounded double literals.

Integers below 2^53 stay as they are. A rational number n/d is divided by Python, which rounds
correctly; an irrational one is enclosed by ball arithmetic, with more and more bits until both ends
of the ball have the same nearest double. Any language reads `repr` of a double as that double.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction

import sympy

from verify.algebra.embedding import embed
from verify.algebra.enclosure import enclose
from verify.algebra.expressions.formula_text import to_text
from verify.arithmetic.arb import bounds
from verify.arithmetic.exact import decimal
from verify.errors import LimitError

_SMALL_INTEGER_LIMIT = 2**53
_PRECISIONS = (128, 256, 512, 1024)
_ENCLOSURE_DIGITS = 20


@dataclass(frozen=True)
class Constant:
    """A number: its name in the code, its exact formula, and the nearest double as a literal.

    `enclosure`: decimals below and above an irrational number; empty for a rational one.
    `exactly`: True if the double is equal to the number.
    """

    name: str
    exact: str
    literal: str
    enclosure: tuple[str, str] | tuple[()] = ()
    exactly: bool = False

    @property
    def comment(self) -> str:
        """A description of the literal, for a comment beside it, in ASCII."""
        if self.enclosure:
            return f"{self.exact} in [{', '.join(self.enclosure)}], rounded to nearest"
        return f"{self.exact}, {'exactly' if self.exactly else 'rounded to nearest'}"


class Constants:
    """The numbers extracted from expressions, each once; `name_for(k)` is the k-th name."""

    def __init__(self, name_for: Callable[[int], str]) -> None:
        self._name_for = name_for
        self._constants: dict[sympy.Expr, Constant] = {}

    def __iter__(self) -> Iterator[Constant]:
        return iter(self._constants.values())

    def extract(self, x: sympy.Expr) -> sympy.Expr:
        """Return x with a symbol for each number but small integers and rational exponents."""
        if x.is_number and not x.free_symbols:
            return x if _is_small(x) else self._symbol(x)
        if x.is_Pow:
            return sympy.Pow(self.extract(x.base), self._exponent(x.exp), evaluate=False)
        if not x.args:
            return x
        if x.is_Add or x.is_Mul:
            numbers = [a for a in x.args if a.is_number]
            others = [self.extract(a) for a in x.args if not a.is_number]
            number = x.func(*numbers)
            return x.func(self.extract(number), *others) if numbers else x.func(*others)
        return x.func(*map(self.extract, x.args))

    def _exponent(self, x: sympy.Expr) -> sympy.Expr:
        return x if x.is_Rational else self.extract(x)

    def _symbol(self, number: sympy.Expr) -> sympy.Symbol:
        # x and −x share one constant: the sign stands before its name.
        if number.could_extract_minus_sign():
            return -self._symbol(-number)
        if number not in self._constants:
            self._constants[number] = constant(self._name_for(len(self._constants)), number)
        return sympy.Symbol(self._constants[number].name, real=True)


def _is_small(x: sympy.Expr) -> bool:
    return bool(x.is_Integer and abs(int(x)) < _SMALL_INTEGER_LIMIT)


def constant(name: str, number: sympy.Expr) -> Constant:
    """Return the number under that name; LimitError if no double is shown to be the nearest."""
    exact = to_text(number)
    if number.is_Rational:
        value = Fraction(int(number.p), int(number.q))
        literal = _nearest(value, exact)
        return Constant(name, exact, literal, exactly=Fraction(float(literal)) == value)
    ring, (x,) = embed([number], ())
    for precision in _PRECISIONS:
        ball = enclose(ring, x, {}, precision)
        if ball is None:
            continue
        low, high = bounds(ball)
        # Rounding is monotonic: if both ends have the same nearest double, it is the number's.
        if low and high and _nearest(low, exact) == _nearest(high, exact):
            return Constant(name, exact, _nearest(low, exact), _outward(low, high))
    raise LimitError("constant", exact, "is not enclosed closely enough to be rounded to a double")


def _nearest(value: Fraction, exact: str) -> str:
    try:
        quotient = value.numerator / value.denominator  # Python rounds the quotient correctly
    except OverflowError:
        quotient = 0.0
    if value and (not quotient or abs(quotient) < 2.0**-1022):
        raise LimitError("constant", exact, "lies outside of the range of float64")
    return repr(quotient)


def _outward(low: Fraction, high: Fraction) -> tuple[str, str]:
    """Return decimals of 20 digits below `low` and above `high`, by a unit of the last digit."""
    ends = []
    for value, sign in ((low, -1), (high, 1)):
        middle = Fraction(decimal(value, _ENCLOSURE_DIGITS))
        unit = abs(middle) / 10 ** (_ENCLOSURE_DIGITS - 1)
        ends.append(decimal(middle + sign * unit, _ENCLOSURE_DIGITS))
    return ends[0], ends[1]
