"""The functions and powers in expressions, innermost first."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

from verify.functions import by_name
from verify.functions.function import CIRCLE, Function
from verify.late import sympy


def function_of(node: sympy.Expr) -> Function | None:
    """Return the function that the node applies, exp for the number e; None where it is none."""
    return by_name().get("exp" if node is sympy.E else type(node).__name__)


def is_trigonometric(node: sympy.Expr) -> bool:
    """Return True if the node is sin, cos or tan of something, a periodic function."""
    function = function_of(node)
    return function is not None and function.pair is CIRCLE


def waves_in(expression: sympy.Expr) -> set[sympy.Expr]:
    """Return all sines, cosines and tangents in the expression."""
    return {node for node in sympy.preorder_traversal(expression) if is_trigonometric(node)}


def subexpressions(expressions: Sequence[sympy.Expr]) -> set[sympy.Expr]:
    """Return all subexpressions, each once: a composition has the same ones in many places."""
    visited: set[sympy.Expr] = set()
    stack = list(expressions)
    while stack:
        node = stack.pop()
        if node not in visited:
            visited.add(node)
            stack += node.args
    return visited


def levels_of(nodes: set[sympy.Expr]) -> list[list[sympy.Expr]]:
    """Return the function applications among the nodes by depth of nesting, innermost first."""
    depth: dict[sympy.Expr, int] = {}

    @cache
    def visit(node: sympy.Expr) -> int:
        inner = max((visit(a) for a in node.args), default=0)
        if is_exponential_power(node):
            inner = visit(sympy.log(node.base)) + 1
            depth[node] = inner
        elif function_of(node) is not None:
            inner += 1
            depth[node] = inner
        return inner

    for node in nodes:
        # sympy's own test for exp is slow; a polynomial needs none.
        if not (node.is_Symbol or node.is_Rational or node.is_Add or node.is_Mul):
            visit(node)
    top = max(depth.values(), default=0)
    return [
        sorted((e for e, d in depth.items() if d == level), key=sympy.default_sort_key)
        for level in range(1, top + 1)
    ]


def is_exponential_power(node: sympy.Expr) -> bool:
    """Return True if the node is u**v, sympy's form of exp(v log u), with v no rational number."""
    return bool(node.is_Pow and not isinstance(node, sympy.exp) and not node.exp.is_Rational)


def is_natural(exponent: sympy.Expr) -> bool:
    return bool(exponent.is_Integer and exponent.p >= 0)
