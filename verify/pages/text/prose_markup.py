"""Typesetting of the prose of results, part by part, each by its kind.

Plain text is escaped unchanged; it is not searched for formulas or numbers. A formula that is not
an expression may have indices, powers and intervals: `h^3`, `H_qq`, `e^(Nε)`, `L_{H_p}` or
`[0.5 +/- 2e-13]`. The rest of such a formula is escaped unchanged.
"""

import re
from collections.abc import Callable, Sequence

from markupsafe import Markup, escape

from verify.pages.text import mathml
from verify.pages.text.display_math import display_formula
from verify.pages.text.typography import NBSP, NUMBER, is_number, number, superscript
from verify.prose import Display, Formula, Number, Prose, read_prose

Rule = tuple[re.Pattern[str], Callable[[re.Match[str]], Markup]]

_EQUALS = " = "
_STOPS = tuple(".,;:")
# The limit on characters of NAME in NAME = VALUE.
_MAX_NAME = 12
# The limit on characters of a formula that is not broken between lines, for a phone.
_MAX_UNBROKEN = 40


# -- prose ----------------------------------------------------------------------------------------


def prose(text: str) -> Markup:
    """Return evidence or a statement as markup, with its formulas and numbers typeset.

    >>> str(prose(Prose("2 * 3 of ", Formula("e^(Nε)"), " below ", Number("1e-9"))))
    '2 * 3 of e<sup>Nε</sup> below 1\\xa0×\\xa010⁻⁹'
    """
    parts = text.parts if isinstance(text, Prose) else (text,)
    set_parts, index = [], 0
    while index < len(parts):
        if _is_value(parts[index : index + 3]):  # p = 7/17 stays on one line
            formula, _, value = map(_set_part, parts[index : index + 3], ("", "", ""))
            set_parts.append(Markup('<span class="nowrap">{} = {}</span>').format(formula, value))
            index += 3
        else:
            following = parts[index + 1] if index + 1 < len(parts) else ""
            set_parts.append(_set_part(_without_stop(parts, index), following))
            index += 1
    return Markup("").join(set_parts)


def _without_stop(parts: Sequence[str], index: int) -> str:
    """Return the part without a stop or comma that the displayed formula before it has taken."""
    has_stop = index and isinstance(parts[index - 1], Display) and _stop(parts[index])
    return parts[index][1:] if has_stop else parts[index]


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
    """Return True if the formula has indices or powers but no product; then h³ is copied as h³."""
    return "*" not in formula and bool(re.search("[_^]", formula))


def sentence(text: str) -> Markup:
    """Return prose as a sentence: with a capital, unless a symbol begins it, and a stop."""
    parts = text.parts if isinstance(text, Prose) else (str(text),)
    opening = parts[0] if parts and type(parts[0]) is str else ""
    # A symbol or a formula keeps its small letter, and so does det, which begins a formula.
    if re.match(r"(?!det )[a-z]{2,}[ ,]", opening):
        parts = (opening[0].upper() + opening[1:], *parts[1:])
    if not text.endswith((".", "!", "?")):
        parts = (*parts, ".")
    return prose(Prose(*parts))


def cell(text: str) -> Markup:
    """Return a table's cell: a number, or a short text."""
    return escape(number(text)) if is_number(text) else prose(text)


# -- the notation of a formula in prose -----------------------------------------------------------


def notation(text: str) -> Markup:
    """Return the formula with its indices and powers typeset, and minus signs for hyphens.

    >>> str(notation("f = (-H_q, H_p)"))
    'f = (−H<sub>q</sub>, H<sub>p</sub>)'
    >>> str(notation("L_{H_p}(q_k) + O(h^12)"))
    'L<sub>H<sub>p</sub></sub>(q<sub>k</sub>) + O(h¹²)'
    >>> str(notation("Lⁿ_{H_p} = H_p ∂_q"))
    'Lⁿ<sub>H<sub>p</sub></sub> = H<sub>p</sub> ∂<sub>q</sub>'
    >>> str(notation("e^p_{k+1} + C̃_p"))
    'e<sup>p</sup><sub>k+1</sub> + C̃<sub>p</sub>'
    >>> str(notation("10^-6.3010"))
    '10<sup>−6.3010</sup>'
    >>> str(notation("e^(hL_p)"))
    'e<sup>hL<sub>p</sub></sup>'
    """
    return apply_rules(text, (RAISED_INDEX, INDEX, INTERVAL, POWER, RAISED, MINUS))


def apply_rules(text: str, rules: Sequence[Rule]) -> Markup:
    """Return the text with the rules applied, each to the text that earlier rules did not match."""
    if not rules:
        return escape(text)
    (pattern, setting), *later_rules = rules
    parts, end = [], 0
    for match in pattern.finditer(text):
        parts += [apply_rules(text[end : match.start()], later_rules), setting(match)]
        end = match.end()
    return Markup("").join([*parts, apply_rules(text[end:], later_rules)])


def _subscript(match: re.Match[str]) -> Markup:
    upper = Markup("<sup>{}</sup>").format(match[2]) if match[2] else ""
    return Markup("{}{}<sub>{}</sub>").format(match[1], upper, notation(_strip_brackets(match[3])))


def _interval(match: re.Match[str]) -> Markup:
    middle, radius = number(match[1]), number(match[2])
    return Markup('<span class="nowrap">{0}{2}±{2}{1}</span>').format(middle, radius, NBSP)


def _power(match: re.Match[str]) -> Markup:
    if match[2] == "1":
        return escape(match[1])
    return Markup("{}{}").format(match[1], superscript(int(match[2])))


def _superscript(match: re.Match[str]) -> Markup:
    return Markup("<sup>{}</sup>").format(notation(_strip_brackets(match[1])))


def _strip_brackets(text: str) -> str:
    return text[1:-1] if text[0] in "({" else text


# A power with an index in it, which would else be torn by the index: e^(hL_p).
RAISED_INDEX: Rule = (re.compile(r"(?<=\S)\^(\([^()]*_[^()]*\))"), _superscript)
# A letter, perhaps with an accent, and its index: H_qq, z̄_(k+1), L_{H_p}, e^p_k.
INDEX: Rule = (
    re.compile(
        r"((?<![A-Za-z0-9_.])(?:ΔJ|[A-Za-zΔΣΦ∇∂])[\u0300-\u036f]?ⁿ?|(?<=[a-z])[A-Z])"
        r"(?:\^([a-z]))?_"
        r"(\{[^{}]*\}|\([^()]*\)|[A-Za-z0-9]{1,3}(?![A-Za-z0-9_]))"
    ),
    _subscript,
)
INTERVAL: Rule = (re.compile(rf"\[(-?{NUMBER}) \+/- ({NUMBER})\]"), _interval)
# A hyphen between letters, as in stormer-verlet, stays.
MINUS: Rule = (re.compile(r"(?<![A-Za-z])-|-(?![A-Za-z])"), lambda _: Markup("−"))
POWER: Rule = (re.compile(r"\b(10|[A-Za-z])\^(-?[0-9]+)\b(?!\.[0-9])"), _power)
RAISED: Rule = (
    re.compile(r"(?<=\S)\^(\((?:[^()]|\([^()]*\))*\)|[−-]?\w+(?:\.[0-9]+)?)"),
    _superscript,
)
