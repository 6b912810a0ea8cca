"""Typesetting of the prose of results, part by part, each by its kind.

Plain text is escaped unchanged; it is not searched for formulas or numbers.
"""

import re
from collections.abc import Sequence

from markupsafe import Markup, escape

from verify.pages.text import mathml
from verify.pages.text.displayed import display_formula
from verify.pages.text.notation import notation
from verify.pages.text.typography import NBSP, is_number, number
from verify.prose import Display, Formula, Number, Prose, read_prose

_EQUALS = " = "
_STOPS = tuple(".,;:")
# Characters of a formula that is taken for a name in NAME = VALUE.
_MAX_NAME = 12
# Characters of a formula that is not broken between lines; a phone has room for them.
_MAX_UNBROKEN = 40


def prose(text: str) -> Markup:
    """Return evidence or a statement with its formulas and numbers set properly.

    >>> str(prose(Prose("2 * 3 of ", Formula("e^(Nε)"), " below ", Number("1e-9"))))
    '2 * 3 of e<sup>Nε</sup> below 1\\xa0×\\xa010⁻⁹'
    """
    parts = text.parts if isinstance(text, Prose) else (text,)
    set_parts, place = [], 0
    while place < len(parts):
        if _is_value(parts[place : place + 3]):  # p = 7/17 stays on one line
            formula, _, value = map(_set_part, parts[place : place + 3], ("", "", ""))
            set_parts.append(Markup('<span class="nowrap">{} = {}</span>').format(formula, value))
            place += 3
        else:
            following = parts[place + 1] if place + 1 < len(parts) else ""
            set_parts.append(_set_part(_without_stop(parts, place), following))
            place += 1
    return Markup("").join(set_parts)


def _without_stop(parts: Sequence[str], place: int) -> str:
    """Return the part without a stop or comma that belongs to the displayed formula before it."""
    has_stop = place and isinstance(parts[place - 1], Display) and _stop(parts[place])
    return parts[place][1:] if has_stop else parts[place]


def _stop(text: str) -> str:
    return text[:1] if type(text) is str and text[:1] in _STOPS else ""


def _is_value(parts: Sequence[str]) -> bool:
    """Return True for a short formula, an equals sign and a number."""
    if len(parts) < 3 or not isinstance(parts[0], Formula) or len(parts[0]) > _MAX_NAME:
        return False
    return type(parts[1]) is str and parts[1] == _EQUALS and isinstance(parts[2], Number)


def prose_with_backticks(text: str) -> Markup:
    """Return a text with formulas between backticks, set as prose."""
    return prose(read_prose(text))


def _set_part(part: str, following: str) -> Markup:
    if isinstance(part, Display):
        return display_formula(part, _stop(following))
    if isinstance(part, Number):
        return escape(number(part))
    if isinstance(part, Formula):
        if not _is_index_or_power(part) and mathml.read(part) is not None:
            return mathml.formula(part)
        fits_in_line = " " in part and len(part) <= _MAX_UNBROKEN
        formula = notation(part)
        return Markup('<span class="nowrap">{}</span>').format(formula) if fits_in_line else formula
    if isinstance(following, Number) and part.endswith(_EQUALS):  # q = 0.1 stays on one line
        return escape(part.removesuffix(_EQUALS)) + f"{NBSP}={NBSP}"
    return escape(part)


def _is_index_or_power(formula: str) -> bool:
    """Return True if only indices or powers are to be set, so that h³ is copied as h³."""
    return "*" not in formula and bool(re.search("[_^]", formula))


def sentence(text: str) -> Markup:
    """Return prose as a sentence: with a capital, unless it opens with a name, and a stop."""
    parts = text.parts if isinstance(text, Prose) else (str(text),)
    opening = parts[0] if parts and type(parts[0]) is str else ""
    # A name or a formula keeps its small letter; det is a formula's beginning.
    if re.match(r"(?!det )[a-z]{2,}[ ,]", opening):
        parts = (opening[0].upper() + opening[1:], *parts[1:])
    if not text.endswith((".", "!", "?")):
        parts = (*parts, ".")
    return prose(Prose(*parts))


def cell(text: str) -> Markup:
    """Return a table's cell: a number, or a short text."""
    return escape(number(text)) if is_number(text) else prose(text)
