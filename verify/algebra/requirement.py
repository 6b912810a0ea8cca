"""What an operation asks of its operand to be defined, as it is written.

sympy simplifies as it builds: √q·√q becomes q, δ²/δ becomes δ, and what they ask for would be lost.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

from verify.algebra.expressions.functions_used import function_of
from verify.algebra.expressions.monomials import monomials_of
from verify.functions import by_name
from verify.late import sympy

Relation = Literal["!=", ">=", ">"]


class Requirement(NamedTuple):
    """`expression` ≠ 0, ≥ 0 or > 0."""

    expression: sympy.Expr
    relation: Relation


def of_power(base: sympy.Expr, exponent: sympy.Rational) -> list[Requirement]:
    """What base^exponent asks for: a root's base is not negative, nor any divisor 0."""
    if exponent.q == 1:
        return of_divisor(base) if exponent < 0 else []
    return [] if base.is_number else [Requirement(base, ">" if exponent < 0 else ">=")]


def of_divisor(divisor: sympy.Expr) -> list[Requirement]:
    """What a division by it asks for."""
    return [] if divisor.is_number else [Requirement(divisor, "!=")]


def of_function(name: str, argument: sympy.Expr) -> list[Requirement]:
    """What the function of that name asks of its argument."""
    domain = by_name()[name].domain
    if argument.is_number or domain is None:
        return []
    inside = domain.inside(argument)
    if domain.through:
        inside = getattr(sympy, domain.through)(inside)
    return [Requirement(inside, domain.relation)]


def of_expression(expression: sympy.Expr, *, smooth: bool = False) -> list[Requirement]:
    """What an expression asks for as it stands; `smooth`: also to be smooth, as no root is at 0."""
    found: list[Requirement] = []
    if monomials_of(expression) is not None:
        return found
    for node in sympy.preorder_traversal(expression):
        if node.is_Pow and node.exp.is_Rational:
            for expected in of_power(node.base, node.exp):
                root = smooth and expected.relation == ">="
                found.append(Requirement(expected.expression, ">") if root else expected)
        elif node.is_Pow and not node.base.is_number:  # exp(x·log(y)), as sympy writes it
            found.append(Requirement(node.base, ">"))
        elif node.args and (function := function_of(node)):
            found += of_function(function.name, node.args[0])
    return found
