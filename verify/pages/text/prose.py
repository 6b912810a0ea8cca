"""What results say, as the pages set it: by its parts, each in its way.

A text is escaped as it is, and nothing is looked for in it.
"""

import re
from collections.abc import Sequence

from markupsafe import Markup, escape

from verify.pages.text import mathml
from verify.pages.text.displayed import displayed
from verify.pages.text.notation import notation
from verify.pages.text.typography import NBSP, is_number, number
from verify.prose import Display, Formula, Number, Prose, read_prose

_EQUALS = " = "
_STOPS = tuple(".,;:")
_NAME = 12  # characters of a formula that is given a value
_ONE_LINE = 40  # characters of a formula that is not broken; a phone has room for them


def prose(text: str) -> Markup:
    """Evidence or a statement, with its formulas and numbers set properly.

    >>> str(prose(Prose("2 * 3 of ", Formula("e^(Nε)"), " below ", Number("1e-9"))))
    '2 * 3 of e<sup>Nε</sup> below 1\\xa0×\\xa010⁻⁹'
    """
    parts = text.parts if isinstance(text, Prose) else (text,)
    made, at = [], 0
    while at < len(parts):
        if _is_value(parts[at : at + 3]):  # p = 7/17 stays on one line
            named, _, value = map(_set, parts[at : at + 3], ("", "", ""))
            made.append(Markup('<span class="nowrap">{} = {}</span>').format(named, value))
            at += 3
        else:
            following = parts[at + 1] if at + 1 < len(parts) else ""
            made.append(_set(_without_stop(parts, at), following))
            at += 1
    return Markup("").join(made)


def _without_stop(parts: Sequence[str], at: int) -> str:
    """The part, but for a stop or a comma that belongs to a formula on the line above it."""
    stopped = at and isinstance(parts[at - 1], Display) and _stop(parts[at])
    return parts[at][1:] if stopped else parts[at]


def _stop(text: str) -> str:
    return text[:1] if type(text) is str and text[:1] in _STOPS else ""


def _is_value(parts: Sequence[str]) -> bool:
    """A short formula, an equals sign and a number."""
    if len(parts) < 3 or not isinstance(parts[0], Formula) or len(parts[0]) > _NAME:
        return False
    return type(parts[1]) is str and parts[1] == _EQUALS and isinstance(parts[2], Number)


def quoted(text: str) -> Markup:
    """What people write, with its formulas between backticks."""
    return prose(read_prose(text))


def _set(part: str, following: str) -> Markup:
    if isinstance(part, Display):
        return displayed(part, _stop(following))
    if isinstance(part, Number):
        return escape(number(part))
    if isinstance(part, Formula):
        if not _short(part) and mathml.read(part) is not None:
            return mathml.formula(part)
        whole = " " in part and len(part) <= _ONE_LINE
        set_ = notation(part)
        return Markup('<span class="nowrap">{}</span>').format(set_) if whole else set_
    if isinstance(following, Number) and part.endswith(_EQUALS):  # q = 0.1 stays on one line
        return escape(part.removesuffix(_EQUALS)) + f"{NBSP}={NBSP}"
    return escape(part)


def _short(formula: str) -> bool:
    """Whether an index or a power is all that is to be set: copied, h³ stays h³."""
    return "*" not in formula and bool(re.search("[_^]", formula))


def sentence(text: str) -> Markup:
    """Prose as a sentence of its own: with a capital, unless it opens with a name, and a stop."""
    parts = text.parts if isinstance(text, Prose) else (str(text),)
    opening = parts[0] if parts and type(parts[0]) is str else ""
    if re.match(r"(?!det )[a-z]{2,}[ ,]", opening):
        parts = (opening[0].upper() + opening[1:], *parts[1:])
    if not text.endswith((".", "!", "?")):
        parts = (*parts, ".")
    return prose(Prose(*parts))


def cell(text: str) -> Markup:
    """A table's cell: a number, or a short text."""
    return escape(number(text)) if is_number(text) else prose(text)
