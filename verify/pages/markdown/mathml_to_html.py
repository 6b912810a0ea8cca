"""MathML, as `verify.pages.text.mathml` sets it within a line → elements that a <summary> may hold.

A repository page sets no formula there. Indices and powers are set as such, a fraction with a
solidus, a root with its sign.
"""

from verify.pages.markdown.markup import Node


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
