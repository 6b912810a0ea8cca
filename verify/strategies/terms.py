"""Building blocks of drawn formulas: choices that always succeed, sums that never cancel.

Everything is made from bounded integers and a few choices, and no draw is rejected: so a draw takes
few bytes, and shrinks as its integers do.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from typing import TypeVar

from hypothesis import strategies as st

T = TypeVar("T")
_MOST_INNER = 3  # the greatest k in sin(k*q)
_HALF = Fraction(1, 2)
_BRACES = re.compile(r"\{(.)\}")


# hypothesis builds the strategy of a range anew at each call; there are few ranges to keep.
_range = lru_cache(maxsize=256)(st.integers)


def quotient(index: int, size: int) -> Fraction:
    """Return n/d with n, d = 1 … size for an index below size²; the first is 1."""
    # Index 0 is 1/1, the value to which hypothesis shrinks; whole numbers come before quotients.
    denominator, numerator = divmod(index, size)
    return Fraction(numerator + 1, denominator + 1)


def signed_quotient(index: int, size: int) -> Fraction:
    """Return ±n/d with n, d = 1 … size for an index below 2·size², signs by turns.

    >>> [str(signed_quotient(index, 2)) for index in range(8)]
    ['1', '-1', '2', '-2', '1/2', '-1/2', '1', '-1']
    """
    positive = quotient(index // 2, size)
    return -positive if index % 2 else positive


@dataclass(frozen=True)
class Limits:
    """`degree` of the polynomial part, number of `terms`, `size` of numerators, denominators."""

    degree: int = 6
    terms: int = 4
    size: int = 9


@dataclass
class Drawer:
    """The draws of a formula's parts; each choice shrinks towards its first option.

    For hypothesis the simplest example has the fewest choices, and only then the least ones: so
    `pad` gives a short formula as many choices as any simple one has.
    """

    draw: st.DrawFn
    limits: Limits
    choices: int = 0

    def whole(self, least: int, most: int) -> int:
        """Draw a whole number, of which the simplest is `least`; one option takes no choice."""
        if least == most:
            return least
        self.choices += 1
        return self.draw(_range(least, most))

    def pad(self, choices: int) -> None:
        """Make choices without a meaning until there were so many."""
        while self.choices < choices:
            self.whole(0, 1)

    def pick(self, choices: Sequence[T]) -> T:
        """Draw one of them; the simplest is the first."""
        return choices[self.whole(0, len(choices) - 1)]

    def positive(self) -> Fraction:
        """Draw n/d with n, d = 1 … size; the simplest is 1."""
        size = self.limits.size
        return quotient(self.whole(0, size**2 - 1), size)

    def leading(self) -> Fraction:
        """Draw n/d as `positive`, where the simplest is 1/2: H shrinks towards p²/2 + q²/2."""
        value = self.positive()
        if self.limits.size > 1 and value in (1, _HALF):
            # 3/2 − x exchanges 1 and 1/2: index 0 becomes 1/2, and each value still occurs once.
            return Fraction(3, 2) - value
        return value

    def nonzero(self) -> Fraction:
        """Draw n/d with n, d = 1 … size and either sign; the simplest is 1."""
        size = self.limits.size
        return signed_quotient(self.whole(0, 2 * size**2 - 1), size)

    def inner(self) -> int:
        """Draw the k of sin(k*q)."""
        return self.whole(1, _MOST_INNER)

    def fill_braces(self, text: str) -> str:
        """Draw the numbers in braces: for {3} a factor up to 3, for {/} a divisor; omit a 1."""
        return _BRACES.sub(lambda braces: self._number(braces[1]), text)

    def _number(self, most: str) -> str:
        number = self.whole(1, self.limits.size if most == "/" else int(most))
        if number == 1:
            return ""
        return f"/{number}" if most == "/" else f"{number}*"

    def even(self) -> int:
        """Draw an even power up to `degree`."""
        return 2 * self.whole(1, self.limits.degree // 2)


@dataclass
class Sum:
    """Terms by their numerator and denominator; a second one alike is left out.

    So no two terms cancel, and H is of the kind and shape of its construction.
    """

    terms: dict[tuple[str, str], Fraction] = field(default_factory=dict)

    def add(self, coefficient: Fraction, numerator: str, denominator: str = "") -> None:
        """Add a term, unless one of the same text is present."""
        self.terms.setdefault((numerator, denominator), coefficient)

    def __len__(self) -> int:
        return len(self.terms)

    def to_text(self, names: dict[int, str]) -> str:
        """Return the formula; `names`: parameters in place of coefficients, by the term's index."""
        text = ""
        for index, ((numerator, denominator), value) in enumerate(self.terms.items()):
            minus, factor, over = value < 0, str(abs(value.numerator)), str(value.denominator)
            if index in names:
                minus, factor, over = False, names[index], "1"
            top = "*".join(x for x in (factor, numerator) if x not in ("", "1")) or "1"
            below = (f"({denominator})" if denominator else "", "" if over == "1" else over)
            sign = (" - " if minus else " + ") if text else ("-" if minus else "")
            text += sign + "/".join(filter(None, (top, *below)))
        return text


def power(name: str, exponent: int) -> str:
    """Return name^exponent, as formulas write it."""
    return name if exponent == 1 else f"{name}**{exponent}"


def monomial(i: int, j: int) -> str:
    """Return p^i q^j, where i and j are not both 0."""
    return "*".join(power(name, n) for name, n in (("p", i), ("q", j)) if n)


def times(factor: int, name: str) -> str:
    """Return factor·name, as formulas write it."""
    return {1: name, -1: f"-{name}"}.get(factor, f"{factor}*{name}")


def combination(k: int, m: int) -> str:
    """Return k·p + m·q, neither factor 0.

    >>> combination(1, -2)
    'p - 2*q'
    """
    return f"{times(k, 'p')} {'-' if m < 0 else '+'} {times(abs(m), 'q')}"
