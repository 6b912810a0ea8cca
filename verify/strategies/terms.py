"""Terms of drawn formulas: choices that always succeed, sums that never cancel.

Everything is made from bounded integers and a few choices, and no draw is rejected: so a draw takes
few bytes, and shrinks as its integers do.

A term that makes a formula trigonometric, exponential or rational is drawn as its numerator, its
denominator, and whether its coefficient has to be positive. If H is to be `confining` (H → ∞ in
every direction), it is bounded; or at most linear in one variable and bounded in the other, so that
even powers of both outgrow it; or ≥ 0. If H is to be `open` along the half-axis x → s·∞, y = 0, it
stays bounded above there. If H is `free`, any term will do.
"""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from typing import Literal, TypeVar

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
class FormulaLimits:
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
    limits: FormulaLimits
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
class TermSum:
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


def draw_quadratic(d: Drawer, shape: str, separable: bool) -> TermSum:
    """Draw a quadratic form whose 4ac − b² has the sign of its name, and perhaps a linear term.

    `shape`: "elliptic", "hyperbolic" or "parabolic".
    """
    total, a, c = TermSum(), d.leading(), d.leading()
    match shape, separable:
        case "elliptic", _:
            total.add(a, "p**2")
            total.add(c, "q**2")
            if not separable:
                total.add(draw_definite(d, a, c), "p*q")
        case "hyperbolic", True:
            first, second = d.pick((("p", "q"), ("q", "p")))
            total.add(a, f"{first}**2")
            total.add(-c, f"{second}**2")
        case "hyperbolic", False:  # b pq, or a p² + b pq, whose discriminant is −b²
            if d.limits.terms > 1 and d.whole(0, 1):
                total.add(a, f"{d.pick(('p', 'q'))}**2")
            total.add(d.nonzero(), "p*q")
        case _, True:
            total.add(a, f"{d.pick(('p', 'q'))}**2")
        case _:
            k = d.whole(1, 3) * d.pick((1, -1))
            # The square of a linear form has b² = 4ac.
            total.add(a, f"({combination(1, k)})**2")
    if len(total) < d.limits.terms and d.whole(0, 3) == 3:
        total.add(d.nonzero(), d.pick(("q", "p")))
    return total


def draw_definite(d: Drawer, a: Fraction, c: Fraction) -> Fraction:
    """Draw b with b² < 4ac: ± the smaller of a and c, as min(a, c)² ≤ ac."""
    return min(a, c) * d.pick((1, -1))


# -- terms that make a formula trigonometric, exponential or rational ------------------------------

Shape = Literal["confining", "open", "free"]
# Numerator, denominator, whether the coefficient has to be positive.
TermShape = tuple[str, str, bool]


@dataclass(frozen=True)
class TermRequest:
    """The requested term: of both variables if `mixed`; an open H is so along x → direction·∞."""

    shape: Shape
    mixed: bool
    x: str = "q"
    y: str = "p"
    direction: int = 1


def draw_trigonometric(d: Drawer, request: TermRequest) -> TermShape:
    """Draw sin or cos of a multiple of q, p or both."""
    function = d.pick(("cos", "sin"))
    if not request.mixed:
        return f"{function}({times(d.inner(), d.pick((request.x, request.y)))})", "", False
    if d.whole(0, 3) == 3:  # it vanishes on both axes
        outer, inner = d.pick((("p", "q"), ("q", "p")))
        return f"{outer}*sin({times(d.inner(), inner)})", "", False
    return f"{function}({combination(d.inner(), _draw_factor(d))})", "", False


def draw_exponential(d: Drawer, request: TermRequest) -> TermShape:
    """Draw exp, cosh or sinh of a multiple, or a bump exp(−x²)."""
    bump = d.whole(0, 3) == 3
    if request.mixed:
        if bump:
            return "exp(-p**2 - q**2)", "", False
        return _draw_mixed_exponential(d, request)
    name = d.pick((request.x, request.y))
    if bump:
        return f"exp(-{name}**2)", "", False
    if request.shape == "open" and name == request.x:  # exp(−direction·k·x) → 0 along the half-axis
        return f"exp({times(-request.direction * d.inner(), name)})", "", False
    functions = ("exp", "cosh") if request.shape == "confining" else ("exp", "cosh", "sinh")
    function = d.pick(functions)
    k = _draw_factor(d) if function == "exp" else d.inner()
    return f"{function}({times(k, name)})", "", request.shape == "confining"


def _draw_mixed_exponential(d: Drawer, request: TermRequest) -> TermShape:
    if request.shape == "open":  # on y = 0 the exponent is −direction·k·x, which falls
        along, across = -request.direction * d.inner(), _draw_factor(d)
        k, m = (along, across) if request.x == "p" else (across, along)
        return f"exp({combination(k, m)})", "", False
    function = d.pick(("exp", "cosh"))
    return (
        f"{function}({combination(d.inner(), _draw_factor(d))})",
        "",
        request.shape == "confining",
    )


def draw_rational(d: Drawer, request: TermRequest) -> TermShape:
    """Draw a quotient over c + x² or the like with c ≥ 1, so that no denominator vanishes."""
    constant = d.whole(1, min(d.limits.size, 9))
    if not request.mixed:
        name = d.pick((request.x, request.y))
        return d.pick(("", name)), f"{constant} + {name}**2", False
    match d.whole(0, 2):
        case 0:
            return "p*q", f"{constant} + p**2 + q**2", False
        case 1:
            return "", f"{constant} + ({combination(1, _draw_factor(d))})**2", False
    # y, which vanishes on the axis where H is open, has to stand above.
    x, y = (request.x, request.y) if request.shape == "open" else d.pick((("q", "p"), ("p", "q")))
    exponent = d.whole(1, 2)
    positive = exponent == 2 and request.shape == "confining"
    return power(y, exponent), f"{constant} + {x}**2", positive


def _draw_factor(d: Drawer) -> int:
    """Draw ±1, ±2 or ±3; the simplest is 1."""
    index = d.whole(0, 5)
    return -(index // 2 + 1) if index % 2 else index // 2 + 1


TERMS_BY_KIND: dict[str, Callable[[Drawer, TermRequest], TermShape]] = {
    "trigonometric": draw_trigonometric,
    "exponential": draw_exponential,
    "rational": draw_rational,
}
KINDS = ("polynomial", *TERMS_BY_KIND)
