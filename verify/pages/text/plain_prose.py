"""Prose that does not know its parts: its formulas and numbers are found in the plain text.

This goes once all that is said is a `verify.prose.Prose`.
"""

import re

from markupsafe import Markup

from verify.pages.text import mathml
from verify.pages.text.notation import INDEX, POWER, RAISED, Rule, applied
from verify.pages.text.typography import NBSP, NUMBER, number

_TOKEN = re.compile(r"\s*(?:(\*\*|[-+*/()])|([A-Za-z][A-Za-z0-9_]*|[0-9]+(?:\.[0-9]+)?))")


def plain_prose(text: str) -> Markup:
    """The text with its formulas and numbers set properly."""
    parts, rest = [], 0
    for start, end in _formulas(text):
        parts += [_sentence(text[rest:start]), mathml.formula(text[start:end])]
        rest = end
    return Markup("").join([*parts, _sentence(text[rest:])])


def _interval(match: re.Match[str]) -> Markup:
    middle, radius = number(match[1]), number(match[2])
    return Markup('<span class="nowrap">{0}{2}±{2}{1}</span>').format(middle, radius, NBSP)


def _equals(match: re.Match[str]) -> Markup:
    """`q₀ = 0.1` stays on one line; a parameter before the sign is set as a symbol."""
    known = match[1] is not None and mathml.is_greek(match[1])
    return Markup("{}{}={}").format(mathml.name(match[1]) if known else match[1] or "", NBSP, NBSP)


def _kept_together(match: re.Match[str]) -> Markup:
    return Markup('<span class="nowrap">{}</span>').format(match[0])


def _number_in_text(match: re.Match[str]) -> Markup:
    return Markup("{}").format(number(match[0]))


_RULES: list[Rule] = [
    INDEX,
    (re.compile(r"\b(?:([A-Za-z]\w*)|(?<=\w)) = (?=-?[0-9])"), _equals),
    (re.compile(r"\w+/\|\w+\|"), _kept_together),
    (re.compile(rf"\[(-?{NUMBER}) \+/- ({NUMBER})\]"), _interval),
    POWER,
    RAISED,
    (re.compile(r"(?<![\w.)])-?[0-9]+(?:\.[0-9]+)?[eE][+-]?[0-9]+\b"), _number_in_text),
    (re.compile(r"(?<![\w.)])-[0-9]+(?:\.[0-9]+)?(?![\w])"), _number_in_text),
]


def _sentence(text: str) -> Markup:
    return applied(text, _RULES)


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
