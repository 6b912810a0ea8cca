"""What formulas are drawn with: choices that always succeed, and sums of terms that never cancel.

Everything is made from bounded integers and a few choices, and nothing is drawn and thrown away:
so a draw takes few bytes, and shrinks by what its integers shrink to.
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


# hypothesis makes a strategy of a range anew each time; there are few ranges.
_range = lru_cache(maxsize=256)(st.integers)


def quotient(index: int, size: int) -> Fraction:
    """n/d with n, d = 1 … size, of which the index is one of size²; the first is 1."""
    denominator, numerator = divmod(index, size)
    return Fraction(numerator + 1, denominator + 1)


def signed_quotient(index: int, size: int) -> Fraction:
    """The same with both signs by turns, of which there are 2·size²; the first is 1.

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
    """Draws the parts of a formula; each choice shrinks towards the first that is named.

    For hypothesis the simplest example is one of the fewest choices, and only then that of the
    least: so `pad` makes the choices of a short formula as many as those of any simple one.
    """

    draw: st.DrawFn
    limits: Limits
    choices: int = 0

    def whole(self, least: int, most: int) -> int:
        """A whole number; the simplest is the least. No choice is made of one."""
        if least == most:
            return least
        self.choices += 1
        return self.draw(_range(least, most))

    def pad(self, choices: int) -> None:
        """Makes choices of no meaning until there were so many."""
        while self.choices < choices:
            self.whole(0, 1)

    def pick(self, choices: Sequence[T]) -> T:
        """One of them; the simplest is the first."""
        return choices[self.whole(0, len(choices) - 1)]

    def positive(self) -> Fraction:
        """n/d with n, d = 1 … size; the simplest is 1."""
        size = self.limits.size
        return quotient(self.whole(0, size**2 - 1), size)

    def leading(self) -> Fraction:
        """The same, where the simplest is 1/2: H shrinks towards p²/2 + q²/2."""
        drawn = self.positive()
        if self.limits.size > 1 and drawn in (1, _HALF):
            return Fraction(3, 2) - drawn
        return drawn

    def signed(self) -> Fraction:
        """n/d with n, d = 1 … size and either sign; the simplest is 1."""
        size = self.limits.size
        return signed_quotient(self.whole(0, 2 * size**2 - 1), size)

    def inner(self) -> int:
        """The k of sin(k*q)."""
        return self.whole(1, _MOST_INNER)

    def filled(self, text: str) -> str:
        """The text with numbers drawn for what stands in braces: for {3} nothing or a factor up to
        3, for {/} nothing or a divisor."""
        return _BRACES.sub(lambda braces: self._number(braces[1]), text)

    def _number(self, most: str) -> str:
        number = self.whole(1, self.limits.size if most == "/" else int(most))
        if number == 1:
            return ""
        return f"/{number}" if most == "/" else f"{number}*"

    def even(self) -> int:
        """An even power up to `degree`."""
        return 2 * self.whole(1, self.limits.degree // 2)


@dataclass
class Sum:
    """Terms by what stands in their numerator and denominator; a second one alike is left out."""

    terms: dict[tuple[str, str], Fraction] = field(default_factory=dict)

    def add(self, coefficient: Fraction, numerator: str, denominator: str = "") -> None:
        """Adds a term, unless one of the same text is there."""
        self.terms.setdefault((numerator, denominator), coefficient)

    def __len__(self) -> int:
        return len(self.terms)

    def written(self, names: dict[int, str]) -> str:
        """The formula; `names`: what stands for the coefficient of which term."""
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
    """name^exponent, as formulas write it."""
    return name if exponent == 1 else f"{name}**{exponent}"


def monomial(i: int, j: int) -> str:
    """p^i q^j, one of i and j not 0."""
    return "*".join(power(name, n) for name, n in (("p", i), ("q", j)) if n)


def times(factor: int, name: str) -> str:
    """factor·name, as formulas write it."""
    return {1: name, -1: f"-{name}"}.get(factor, f"{factor}*{name}")


def combination(k: int, m: int) -> str:
    """k·p + m·q, neither of them 0.

    >>> combination(1, -2)
    'p - 2*q'
    """
    return f"{times(k, 'p')} {'-' if m < 0 else '+'} {times(abs(m), 'q')}"
