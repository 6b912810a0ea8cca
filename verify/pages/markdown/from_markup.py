"""Text and the page's markup → GitHub flavoured Markdown in which what others wrote stays text.

Inside a line GitHub allows a few HTML elements, which, unlike asterisks and backticks, mean the
same in a table, beside any letter and around any text.

MathML, as `verify.pages.text.mathml` sets it within a line → elements that a <summary> may hold.

A repository page sets no formula there. Indices and powers are set as such, a fraction with a
solidus, a root with its sign.
"""

import re
from collections.abc import Iterable, Sequence

from markupsafe import escape

from verify.pages.markdown.markup import Node, tree
from verify.pages.markdown.mathml_to_tex import tex


def html_of_math(node: Node) -> Node:
    """The formula with no element but `sub` and `sup`."""
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
            return Node("", {}, [*_closed(above), "/", *_closed(below)])
        case "msqrt", _:
            return Node("", {}, ["√", *_closed(Node("", {}, [*inner]))])
        case "mroot", [base, degree]:
            return Node("", {}, [Node("sup", {}, [degree]), "√", *_closed(base)])
    return Node("", {}, [*inner])


_SIGNS = {"\u2061": " ", "\u2062": " "}  # what is applied or multiplied


def _closed(node: Node) -> list[Node | str]:
    """In brackets where it is more than a name or a number."""
    return [node] if node.text.isalnum() else ["(", node, ")"]


_MARKS = re.compile(r"[\\`*_\[\]|~#]")
_AT_THE_START = re.compile(
    r"[-+=:]|[0-9]+(?=[.)](?:\s|$))"
)  # a list, an underline, a table's alignment
_ENTITIES = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;"})
_KEPT = {"sub": "sub", "sup": "sup", "b": "b", "strong": "b", "em": "i", "i": "i", "code": "code"}
_ASIDES = {"bound", "beside"}  # what the page sets smaller beside or below a number
_SAFE_LINK = re.compile(r"#[A-Za-z0-9_.-]+|results\.json")


class Markdown(str):
    """Text that is Markdown already."""

    __slots__ = ()


def markdown(found: object) -> Markdown:
    """Anything as Markdown inside a line: Markdown as it is, markup set anew, all else as text."""
    if isinstance(found, Markdown):
        return found
    if hasattr(found, "__html__"):
        return line([tree(found.__html__())])
    return escaped("" if found is None else str(found))


def escaped(text: str) -> Markdown:
    """The text in one line, with no character that means anything to Markdown or to HTML."""
    line = " ".join(re.split(r"[\s\x00-\x1f]+", text.replace("\u00a0", "\ue000"))).strip()
    return Markdown(_started(_quoted(line).replace("\ue000", "\u00a0")))


def line(found: Iterable[Node | str], *, started: bool = True) -> Markdown:
    """Pieces of markup in one line; one that is not `started` begins with its own marks."""
    text = re.sub(" {2,}", " ", "".join(map(_inline, found)).strip(" "))
    return Markdown(_started(text) if started else text)


def in_html(node: Node) -> Markdown:
    """What stands in it as HTML, for a <summary>, in which Markdown's marks mean nothing."""
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
    kept = "b" if "badge" in node.classes else _KEPT.get(node.tag)
    return f"<{kept}>{inner}</{kept}>" if kept else inner


def _started(line: str) -> str:
    """A line that starts no list and underlines no heading."""
    start = _AT_THE_START.match(line)
    if start is None:
        return line
    return f"{start[0]}\\{line[start.end() :]}" if start[0].isdigit() else f"\\{line}"


def _quoted(text: str) -> str:
    text = _MARKS.sub(r"\\\g<0>", text.translate(_ENTITIES))
    # GitHub would read the rest as a formula, or make a link of it.
    text = text.replace("$", "<span>$</span>").replace("://", "&#58;//")
    return re.sub(r"(?i)\bwww\.", lambda m: f"{m[0][:-1]}&#46;", text)


# -- markup ---------------------------------------------------------------------------------------


def _inline(node: Node | str) -> str:
    if isinstance(node, str):
        return _quoted(re.sub(r"[ \t\r\n]+", " ", node))
    if node.tag == "math":
        return _formula(node)
    if node.tag == "br":
        return "<br>"
    if node.attributes.get("class") == "digits":
        return _quoted(node.text)  # the groups are the style sheet's
    inner = "".join(_inline(child) for child in node.children)
    kept = "b" if "badge" in node.classes else _KEPT.get(node.tag)
    if kept:
        return f"<{kept}>{inner}</{kept}>"
    if node.tag == "a" and _SAFE_LINK.fullmatch(node.attributes.get("href", "")):
        return f"[{inner}]({node.attributes['href']})"
    if node.attributes.get("aria-hidden"):
        return f"{inner} "  # a sign, which the style sheet sets apart from what it stands before
    if _ASIDES & set(node.classes) and not inner.startswith("±"):
        return f"({inner})"
    return inner


def _formula(node: Node) -> str:
    """Between ``$` `` and `` `$``, where Markdown's own marks mean nothing; a display by itself."""
    if node.attributes.get("display") == "block":
        return f"\n\n```math\n{tex(node).strip()}\n```\n\n"
    return f"$`{tex(node).strip()}`$"


# -- blocks ---------------------------------------------------------------------------------------


def table(heads: Sequence[object], rows: Iterable[Sequence[object]], words: str = "") -> Markdown:
    """A table whose columns are numbers, aligned right; `words`: a letter for each column, where
    they are not: l (left) or r (right)."""
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
