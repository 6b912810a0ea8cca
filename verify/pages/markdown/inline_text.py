"""Conversion of text and the page's markup to lines of Markdown in which foreign text stays text.

Inside a line GitHub allows a few HTML elements, which, unlike asterisks and backticks, mean the
same in a table, beside any letter and around any text.

MathML, as `verify.pages.text.mathml` writes it, becomes TeX; any other element is replaced by its
content. sympy's LaTeX printer is not used, as it orders terms differently (see that module). The
text of a leaf cannot become a command of TeX: its letters are set one by one, or as upright text.

GitHub does not set formulas in a <summary>: there MathML becomes indices, powers, fractions with a
solidus and roots with a sign.
"""

import re
from collections.abc import Iterable, Sequence
from unicodedata import normalize

from markupsafe import escape

from verify.functions import by_name
from verify.pages.markdown.markup import MarkupNode, tree
from verify.pages.text.formula_parts import GREEK

_SPECIAL_CHARACTERS = re.compile(r"[\\`*_\[\]|~#]")
# At the start of a line these would begin a list, underline a heading or align a table.
_LINE_START = re.compile(r"[-+=:]|[0-9]+(?=[.)](?:\s|$))")
_ENTITIES = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;"})
_HTML_TAGS = {
    "sub": "sub",
    "sup": "sup",
    "b": "b",
    "strong": "b",
    "em": "i",
    "i": "i",
    "code": "code",
}
# Classes that the page sets smaller, beside or below a number; in Markdown they are in brackets.
_ASIDES = {"bound", "beside"}
# Only links within the report are kept, so that foreign text cannot link anywhere.
_SAFE_LINK = re.compile(r"#[A-Za-z0-9_.-]+|results\.json")
# Invisible signs become spaces: function application and multiplication.
_SIGNS = {"\u2061": " ", "\u2062": " "}


class Markdown(str):
    """Text in the syntax of Markdown, which is not escaped again."""

    __slots__ = ()


def markdown(content: object) -> Markdown:
    """Return the content as part of a line: Markdown unchanged, markup converted, else as text."""
    if isinstance(content, Markdown):
        return content
    if hasattr(content, "__html__"):
        return line([tree(content.__html__())])
    return escape_markdown("" if content is None else str(content))


def escape_markdown(text: str) -> Markdown:
    """Return the text in one line, with all marks of Markdown and HTML escaped."""
    # No-break spaces, at which \s would split, are a private character meanwhile.
    line = " ".join(re.split(r"[\s\x00-\x1f]+", text.replace("\u00a0", "\ue000"))).strip()
    return Markdown(_escape_line_start(_escape_marks(line).replace("\ue000", "\u00a0")))


def line(pieces: Iterable[MarkupNode | str], *, escapes_start: bool = True) -> Markdown:
    """Return pieces of markup in one line; without `escapes_start` the start may mean a block."""
    text = re.sub(" {2,}", " ", "".join(map(_inline, pieces)).strip(" "))
    return Markdown(_escape_line_start(text) if escapes_start else text)


def render_html(node: MarkupNode) -> Markdown:
    """Return the node's content as HTML, for a <summary>, where Markdown's marks mean nothing."""
    return Markdown(re.sub(" {2,}", " ", _html(node)).strip())


def _inline(node: MarkupNode | str) -> str:
    if isinstance(node, str):
        return _escape_marks(re.sub(r"[ \t\r\n]+", " ", node))
    if node.tag == "math":
        return _formula(node)
    if node.tag == "br":
        return "<br>"
    if node.attributes.get("class") == "digits":
        return _escape_marks(node.text)  # without the groups, which the style sheet sets apart
    inner = "".join(_inline(child) for child in node.children)
    tag = "b" if "badge" in node.classes else _HTML_TAGS.get(node.tag)
    if tag:
        return f"<{tag}>{inner}</{tag}>"
    if node.tag == "a" and _SAFE_LINK.fullmatch(node.attributes.get("href", "")):
        return f"[{inner}]({node.attributes['href']})"
    if node.attributes.get("aria-hidden"):
        return f"{inner} "  # a sign, which the style sheet sets apart from the text after it
    if _ASIDES & set(node.classes) and not inner.startswith("±"):
        return f"({inner})"
    return inner


def _formula(node: MarkupNode) -> str:
    """Return a formula between ``$` `` and `` `$``, a display as a block of its own."""
    if node.attributes.get("display") == "block":
        return f"\n\n```math\n{tex(node).strip()}\n```\n\n"
    return f"$`{tex(node).strip()}`$"


