"""The requirements for an operation to be defined, taken from a formula as it is written.

sympy simplifies as it builds: √q·√q becomes q and δ²/δ becomes δ, which loses their requirements.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

from verify.algebra.expressions.functions_used import function_of
from verify.algebra.expressions.monomials import monomials_of
from verify.functions import by_name
from verify.late import sympy

Relation = Literal["!=", ">=", ">"]


class Requirement(NamedTuple):
    """The requirement that `expression` is ≠ 0, ≥ 0 or > 0."""

    expression: sympy.Expr
    relation: Relation


def requirements_of_power(base: sympy.Expr, exponent: sympy.Rational) -> list[Requirement]:
    """Return the requirements of base^exponent: no negative base of a root, no divisor 0."""
    if exponent.q == 1:
        return requirements_of_divisor(base) if exponent < 0 else []
    return [] if base.is_number else [Requirement(base, ">" if exponent < 0 else ">=")]


def requirements_of_divisor(divisor: sympy.Expr) -> list[Requirement]:
    """Return the requirements of a division: the divisor is not 0."""
    return [] if divisor.is_number else [Requirement(divisor, "!=")]


def requirements_of_function(name: str, argument: sympy.Expr) -> list[Requirement]:
    """Return the requirements of the function of that name on its argument."""
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
    """Return the requirements of an expression as it stands.

    `smooth`: also those for it to be smooth, as a root is not at 0.
    """
    requirements: list[Requirement] = []
    if monomials_of(expression) is not None:
        return requirements
    for node in sympy.preorder_traversal(expression):
        if node.is_Pow and node.exp.is_Rational:
            # At u = 0 a root is defined and has no derivative, so smoothness needs u > 0.
            for expected in requirements_of_power(node.base, node.exp):
                root = smooth and expected.relation == ">="
                requirements.append(Requirement(expected.expression, ">") if root else expected)
        elif node.is_Pow and not node.base.is_number:  # exp(x·log(y)), as sympy writes it
            requirements.append(Requirement(node.base, ">"))
        elif node.args and (function := function_of(node)):
            requirements += requirements_of_function(function.name, node.args[0])
    return requirements
