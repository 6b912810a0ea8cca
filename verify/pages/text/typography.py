"""Numbers and sentences as a page sets them: × 10ⁿ, minus signs, subscripts, formulas as MathML.

Everything here starts from text that others wrote; what is not recognised is escaped as it is.
A number keeps exactly the digits it comes with.
"""

import re
from collections.abc import Callable, Iterable
from decimal import Decimal, InvalidOperation

from markupsafe import Markup, escape

from verify.pages.text import mathml
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.growth import AverageResult
from verify.scenes.results.run import RunResult
from verify.scenes.results.separation import SeparationResult
from verify.scenes.results.work_precision import WorkPrecisionResult

NBSP = "\u00a0"
_SUPERSCRIPT = str.maketrans("0123456789-+", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺")
_GROUP, _IN_A_LINE = 5, 3  # digits to a group, groups to a line
_UNGROUPED = 17  # digits at most of a number that is left in one piece
_SMALL_STEP = Decimal("0.0001")
_MOST_DIGITS = 60  # of one number on the page; the others are in results.json

_NUMBER = r"[0-9]+(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?"
_PLAIN_NUMBER = re.compile(rf"[+-]?{_NUMBER}")
_TOKEN = re.compile(r"\s*(?:(\*\*|[-+*/()])|([A-Za-z][A-Za-z0-9_]*|[0-9]+(?:\.[0-9]+)?))")


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


def step(size: str) -> str:
    """A step size; a small one as a power of ten, whose zeros nobody needs to count."""
    if not _PLAIN_NUMBER.fullmatch(size) or Decimal(size) >= _SMALL_STEP:
        return size
    return number(f"{Decimal(size).normalize():e}").removeprefix(f"1{NBSP}×{NBSP}")


def whole(n: int) -> str:
    """A count with its thousands set apart."""
    return f"{n:,}"


def value(found: Value) -> Markup:
    """The known digits and, below them, the error bound; a bound alone where no digit is known."""
    if found.bound == "0":
        return grouped(found.value)
    if Decimal(found.value) == 0:
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


def start(run: RunResult | SeparationResult | AverageResult | WorkPrecisionResult) -> str:
    """A run's initial value."""
    q, p = number(run.q), number(run.p)
    return f"q₀{NBSP}={NBSP}{q}, p₀{NBSP}={NBSP}{p}"


def listed(items: Iterable[str]) -> str:
    """a, b and c."""
    *most, last = items
    return f"{', '.join(most)} and {last}" if most else last


# -- sentences ------------------------------------------------------------------------------------


def prose(text: str) -> Markup:
    """One sentence of evidence or statement, with its formulas and numbers set properly."""
    parts, rest = [], 0
    for start, end in _formulas(text):
        parts += [_sentence(text[rest:start]), mathml.formula(text[start:end])]
        rest = end
    return Markup("").join([*parts, _sentence(text[rest:])])


def sentence(text: str) -> Markup:
    """Prose as a sentence of its own: with a capital, unless it opens with a name, and a stop."""
    if re.match(r"(?!det )[a-z]{2,}[ ,]", text):
        text = text[0].upper() + text[1:]
    return prose(text if text.endswith((".", "!", "?")) else f"{text}.")


def cell(text: str) -> Markup:
    """A table's cell: a number, or a short text."""
    if _PLAIN_NUMBER.fullmatch(text):
        return escape(number(text))
    return prose(text)


def is_number(text: str) -> bool:
    return bool(_PLAIN_NUMBER.fullmatch(text))


def _interval(match: re.Match[str]) -> Markup:
    middle, radius = number(match[1]), number(match[2])
    return Markup('<span class="nowrap">{0}{2}±{2}{1}</span>').format(middle, radius, NBSP)


def _power(match: re.Match[str]) -> Markup:
    if match[2] == "1":
        return escape(match[1])
    return Markup("{}{}").format(match[1], superscript(int(match[2])))


def _equals(match: re.Match[str]) -> Markup:
    """`q₀ = 0.1` stays on one line; a parameter before the sign is set as a symbol."""
    known = match[1] is not None and mathml.is_greek(match[1])
    return Markup("{}{}={}").format(mathml.name(match[1]) if known else match[1] or "", NBSP, NBSP)


def _kept_together(match: re.Match[str]) -> Markup:
    return Markup('<span class="nowrap">{}</span>').format(match[0])


def _raised(match: re.Match[str]) -> Markup:
    return Markup("<sup>{}</sup>").format(_sentence(_unbracketed(match[1])))


def _lowered(match: re.Match[str]) -> Markup:
    return Markup("{}<sub>{}</sub>").format(match[1], _sentence(_unbracketed(match[2])))


def _unbracketed(text: str) -> str:
    return text[1:-1] if text[0] in "({" else text


def _number_in_text(match: re.Match[str]) -> Markup:
    return Markup("{}").format(number(match[0]))


# A letter, with an accent or not, and its index: H_qq, z̄_(k+1), L_{H_p}.
_INDEX = (
    r"((?<![A-Za-z0-9_.])(?:ΔJ|[A-Za-zΔΣ])[\u0300-\u036f]?|(?<=[a-z])[A-Z])_"
    r"(\{[^{}]*\}|\([^()]*\)|[A-Za-z0-9]{1,3}(?![A-Za-z0-9_]))"
)
_RULES: list[tuple[re.Pattern[str], Callable[[re.Match[str]], Markup]]] = [
    (re.compile(_INDEX), _lowered),
    (re.compile(r"\b(?:([A-Za-z]\w*)|(?<=\w)) = (?=-?[0-9])"), _equals),
    (re.compile(r"\w+/\|\w+\|"), _kept_together),
    (re.compile(rf"\[(-?{_NUMBER}) \+/- ({_NUMBER})\]"), _interval),
    (re.compile(r"\b(10|[A-Za-z])\^(-?[0-9]+)\b"), _power),
    (re.compile(r"(?<=\S)\^(\((?:[^()]|\([^()]*\))*\)|[−-]?\w+)"), _raised),
    (re.compile(r"(?<![\w.)])-?[0-9]+(?:\.[0-9]+)?[eE][+-]?[0-9]+\b"), _number_in_text),
    (re.compile(r"(?<![\w.)])-[0-9]+(?:\.[0-9]+)?(?![\w])"), _number_in_text),
]


def _sentence(text: str, rules: int = 0) -> Markup:
    """The text with the rules applied, each to what the ones before it left."""
    if rules == len(_RULES):
        return escape(text)
    pattern, setting = _RULES[rules]
    parts, rest = [], 0
    for match in pattern.finditer(text):
        parts += [_sentence(text[rest : match.start()], rules + 1), setting(match)]
        rest = match.end()
    return Markup("").join([*parts, _sentence(text[rest:], rules + 1)])


# -- formulas inside sentences --------------------------------------------------------------------


def _formulas(text: str) -> list[tuple[int, int]]:
    """Where formulas with a power or a product stand in the text."""
    found, at = [], 0
    while at < len(text):
        start, end = _longest(text, at)
        if "*" in text[start:end] and mathml.read(text[start:end]) is not None:
            found.append((start, end))
        at = max(end, at + 1)
    return found


def _longest(text: str, at: int) -> tuple[int, int]:
    """The longest formula that starts at the next token from `at`: operands and operators in turn.

    Two words side by side end it, so a sentence's words do not become factors; signs and open
    brackets may stand before an operand.
    """
    first = _TOKEN.match(text, at)
    if first is None or (at and (text[at - 1].isalnum() or text[at - 1] in "_.'’")):
        return at, at
    start = at + len(first[0]) - len(first[0].lstrip())
    end, depth, operand_next, position = start, 0, True, at
    while match := _TOKEN.match(text, position):
        mark, operand = match[1], match[2]
        if operand_next:
            if mark == "(":
                depth += 1
            elif operand:
                operand_next = False
            elif mark not in ("-", "+"):
                break
        elif mark == "(" and text[match.start(1) - 1].isalpha():
            depth, operand_next = depth + 1, True  # a function's bracket
        elif mark == ")" and depth:
            depth -= 1
        elif mark and mark not in "()":
            operand_next = True
        else:
            break
        position = match.end()
        if not operand_next and depth == 0:
            end = position
    return start, end


def is_decimal(text: str) -> bool:
    """Whether the text is a finite decimal."""
    try:
        return Decimal(text).is_finite()
    except InvalidOperation:
        return False
