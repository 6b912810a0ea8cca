"""MathML within a line: fractions whose letters would be too small are set in one row.

`h³/2 · p` becomes ½h³p, where the fraction has a character of its own, else (h³/24) p; a quotient
becomes p/(2q).
"""

from fractions import Fraction
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

_CHARACTERS = {
    Fraction(p, q): sign
    for (p, q), sign in {
        (1, 2): "½", (1, 3): "⅓", (2, 3): "⅔", (1, 4): "¼", (3, 4): "¾", (1, 5): "⅕", (2, 5): "⅖",
        (3, 5): "⅗", (4, 5): "⅘", (1, 6): "⅙", (5, 6): "⅚", (1, 8): "⅛", (3, 8): "⅜", (5, 8): "⅝",
        (7, 8): "⅞", (1, 9): "⅑", (1, 10): "⅒",
    }.items()
}  # fmt: skip
_TIMES = "\u2062"


def in_line(content: str) -> str:
    """The same markup without stacked fractions."""
    if "<mfrac>" not in content:
        return content
    root = ElementTree.fromstring(content)  # noqa: S314 - `mathml`'s own output
    return ElementTree.tostring(_flat(root, alone=True), encoding="unicode")


def _flat(node: Element, *, alone: bool) -> Element:
    """`alone`: whether nothing is multiplied with it."""
    children = list(node)
    product = node.tag == "mrow" and any(_is_times(child) for child in children)
    inner = [
        _flat(child, alone=not product and node.tag not in ("msup", "msubsup"))
        for child in children
    ]
    if node.tag == "mfrac":
        return _in_a_row(*inner, alone=alone)
    made = Element(node.tag, node.attrib)
    made.text = node.text
    made.extend(inner)
    return made


def _in_a_row(above: Element, below: Element, *, alone: bool) -> Element:
    factors = list(above) if above.tag == "mrow" else [above]
    head = factors[0]
    if below.tag == "mn" and all(map(_is_factor, factors)):
        top = int(head.text or 1) if head.tag == "mn" else 1
        sign = _CHARACTERS.get(Fraction(top, int(below.text or 1)))
        if sign:
            rest = factors[1:] if head.tag == "mn" else [_made("mo", _TIMES), *factors]
            return _row([_made("mn", sign), *rest])
    top_alone = above.tag != "mrow" or all(map(_is_factor, factors))
    slash = _made("mo", "/", lspace="0", rspace="0")
    row = _row([_bracketed(above, not top_alone), slash, _bracketed(below, below.tag == "mrow")])
    return _bracketed(row, not alone)


def _is_factor(node: Element) -> bool:
    return node.tag != "mo" or _is_times(node)


def _is_times(node: Element) -> bool:
    return node.tag == "mo" and node.text == _TIMES


def _bracketed(node: Element, needed: bool) -> Element:
    if not needed:
        return node
    return _row([_made("mo", "(", stretchy="false"), node, _made("mo", ")", stretchy="false")])


def _row(nodes: list[Element]) -> Element:
    made = Element("mrow")
    made.extend(nodes)
    return made


def _made(tag: str, text: str, **attributes: str) -> Element:
    made = Element(tag, attributes)
    made.text = text
    return made
