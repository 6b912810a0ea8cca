"""Numbers as a page sets them: × 10ⁿ, minus signs, digits in groups.

A number keeps exactly the digits it comes with.
"""

import re
from collections.abc import Callable, Iterable
from decimal import Decimal, InvalidOperation
from fractions import Fraction

from markupsafe import Markup, escape

from verify.arithmetic.exact import text
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.growth import AverageResult
from verify.scenes.results.regions import EXACT_FLOW
from verify.scenes.results.run import RunResult
from verify.scenes.results.separation import Separation
from verify.scenes.results.work_precision import WorkPrecisionResult

NBSP = "\u00a0"
IS = f"{NBSP}={NBSP}"
_SUPERSCRIPT = str.maketrans("0123456789-+", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺")
_GROUP, _IN_A_LINE = 5, 3  # digits to a group, groups to a line
_UNGROUPED = 17  # digits at most of a number that is left in one piece
_ZEROS = 6  # at the end of a number, which nobody counts
_SMALL_STEP = Decimal("0.0001")
_MOST_DIGITS = 60  # of one number on the page; the others are in results.json

NUMBER = r"[0-9]+(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?"
_PLAIN_NUMBER = re.compile(rf"[+-]?{NUMBER}")


def superscript(n: int) -> str:
    return str(n).translate(_SUPERSCRIPT)


def number(text: str) -> str:
    """`-1.23e-05` → −1.23 × 10⁻⁵, with the digits that it has; other text as it is."""
    if not _PLAIN_NUMBER.fullmatch(text):
        return text
    mantissa, _, exponent = text.lower().partition("e")
    digits = mantissa.lstrip("+-")
    if len(digits) > _MOST_DIGITS:
        digits = digits[:_MOST_DIGITS] + "…"
    sign = "−" if mantissa.startswith("-") else ""
    power = int(exponent or 0)
    scale = f"{NBSP}×{NBSP}10{superscript(power)}" if power else ""
    return f"{sign}{digits}{scale}"


def exact(text: str) -> str:
    """A whole number with many zeros at its end as a product with a power of ten; else `number`.

    >>> exact("1000000000000"), exact("-2700000000")
    ('10¹²', '−27\\xa0×\\xa010⁸')
    """
    digits = text.lstrip("-")
    zeros = len(digits) - len(digits.rstrip("0"))
    if not digits.isdecimal() or zeros < _ZEROS:
        return number(text)
    mantissa = digits[:-zeros]
    sign = "−" if text.startswith("-") else ""
    scale = f"10{superscript(zeros)}"
    return f"{sign}{scale}" if mantissa == "1" else f"{sign}{mantissa}{NBSP}×{NBSP}{scale}"


def step(size: str) -> str:
    """A step size; a small one as a power of ten, whose zeros nobody needs to count."""
    if not _PLAIN_NUMBER.fullmatch(size) or Decimal(size) >= _SMALL_STEP:
        return size
    return number(f"{Decimal(size).normalize():e}").removeprefix(f"1{NBSP}×{NBSP}")


def whole(n: int) -> str:
    """A count with its thousands set apart."""
    return f"{n:,}"


def counted(n: int, one: str, many: str = "") -> str:
    """`1 run` or `1,200 runs`; `many`: the plural where it is not `one` with an s."""
    return f"1 {one}" if n == 1 else f"{whole(n)} {many or one + 's'}"


def every(n: int, one: str, many: str = "") -> str:
    """`the one run` or `all 1,200 runs`."""
    return f"the one {one}" if n == 1 else f"all {counted(n, one, many)}"


def between(low: str, high: str, to: str = " to ") -> str:
    """The two ends of a range; one of them where they are the same."""
    return low if low == high else f"{low}{to}{high}"


def power_of_h(n: int) -> str:
    return "h" if n == 1 else f"h{superscript(n)}"


def value(found: Value) -> Markup:
    """The known digits and, below them, the error bound; a bound alone where no digit is known."""
    if found.bound == "0":
        return grouped(found.value)
    if found.unknown:
        return Markup("|·|{0}≤{0}{1}").format(NBSP, number(found.bound))
    return Markup('{} <span class="bound">±{}{}</span>').format(
        grouped(found.value), NBSP, number(found.bound)
    )


def grouped(text: str) -> Markup:
    """A number with many digits in groups, three to a line; any other as it is.

    The gaps are the style sheet's: what is copied has none.
    """
    shown = number(text)
    digits, times, scale = shown.partition(NBSP)
    whole_part, point, decimals = digits.partition(".")
    if (
        not decimals
        or len((whole_part + decimals).lstrip("−")) <= _UNGROUPED
        or not _PLAIN_NUMBER.fullmatch(text)
    ):
        return escape(shown)
    groups = [decimals[i : i + _GROUP] for i in range(0, len(decimals), _GROUP)]
    groups[0] = whole_part + point + groups[0]
    groups[-1] += times + scale
    spans = [Markup("<span>{}</span>").format(group) for group in groups]
    rows = [Markup("").join(spans[i : i + _IN_A_LINE]) for i in range(0, len(spans), _IN_A_LINE)]
    return Markup('<span class="digits">{}</span>').format(Markup("<br>").join(rows))


def start(
    run: RunResult | Separation | AverageResult | WorkPrecisionResult,
) -> str:
    """A run's initial value, and when it starts, where that is not 0."""
    t0 = getattr(run, "t0", "0")
    at = {"q₀": run.q, "p₀": run.p} | ({} if t0 == "0" else {"t₀": t0})
    return ", ".join(f"{name}{IS}{coordinates(x)}" for name, x in at.items())


def coordinates(x: str | tuple[str, ...]) -> str:
    """A number; or those of n degrees of freedom, in brackets."""
    return number(x) if isinstance(x, str) else f"({', '.join(map(number, x))})"


def interval(t0: str, length: Fraction | str, shown: Callable[[str], str] = str) -> str:
    """[t₀, t₀ + length], each end as `shown` writes it.

    >>> interval("1/3", "2")
    '[1/3, 7/3]'
    """
    return f"[{shown(t0)}, {shown(text(Fraction(t0) + Fraction(length)))}]"


def map_name(name: str) -> str:
    """A scheme's name, or that of the exact flow, in a sentence."""
    return f"the {name}" if name == EXACT_FLOW else name


def listed(items: Iterable[str]) -> str:
    """a, b and c."""
    *most, last = items
    return f"{', '.join(most)} and {last}" if most else last


def is_number(text: str) -> bool:
    return bool(_PLAIN_NUMBER.fullmatch(text))


def is_decimal(text: str) -> bool:
    """Whether the text is a finite decimal."""
    try:
        return Decimal(text).is_finite()
    except InvalidOperation:
        return False
