"""The notation of formulas in prose: `h^3`, `H_qq`, `e^(Nε)`, `L_{H_p}`, or `[0.5 +/- 2e-13]`.

Anything that is not recognised is escaped unchanged.
"""

import re
from collections.abc import Callable, Sequence

from markupsafe import Markup, escape

from verify.pages.text.typography import NBSP, NUMBER, number, superscript

Rule = tuple[re.Pattern[str], Callable[[re.Match[str]], Markup]]


def notation(text: str) -> Markup:
    """Return the formula with its indices and powers set as such, and minus signs for hyphens.

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
    """
    return apply_rules(text, (INDEX, INTERVAL, POWER, RAISED, MINUS))


def apply_rules(text: str, rules: Sequence[Rule]) -> Markup:
    """Return the text with the rules applied, each to the parts that earlier rules left."""
    if not rules:
        return escape(text)
    (pattern, setting), *others = rules
    parts, rest = [], 0
    for match in pattern.finditer(text):
        parts += [apply_rules(text[rest : match.start()], others), setting(match)]
        rest = match.end()
    return Markup("").join([*parts, apply_rules(text[rest:], others)])


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


# A letter, with an accent or not, and its index: H_qq, z̄_(k+1), L_{H_p}, e^p_k.
INDEX: Rule = (
    re.compile(
        r"((?<![A-Za-z0-9_.])(?:ΔJ|[A-Za-zΔΣ∇∂])[\u0300-\u036f]?ⁿ?|(?<=[a-z])[A-Z])"
        r"(?:\^([a-z]))?_"
        r"(\{[^{}]*\}|\([^()]*\)|[A-Za-z0-9]{1,3}(?![A-Za-z0-9_]))"
    ),
    _subscript,
)
INTERVAL: Rule = (re.compile(rf"\[(-?{NUMBER}) \+/- ({NUMBER})\]"), _interval)
# Names such as stormer-verlet have hyphens, between letters.
MINUS: Rule = (re.compile(r"(?<![A-Za-z])-|-(?![A-Za-z])"), lambda _: Markup("−"))
POWER: Rule = (re.compile(r"\b(10|[A-Za-z])\^(-?[0-9]+)\b(?!\.[0-9])"), _power)
RAISED: Rule = (
    re.compile(r"(?<=\S)\^(\((?:[^()]|\([^()]*\))*\)|[−-]?\w+(?:\.[0-9]+)?)"),
    _superscript,
)
