"""Mistakes of the field: what somebody who writes bounds, series and steps gets wrong.

A term or a factor that is left out, a square that is none, q where p is meant, a bound's other end,
an element of a list of conditions.
"""

import ast
from collections.abc import Iterator

Change = tuple[str, ast.AST, ast.AST]  # a word, the node that goes, the node that comes

_OTHER_END = {
    "upper": "lower", "lower": "upper", "abs_upper": "abs_lower", "abs_lower": "abs_upper",
    "floor": "ceil", "ceil": "floor", "ROUND_HALF_EVEN": "ROUND_DOWN", "ROUND_DOWN": "ROUND_UP",
    "ROUND_UP": "ROUND_DOWN", "ROUND_FLOOR": "ROUND_CEILING", "ROUND_CEILING": "ROUND_FLOOR",
}  # fmt: skip
_PAIRS = (
    "p q", "h_p h_q", "p_next q_next", "p0 q0", "dp dq", "at_p at_q", "kick drift", "kicks drifts",
    "h_pp h_qq", "low high", "least most", "first last", "before after", "rows columns",
)  # fmt: skip
_FOR_EACH_OTHER = {x: y for pair in _PAIRS for x, y in (pair.split(), pair.split()[::-1])}


def changes_of(node: ast.AST) -> Iterator[Change]:
    """All changes at one node."""
    match node:
        case ast.BinOp(left, op, right):
            yield from _of_operation(node, left, op, right)
        case ast.Attribute(value, name, context) if name in _OTHER_END:
            yield "rounding", node, ast.Attribute(value, _OTHER_END[name], context)
        case ast.Attribute(value, name, ast.Load() as context) if name in _FOR_EACH_OTHER:
            yield "other-of-two", node, ast.Attribute(value, _FOR_EACH_OTHER[name], context)
        case ast.Name(name, ast.Load() as context) if name in _FOR_EACH_OTHER:
            yield "other-of-two", node, ast.Name(_FOR_EACH_OTHER[name], context)
        case ast.Constant(str() as text) if text in _FOR_EACH_OTHER:
            yield "other-of-two", node, ast.Constant(_FOR_EACH_OTHER[text])
        case ast.List(elements, ast.Load() as context) if len(elements) > 1:
            for k in (0, len(elements) - 1):
                rest = [*elements[:k], *elements[k + 1 :]]
                yield "element-dropped", node, ast.List(rest, context)


def _of_operation(
    node: ast.BinOp, left: ast.expr, op: ast.operator, right: ast.expr
) -> Iterator[Change]:
    if is_text(left) or is_text(right):
        return
    match op:
        case ast.Add():
            yield "term-dropped", node, left
            yield "term-dropped", node, right
        case ast.Sub():
            yield "term-dropped", node, left
        case ast.Mult() if ast.dump(left) == ast.dump(right):
            yield "square-dropped", node, left
        case ast.Mult():
            yield "factor-dropped", node, left
            yield "factor-dropped", node, right
        case ast.Div() | ast.FloorDiv():
            yield "factor-dropped", node, left
        case ast.Pow():
            yield "square-dropped", node, left


def is_text(node: ast.expr) -> bool:
    """Whether it is a text, formatted or not: texts are put together by + and %."""
    return isinstance(node, ast.JoinedStr) or (
        isinstance(node, ast.Constant) and isinstance(node.value, str | bytes)
    )
