"""The functions and powers in expressions, and the requirements for them to be defined.

Requirements are those of a formula as it is written. sympy simplifies when it builds an expression:
√q·√q becomes q and δ²/δ becomes δ, and their requirements would be lost.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from typing import Literal, NamedTuple

from verify.algebra.expressions.monomials import monomials_of
from verify.functions import by_name
from verify.functions.function import CIRCLE, Function
from verify.lazy_sympy import sympy


def function_of(node: sympy.Expr) -> Function | None:
    """Return the function that the node applies, exp for the number e; None for other nodes."""
    return by_name().get("exp" if node is sympy.E else type(node).__name__)


def is_trigonometric(node: sympy.Expr) -> bool:
    """Return True if the node is a sin, cos or tan."""
    function = function_of(node)
    return function is not None and function.pair is CIRCLE


def waves_in(expression: sympy.Expr) -> set[sympy.Expr]:
    """Return all sines, cosines and tangents in the expression."""
    return {node for node in sympy.preorder_traversal(expression) if is_trigonometric(node)}


def subexpressions(expressions: Sequence[sympy.Expr]) -> set[sympy.Expr]:
    """Return the set of all subexpressions; each is visited once, since many occur often."""
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
        # sympy's test for exp is slow; a polynomial needs none.
        if not (node.is_Symbol or node.is_Rational or node.is_Add or node.is_Mul):
            visit(node)
    deepest = max(depth.values(), default=0)
    return [
        sorted((e for e, d in depth.items() if d == level), key=sympy.default_sort_key)
        for level in range(1, deepest + 1)
    ]


def is_exponential_power(node: sympy.Expr) -> bool:
    """Return True if the node is u**v, sympy's form of exp(v log u), and v is not rational."""
    return bool(node.is_Pow and not isinstance(node, sympy.exp) and not node.exp.is_Rational)


def is_natural(exponent: sympy.Expr) -> bool:
    return bool(exponent.is_Integer and exponent.p >= 0)


def root_degrees(powers: set[sympy.Pow]) -> dict[sympy.Expr, int]:
    """Return {base: degree}: every root of the base is a power of its root of that degree."""
    degrees: dict[sympy.Expr, int] = {}
    for power in powers:
        if power.exp.is_Rational:
            degrees[power.base] = math.lcm(degrees.get(power.base, 1), int(power.exp.q))
    return degrees


def argument_of(function: sympy.Expr) -> sympy.Expr:
    """Return the argument of a function application; v log u for u**v, which is exp(v log u)."""
    if is_exponential_power(function):
        return function.exp * sympy.log(function.base)
    return function.args[0] if function.args else sympy.S.One  # e is exp(1)


def applied_function(node: sympy.Expr) -> Function:
    """Return the function that the node applies; exp for u**v."""
    function = by_name()["exp"] if node.is_Pow else function_of(node)
    assert function is not None  # noqa: S101 - the nodes are those of `levels_of`
    return function


# -- requirements ---------------------------------------------------------------------------------

Relation = Literal["!=", ">=", ">"]


class Requirement(NamedTuple):
    """The requirement that `expression` is ≠ 0, ≥ 0 or > 0."""

    expression: sympy.Expr
    relation: Relation


def requirements_of_power(base: sympy.Expr, exponent: sympy.Rational) -> list[Requirement]:
    """Return the requirements of base^exponent: a root's base is ≥ 0, a divisor ≠ 0."""
    if exponent.q == 1:
        return requirements_of_divisor(base) if exponent < 0 else []
    return [] if base.is_number else [Requirement(base, ">" if exponent < 0 else ">=")]


def requirements_of_divisor(divisor: sympy.Expr) -> list[Requirement]:
    """Return the requirements of a division: the divisor is not 0."""
    return [] if divisor.is_number else [Requirement(divisor, "!=")]


def requirements_of_function(name: str, argument: sympy.Expr) -> list[Requirement]:
    """Return the requirements of a function's argument."""
    domain = by_name()[name].domain
    if argument.is_number or domain is None:
        return []
    inside = domain.inside(argument)
    if domain.through:
        inside = getattr(sympy, domain.through)(inside)
    return [Requirement(inside, domain.relation)]


def requirements_of_expression(
    expression: sympy.Expr, *, smooth: bool = False
) -> list[Requirement]:
    """Return the requirements for an expression to be defined, as it stands.

    `smooth`: for it to be smooth, too: a root is not smooth at 0.
    """
    requirements: list[Requirement] = []
    if monomials_of(expression) is not None:
        return requirements
    for node in sympy.preorder_traversal(expression):
        if node.is_Pow and node.exp.is_Rational:
            # At u = 0 a root is defined but has no derivative, so smoothness needs u > 0.
            for r in requirements_of_power(node.base, node.exp):
                root = smooth and r.relation == ">="
                requirements.append(Requirement(r.expression, ">") if root else r)
        elif node.is_Pow and not node.base.is_number:  # sympy's form of exp(x·log(y))
            requirements.append(Requirement(node.base, ">"))
        elif node.args and (function := function_of(node)):
            requirements += requirements_of_function(function.name, node.args[0])
    return requirements
