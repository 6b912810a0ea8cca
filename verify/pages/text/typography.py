"""Typesetting of numbers: × 10ⁿ, minus signs, digits in groups; and phrases with numbers.

A number keeps its digits, of which at most 60 are shown.
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
_DIGITS_IN_GROUP, _GROUPS_IN_LINE = 5, 3
# The limit on digits of a number that is left in one piece; those of float64 have 17.
_MAX_UNGROUPED = 17
# From this number of zeros on, those at the end of a number become a power of ten.
_MIN_ZEROS = 6
# Step sizes below this are written as powers of ten.
_SMALL_STEP = Decimal("0.0001")
# The limit on digits of a number on the page; all of them are in results.json.
_MAX_DIGITS = 60

NUMBER = r"[0-9]+(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?"
_PLAIN_NUMBER = re.compile(rf"[+-]?{NUMBER}")


def superscript(n: int) -> str:
    return str(n).translate(_SUPERSCRIPT)


def number(text: str) -> str:
    """Return −1.23 × 10⁻⁵ for `-1.23e-05`, with at most 60 digits; other text unchanged."""
    if not _PLAIN_NUMBER.fullmatch(text):
        return text
    mantissa, _, exponent = text.lower().partition("e")
    digits = mantissa.lstrip("+-")
    if len(digits) > _MAX_DIGITS:
        digits = digits[:_MAX_DIGITS] + "…"
    sign = "−" if mantissa.startswith("-") else ""
    power = int(exponent or 0)
    scale = f"{NBSP}×{NBSP}10{superscript(power)}" if power else ""
    return f"{sign}{digits}{scale}"


def exact(text: str) -> str:
    """Return a whole number with many final zeros as a multiple of a power of ten; else `number`.

    >>> exact("1000000000000"), exact("-2700000000")
    ('10¹²', '−27\\xa0×\\xa010⁸')
    """
    digits = text.lstrip("-")
    zeros = len(digits) - len(digits.rstrip("0"))
    if not digits.isdecimal() or zeros < _MIN_ZEROS:
        return number(text)
    mantissa = digits[:-zeros]
    sign = "−" if text.startswith("-") else ""
    scale = f"10{superscript(zeros)}"
    return f"{sign}{scale}" if mantissa == "1" else f"{sign}{mantissa}{NBSP}×{NBSP}{scale}"


def step(size: str) -> str:
    """Return a step size; one below 0.0001 as a multiple of a power of ten."""
    if not _PLAIN_NUMBER.fullmatch(size) or Decimal(size) >= _SMALL_STEP:
        return size
    return number(f"{Decimal(size).normalize():e}").removeprefix(f"1{NBSP}×{NBSP}")


def whole(n: int) -> str:
    """Return a count with commas between its thousands."""
    return f"{n:,}"


def count_noun(n: int, singular: str, many: str = "") -> str:
    """Return `1 run` or `1,200 runs`; `many`: the plural if it is not `singular` with an s."""
    return f"1 {singular}" if n == 1 else f"{whole(n)} {many or singular + 's'}"


def every(n: int, singular: str, many: str = "") -> str:
    """Return `the one run` or `all 1,200 runs`."""
    return f"the one {singular}" if n == 1 else f"all {count_noun(n, singular, many)}"


def between(low: str, high: str, to: str = " to ") -> str:
    """Return the two ends of a range; one of them if they are the same."""
    return low if low == high else f"{low}{to}{high}"


def power_of_h(n: int) -> str:
    return "h" if n == 1 else f"h{superscript(n)}"


def value(bounded: Value) -> Markup:
    """Return the known digits with the error bound below; if no digit is known, the bound alone."""
    if bounded.bound == "0":
        return group_digits(bounded.value)
    if bounded.unknown:
        return Markup("|·|{0}≤{0}{1}").format(NBSP, number(bounded.bound))
    return Markup('{} <span class="bound">±{}{}</span>').format(
        group_digits(bounded.value), NBSP, number(bounded.bound)
    )


def group_digits(text: str) -> Markup:
    """Return a number with many decimals in groups, three in a line; any other as by `number`.

    The style sheet makes the gaps, so that a copied number has none.
    """
    formatted = number(text)
    digits, times, scale = formatted.partition(NBSP)
    whole_part, point, decimals = digits.partition(".")
    if (
        not decimals
        or len((whole_part + decimals).lstrip("−")) <= _MAX_UNGROUPED
        or not _PLAIN_NUMBER.fullmatch(text)
    ):
        return escape(formatted)
    groups = [decimals[i : i + _DIGITS_IN_GROUP] for i in range(0, len(decimals), _DIGITS_IN_GROUP)]
    groups[0] = whole_part + point + groups[0]
    groups[-1] += times + scale
    spans = [Markup("<span>{}</span>").format(group) for group in groups]
    rows = [
        Markup("").join(spans[i : i + _GROUPS_IN_LINE])
        for i in range(0, len(spans), _GROUPS_IN_LINE)
    ]
    return Markup('<span class="digits">{}</span>').format(Markup("<br>").join(rows))


def start(
    run: RunResult | Separation | AverageResult | WorkPrecisionResult,
) -> str:
    """Return a run's initial value, and the time at which it starts if that is not 0."""
    t0 = getattr(run, "t0", "0")
    named: dict[str, str] = getattr(run, "start", {})
    texts: dict[str, str | tuple[str, ...]] = {f"{name}₀": x for name, x in named.items()}
    texts = texts or {"q₀": run.q, "p₀": run.p}
    texts |= {} if t0 == "0" else {"t₀": t0}
    return ", ".join(f"{name}{IS}{coordinates(x)}" for name, x in texts.items())


def coordinates(x: str | tuple[str, ...]) -> str:
    """Return a number, or the numbers of n degrees of freedom in brackets."""
    return number(x) if isinstance(x, str) else f"({', '.join(map(number, x))})"


def interval(t0: str, length: Fraction | str, format_end: Callable[[str], str] = str) -> str:
    """Return [t₀, t₀ + length], each end as `format_end` writes it.

    >>> interval("1/3", "2")
    '[1/3, 7/3]'
    """
    return f"[{format_end(t0)}, {format_end(text(Fraction(t0) + Fraction(length)))}]"


def map_name(name: str) -> str:
    """Return a scheme's name, or that of the exact flow, for a sentence."""
    return f"the {name}" if name == EXACT_FLOW else name


def join_and(items: Iterable[str]) -> str:
    """Return a, b and c as text."""
    *others, last = items
    return f"{', '.join(others)} and {last}" if others else last


def is_number(text: str) -> bool:
    return bool(_PLAIN_NUMBER.fullmatch(text))


def is_decimal(text: str) -> bool:
    """Return True if the text is a finite decimal."""
    try:
        return Decimal(text).is_finite()
    except InvalidOperation:
        return False