def _escape_line_start(line: str) -> str:
    """Escape the start of a line that would begin a list or underline a heading."""
    start = _LINE_START.match(line)
    if start is None:
        return line
    return f"{start[0]}\\{line[start.end() :]}" if start[0].isdigit() else f"\\{line}"


def _escape_marks(text: str) -> str:
    text = _SPECIAL_CHARACTERS.sub(r"\\\g<0>", text.translate(_ENTITIES))
    # After a dollar sign GitHub would read a formula, and it would make a link of an address.
    text = text.replace("$", "<span>$</span>").replace("://", "&#58;//")
    return re.sub(r"(?i)\bwww\.", lambda m: f"{m[0][:-1]}&#46;", text)


def table(
    heads: Sequence[object], rows: Iterable[Sequence[object]], alignments: str = ""
) -> Markdown:
    """Return a table whose columns are aligned right, as numbers are.

    `alignments`: a letter for each of the first columns, l (left) or r (right), if some are left.
    """
    letters = alignments.ljust(len(heads), "r")[: len(heads)]
    rule = "|".join(":---" if letter == "l" else "---:" for letter in letters)
    lines = [
        _row(heads),
        f"|{rule}|",
        *(_row([*row, *[""] * (len(heads) - len(row))]) for row in rows),
    ]
    return Markdown("\n".join(lines))


def _row(cells: Sequence[object]) -> str:
    return "| " + " | ".join(" ".join(markdown(cell).split("\n")) for cell in cells) + " |"


# -- a formula as TeX -----------------------------------------------------------------------------

_OTHER_LETTERS = {"ε": "varepsilon", "λ": "lambda", "π": "pi", "φ": "varphi"}
_GREEK = {letter: name for name, letter in GREEK.items() if letter != "ο"} | _OTHER_LETTERS
# The functions by their printed names, without the root, which has a sign; papers also write log.
_FUNCTIONS = {f.shown: f.tex for f in by_name().values() if f.name != "sqrt"} | {"log": r"\log"}
_LARGE_OPERATORS = {
    "max": r"\max ",
    "min": r"\min ",
    "lim": r"\lim ",
    "∑": r"\sum ",
    "∏": r"\prod ",
}
_TEX_SIGNS = {
    "−": "-", "\u2061": "", "\u2062": r"\,", "′": "'", "≡": r"\equiv ", "≤": r"\le ",
    "·": r"\cdot ", "±": r"\pm ", "×": r"\times ", "|": r"\vert ", "⟨": r"\langle ",
    "⟩": r"\rangle ", "ο": "o", "≥": r"\ge ", "≠": r"\ne ", "→": r"\to ", "↦": r"\mapsto ",
    "∘": r"\circ ", "∧": r"\wedge ", "∈": r"\in ", "≈": r"\approx ", "⇒": r"\Rightarrow ",
    "⇔": r"\Leftrightarrow ", "…": r"\dots ", "∂": r"\partial ", "∇": r"\nabla ",
    "∞": r"\infty ", "∑": r"\sum ", "∏": r"\prod ", "∫": r"\int ", "‖": r"\Vert ",
    "<": r"\lt ", ">": r"\gt ", "\u00a0": r"\ ", "∪": r"\cup ", "∩": r"\cap ",
    "ℓ": r"\ell ", "←": r"\leftarrow ", "∝": r"\propto ", "∮": r"\oint ", "∼": r"\sim ",
    "≢": r"\not\equiv ", "⊂": r"\subset ",
}  # fmt: skip
_ACCENTS = {"\u0304": "bar", "\u0303": "tilde", "\u0307": "dot", "\u0308": "ddot"}
_PLAIN_CHARACTER = re.compile(r"[A-Za-z0-9+\-=/().,;:! ]")
_TEX_SPECIAL_CHARACTERS = set("#%&_{}")


def tex(node: MarkupNode) -> str:
    """Return the element as TeX, without delimiters, backticks, dollar signs and pipes."""
    inner = [tex(c) for c in node.elements()]
    match node.tag, inner:
        case (("mi" | "mn" | "mtext"), _):
            return _tex_leaf(node.text)
        case "mo", _:
            return _tex_operator(node)
        case "msup", [base, upper]:
            return f"{_brace(base)}^{{{upper}}}"
        case "msub", [base, lower]:
            return f"{_brace(base)}_{{{lower}}}"
        case "munder", [_, lower]:
            return f"{_large_operator(node)}_{{{lower}}}"
        case "msubsup", [base, lower, upper]:
            return f"{_brace(base)}_{{{lower}}}^{{{upper}}}"
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
            return _tex_table(node)
    return "".join(inner)


