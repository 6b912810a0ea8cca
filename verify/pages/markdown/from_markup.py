"""Conversion of text and the page's markup to lines of Markdown in which foreign text stays text.

Inside a line GitHub allows a few HTML elements, which, unlike asterisks and backticks, mean the
same in a table, beside any letter and around any text.

A repository page sets no formula in a <summary>: there MathML, as `verify.pages.text.mathml` sets
it within a line, becomes indices, powers, fractions with a solidus and roots with a sign.
"""

import re
from collections.abc import Iterable, Sequence

from markupsafe import escape

from verify.pages.markdown.markup import Node, tree
from verify.pages.markdown.mathml_to_tex import tex


def html_of_math(node: Node) -> Node:
    """Return the formula with no elements but `sub` and `sup`."""
    inner = [html_of_math(c) for c in node.elements()]
    match node.tag, inner:
        case (("mi" | "mn" | "mtext"), _):
            return Node("", {}, [node.text])
        case "mo", _:
            return Node("", {}, [_SIGNS.get(node.text, node.text)])
        case "msup", [base, upper]:
            return Node("", {}, [base, Node("sup", {}, [upper])])
        case "msub", [base, lower]:
            return Node("", {}, [base, Node("sub", {}, [lower])])
        case "msubsup", [base, lower, upper]:
            return Node("", {}, [base, Node("sub", {}, [lower]), Node("sup", {}, [upper])])
        case "mfrac", [above, below]:
            return Node(
                "", {}, [*_bracket_unless_simple(above), "/", *_bracket_unless_simple(below)]
            )
        case "msqrt", _:
            return Node("", {}, ["√", *_bracket_unless_simple(Node("", {}, [*inner]))])
        case "mroot", [base, degree]:
            return Node("", {}, [Node("sup", {}, [degree]), "√", *_bracket_unless_simple(base)])
    return Node("", {}, [*inner])


# Invisible signs become spaces: function application and multiplication.
_SIGNS = {"\u2061": " ", "\u2062": " "}


def _bracket_unless_simple(node: Node) -> list[Node | str]:
    """Return the node in brackets, unless it is a name or a number."""
    return [node] if node.text.isalnum() else ["(", node, ")"]


_SPECIAL_CHARACTERS = re.compile(r"[\\`*_\[\]|~#]")
# At the start of a line these would make a list, an underline or a table's alignment.
_LINE_START = re.compile(
    r"[-+=:]|[0-9]+(?=[.)](?:\s|$))"
)  # a list, an underline, a table's alignment
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
# Classes that the page sets smaller, beside or below a number; here they are in brackets.
_ASIDES = {"bound", "beside"}
# Only links within the report are kept, so that foreign text cannot link anywhere.
_SAFE_LINK = re.compile(r"#[A-Za-z0-9_.-]+|results\.json")


class Markdown(str):
    """A text that is Markdown already."""

    __slots__ = ()


def markdown(content: object) -> Markdown:
    """Return Markdown for inside a line: Markdown unchanged, markup converted, all else as text."""
    if isinstance(content, Markdown):
        return content
    if hasattr(content, "__html__"):
        return line([tree(content.__html__())])
    return escape_markdown("" if content is None else str(content))


def escape_markdown(text: str) -> Markdown:
    """Return the text in one line, with all marks of Markdown and HTML escaped."""
    # A private character stands for no-break spaces, which \s would split at.
    line = " ".join(re.split(r"[\s\x00-\x1f]+", text.replace("\u00a0", "\ue000"))).strip()
    return Markdown(_escape_line_start(_escape_marks(line).replace("\ue000", "\u00a0")))


def line(pieces: Iterable[Node | str], *, escapes_start: bool = True) -> Markdown:
    """Return pieces of markup in one line; without `escapes_start` its first marks stay marks."""
    text = re.sub(" {2,}", " ", "".join(map(_inline, pieces)).strip(" "))
    return Markdown(_escape_line_start(text) if escapes_start else text)


def render_html(node: Node) -> Markdown:
    """Return the node's content as HTML, for a <summary>, where Markdown's marks mean nothing."""
    return Markdown(re.sub(" {2,}", " ", _html(node)).strip())


def _html(node: Node | str) -> str:
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


def _escape_line_start(line: str) -> str:
    """Escape the start of a line that would begin a list or underline a heading."""
    start = _LINE_START.match(line)
    if start is None:
        return line
    return f"{start[0]}\\{line[start.end() :]}" if start[0].isdigit() else f"\\{line}"


def _escape_marks(text: str) -> str:
    text = _SPECIAL_CHARACTERS.sub(r"\\\g<0>", text.translate(_ENTITIES))
    # GitHub would read the rest as a formula, or make a link of it.
    text = text.replace("$", "<span>$</span>").replace("://", "&#58;//")
    return re.sub(r"(?i)\bwww\.", lambda m: f"{m[0][:-1]}&#46;", text)


# -- markup ---------------------------------------------------------------------------------------


def _inline(node: Node | str) -> str:
    if isinstance(node, str):
        return _escape_marks(re.sub(r"[ \t\r\n]+", " ", node))
    if node.tag == "math":
        return _formula(node)
    if node.tag == "br":
        return "<br>"
    if node.attributes.get("class") == "digits":
        return _escape_marks(node.text)  # the groups are the style sheet's
    inner = "".join(_inline(child) for child in node.children)
    tag = "b" if "badge" in node.classes else _HTML_TAGS.get(node.tag)
    if tag:
        return f"<{tag}>{inner}</{tag}>"
    if node.tag == "a" and _SAFE_LINK.fullmatch(node.attributes.get("href", "")):
        return f"[{inner}]({node.attributes['href']})"
    if node.attributes.get("aria-hidden"):
        return f"{inner} "  # a sign, which the style sheet sets apart from what it stands before
    if _ASIDES & set(node.classes) and not inner.startswith("±"):
        return f"({inner})"
    return inner


def _formula(node: Node) -> str:
    """Return a formula between ``$` `` and `` `$``, a display as a block of its own."""
    if node.attributes.get("display") == "block":
        return f"\n\n```math\n{tex(node).strip()}\n```\n\n"
    return f"$`{tex(node).strip()}`$"


# -- blocks ---------------------------------------------------------------------------------------


def table(heads: Sequence[object], rows: Iterable[Sequence[object]], words: str = "") -> Markdown:
    """Return a table whose columns are aligned right, as numbers are.

    `words`: a letter for each of the first columns, l (left) or r (right), where they differ.
    """
    places = words.ljust(len(heads), "r")
    rule = "|".join(":---" if place == "l" else "---:" for place in places[: len(heads)])
    lines = [
        _row(heads),
        f"|{rule}|",
        *(_row([*row, *[""] * (len(heads) - len(row))]) for row in rows),
    ]
    return Markdown("\n".join(lines))


def _row(cells: Sequence[object]) -> str:
    return "| " + " | ".join(" ".join(markdown(cell).split("\n")) for cell in cells) + " |"
