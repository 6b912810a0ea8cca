"""MathML within a line, with fractions in one row, as stacked letters would be too small.

(h³/2)·p becomes ½h³p, as the fraction ½ has a character of its own; (h³/24)·p keeps a fraction with
a solidus, and a quotient becomes p/(2q).
"""

from fractions import Fraction
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

_FRACTION_CHARACTERS = {
    Fraction(p, q): sign
    for (p, q), sign in {
        (1, 2): "½", (1, 3): "⅓", (2, 3): "⅔", (1, 4): "¼", (3, 4): "¾", (1, 5): "⅕", (2, 5): "⅖",
        (3, 5): "⅗", (4, 5): "⅘", (1, 6): "⅙", (5, 6): "⅚", (1, 8): "⅛", (3, 8): "⅜", (5, 8): "⅝",
        (7, 8): "⅞", (1, 9): "⅑", (1, 10): "⅒",
    }.items()
}  # fmt: skip
_TIMES = "\u2062"


def flatten_fractions(content: str) -> str:
    """Return the markup without stacked fractions."""
    if "<mfrac>" not in content:
        return content
    root = ElementTree.fromstring(content)  # noqa: S314 - `mathml`'s own output
    return ElementTree.tostring(_flatten(root, alone=True), encoding="unicode")


def _flatten(node: Element, *, alone: bool) -> Element:
    """Return the node without stacked fractions; `alone`: True unless it is a factor or a base."""
    children = list(node)
    is_product = node.tag == "mrow" and any(_is_times(child) for child in children)
    inner = [
        _flatten(child, alone=not is_product and node.tag not in ("msup", "msubsup"))
        for child in children
    ]
    if node.tag == "mfrac":
        return _set_in_a_row(*inner, alone=alone)
    copy = Element(node.tag, node.attrib)
    copy.text = node.text
    copy.extend(inner)
    return copy


def _set_in_a_row(numerator: Element, denominator: Element, *, alone: bool) -> Element:
    factors = list(numerator) if numerator.tag == "mrow" else [numerator]
    first_factor = factors[0]
    if denominator.tag == "mn" and all(map(_is_factor, factors)):
        top = int(first_factor.text or 1) if first_factor.tag == "mn" else 1
        # A fraction with a character of its own, such as ½, needs neither slash nor brackets.
        sign = _FRACTION_CHARACTERS.get(Fraction(top, int(denominator.text or 1)))
        if sign:
            other_factors = (
                factors[1:] if first_factor.tag == "mn" else [_element("mo", _TIMES), *factors]
            )
            return _row([_element("mn", sign), *other_factors])
    is_single_term = numerator.tag != "mrow" or all(map(_is_factor, factors))
    slash = _element("mo", "/", lspace="0", rspace="0")
    row = _row(
        [
            _add_brackets(numerator, not is_single_term),
            slash,
            _add_brackets(denominator, denominator.tag == "mrow"),
        ]
    )
    return _add_brackets(row, not alone)


def _is_factor(node: Element) -> bool:
    return node.tag != "mo" or _is_times(node)


def _is_times(node: Element) -> bool:
    return node.tag == "mo" and node.text == _TIMES


def _add_brackets(node: Element, is_needed: bool) -> Element:
    if not is_needed:
        return node
    return _row(
        [_element("mo", "(", stretchy="false"), node, _element("mo", ")", stretchy="false")]
    )


def _row(nodes: list[Element]) -> Element:
    row = Element("mrow")
    row.extend(nodes)
    return row


def _element(tag: str, text: str, **attributes: str) -> Element:
    element = Element(tag, attributes)
    element.text = text
    return element