def _tex_table(node: MarkupNode) -> str:
    entries = [row.elements() for row in node.elements()]
    lines = r" \\ ".join(" & ".join(tex(e) for e in row) for row in entries)
    # The cells of a sum in lines have a class for their alignment; the entries of a matrix do not.
    is_sum = any("class" in e.attributes for row in entries for e in row)
    name = "aligned" if is_sum else "matrix"
    return rf"\begin{{{name}}} {lines} \end{{{name}}}"


def _tex_operator(node: MarkupNode) -> str:
    if node.attributes.get("stretchy") != "false":
        if node.text == "(":
            return r"\left("
        if node.text == ")":
            return r"\right)"
    return "".join(tex_character(c) for c in node.text)


def _tex_leaf(text: str) -> str:
    if text in _FUNCTIONS:
        return f"{_FUNCTIONS[text]} "
    if fraction := re.fullmatch("([0-9]+)\N{FRACTION SLASH}([0-9]+)", normalize("NFKC", text)):
        return rf"\tfrac{{{fraction[1]}}}{{{fraction[2]}}}"
    if len(text) == 2 and text[1] in _ACCENTS:
        return rf"\{_ACCENTS[text[1]]}{{{tex_character(text[0])}}}"
    characters = "".join(tex_character(c) for c in text)
    if len(text) > 1 and not re.fullmatch(r"[0-9.]+", text):
        return rf"\mathrm{{{characters}}}"
    return characters


def tex_character(c: str) -> str:
    """Return the character as TeX within a formula; "?" if there is no sign for it."""
    if c in _GREEK:
        return f"\\{_GREEK[c]} "
    if c in _TEX_SPECIAL_CHARACTERS:
        return f"\\{c}"
    return _TEX_SIGNS.get(c, c if _PLAIN_CHARACTER.fullmatch(c) else "?")


def _brace(base: str) -> str:
    return base if len(base) == 1 else f"{{{base}}}"


def _large_operator(node: MarkupNode) -> str:
    """Return the TeX of an operator that has its limits above and below it."""
    base = node.elements()[0]
    return _LARGE_OPERATORS.get(base.text) or _brace(tex(base))


# -- within HTML ----------------------------------------------------------------------------------


def _html(node: MarkupNode | str) -> str:
    if isinstance(node, str):
        return escape(re.sub(r"[\s\x00-\x1f]+", " ", node)).replace("$", "<span>$</span>")
    if node.tag == "math":
        return _html(html_of_math(node))
    inner = "".join(_html(child) for child in node.children)
    if node.attributes.get("aria-hidden"):
        inner += " "
    if "who" in node.classes:
        inner = f"({inner})"
    tag = "b" if "badge" in node.classes else _HTML_TAGS.get(node.tag)
    return f"<{tag}>{inner}</{tag}>" if tag else inner


def html_of_math(node: MarkupNode) -> MarkupNode:
    """Return the formula with no elements but `sub` and `sup`."""
    inner = [html_of_math(c) for c in node.elements()]
    match node.tag, inner:
        case (("mi" | "mn" | "mtext"), _):
            return MarkupNode("", {}, [node.text])
        case "mo", _:
            return MarkupNode("", {}, [_SIGNS.get(node.text, node.text)])
        case "msup", [base, upper]:
            return MarkupNode("", {}, [base, MarkupNode("sup", {}, [upper])])
        case "msub", [base, lower]:
            return MarkupNode("", {}, [base, MarkupNode("sub", {}, [lower])])
        case "msubsup", [base, lower, upper]:
            return MarkupNode(
                "", {}, [base, MarkupNode("sub", {}, [lower]), MarkupNode("sup", {}, [upper])]
            )
        case "mfrac", [above, below]:
            return MarkupNode(
                "", {}, [*_bracket_unless_simple(above), "/", *_bracket_unless_simple(below)]
            )
        case "msqrt", _:
            return MarkupNode("", {}, ["√", *_bracket_unless_simple(MarkupNode("", {}, [*inner]))])
        case "mroot", [base, degree]:
            return MarkupNode(
                "", {}, [MarkupNode("sup", {}, [degree]), "√", *_bracket_unless_simple(base)]
            )
    return MarkupNode("", {}, [*inner])


def _bracket_unless_simple(node: MarkupNode) -> list[MarkupNode | str]:
    """Return the node in brackets, unless it is a name or a number."""
    return [node] if node.text.isalnum() else ["(", node, ")"]
