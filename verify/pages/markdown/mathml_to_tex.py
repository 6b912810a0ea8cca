"""Conversion of MathML, as `verify.pages.text.mathml` writes it, to TeX for a repository page.

Only the elements that `verify.pages.text.mathml` writes are known; any other one is replaced by its
content. sympy's LaTeX printer is not used, since it orders terms differently (see there). A leaf is
never taken for a command: its letters are set one by one or as upright text.
"""

import re
from unicodedata import normalize

from verify.functions import by_name
from verify.pages.markdown.markup import Node
from verify.pages.text.mathml import GREEK

_OTHER_LETTERS = {"ε": "varepsilon", "λ": "lambda", "π": "pi", "φ": "varphi"}
_GREEK = {letter: name for name, letter in GREEK.items() if letter != "ο"} | _OTHER_LETTERS
# The functions by their printed names, without the root, which has a sign; papers also write log.
_FUNCTIONS = {f.shown: f.tex for f in by_name().values() if f.name != "sqrt"} | {"log": r"\log"}
_LARGE = {"max": r"\max ", "min": r"\min ", "lim": r"\lim ", "∑": r"\sum ", "∏": r"\prod "}
_SIGNS = {
    "−": "-", "\u2061": "", "\u2062": r"\,", "′": "'", "≡": r"\equiv ", "≤": r"\le ",
    "·": r"\cdot ", "±": r"\pm ", "×": r"\times ", "|": r"\vert ", "⟨": r"\langle ",
    "⟩": r"\rangle ", "ο": "o", "≥": r"\ge ", "≠": r"\ne ", "→": r"\to ", "↦": r"\mapsto ",
    "∘": r"\circ ", "∧": r"\wedge ", "∈": r"\in ", "≈": r"\approx ", "⇒": r"\Rightarrow ",
    "⇔": r"\Leftrightarrow ", "…": r"\dots ", "∂": r"\partial ", "∇": r"\nabla ",
    "∞": r"\infty ", "∑": r"\sum ", "∏": r"\prod ", "∫": r"\int ", "‖": r"\Vert ",
    "<": r"\lt ", ">": r"\gt ", "\u00a0": r"\ ", "∪": r"\cup ", "∩": r"\cap ",
}  # fmt: skip
_ACCENTS = {"\u0304": "bar", "\u0303": "tilde", "\u0307": "dot", "\u0308": "ddot"}
_PLAIN = re.compile(r"[A-Za-z0-9+\-=/().,;:! ]")
_SPECIAL_CHARACTERS = set("#%&_{}")


def tex(node: Node) -> str:
    """Return the element as TeX, without delimiters, backticks, dollar signs and pipes."""
    inner = [tex(c) for c in node.elements()]
    match node.tag, inner:
        case (("mi" | "mn" | "mtext"), _):
            return _leaf(node.text)
        case "mo", _:
            return _operator(node)
        case "msup", [base, upper]:
            return f"{_group(base)}^{{{upper}}}"
        case "msub", [base, lower]:
            return f"{_group(base)}_{{{lower}}}"
        case "munder", [_, lower]:
            return f"{_large_operator(node)}_{{{lower}}}"
        case "msubsup", [base, lower, upper]:
            return f"{_group(base)}_{{{lower}}}^{{{upper}}}"
        case "munderover", [_, lower, upper]:
            return f"{_large_operator(node)}_{{{lower}}}^{{{upper}}}"
        case "mspace", _:
            return r"\,"
        case "mfrac", [above, below]:
            return rf"\frac{{{above}}}{{{below}}}"
        case "msqrt", _:
            return rf"\sqrt{{{''.join(inner)}}}"
        case "mroot", [base, degree]:
            return rf"\sqrt[{degree}]{{{base}}}"
        case "mtable", _:
            return _table(node)
    return "".join(inner)


def _table(node: Node) -> str:
    entries = [row.elements() for row in node.elements()]
    lines = r" \\ ".join(" & ".join(tex(e) for e in row) for row in entries)
    # Lines of one sum carry how they are aligned; the entries of a matrix do not.
    is_sum = any("class" in e.attributes for row in entries for e in row)
    name = "aligned" if is_sum else "matrix"
    return rf"\begin{{{name}}} {lines} \end{{{name}}}"


def _operator(node: Node) -> str:
    if node.attributes.get("stretchy") != "false":
        if node.text == "(":
            return r"\left("
        if node.text == ")":
            return r"\right)"
    return "".join(_character(c) for c in node.text)


def _leaf(text: str) -> str:
    if text in _FUNCTIONS:
        return f"{_FUNCTIONS[text]} "
    if fraction := re.fullmatch("([0-9]+)\N{FRACTION SLASH}([0-9]+)", normalize("NFKC", text)):
        return rf"\tfrac{{{fraction[1]}}}{{{fraction[2]}}}"
    if len(text) == 2 and text[1] in _ACCENTS:
        return rf"\{_ACCENTS[text[1]]}{{{_character(text[0])}}}"
    characters = "".join(_character(c) for c in text)
    if len(text) > 1 and not re.fullmatch(r"[0-9.]+", text):
        return rf"\mathrm{{{characters}}}"
    return characters


def _character(c: str) -> str:
    if c in _GREEK:
        return f"\\{_GREEK[c]} "
    if c in _SPECIAL_CHARACTERS:
        return f"\\{c}"
    return _SIGNS.get(c, c if _PLAIN.fullmatch(c) else "?")


def _group(base: str) -> str:
    return base if len(base) == 1 else f"{{{base}}}"


def _large_operator(node: Node) -> str:
    """Return the TeX of an operator that has its limits above and below it."""
    base = node.elements()[0]
    return _LARGE.get(base.text) or _group(tex(base))
