"""Where what a user's code does to its arguments is defined."""

from fractions import Fraction

import sympy

from verify.algebra.domain import EVERYWHERE, Domain
from verify.algebra.formula import symbol
from verify.algebra.requirement import Requirement, of_divisor, of_function, of_power
from verify.integrators.tracing.trace import Node, Tape, written

_MOST_WRITTEN = 100  # operations of what is divided by, or of which a root is taken
_NOT_WRITTEN = "the function divides by no 0, and takes no root or logarithm of what is negative"


def domain_of(tape: Tape) -> Domain:
    """What all operations on the tape ask for, those that cancelled in the end, too."""
    found, words = list[Requirement](), list[str]()
    if tape.positive:
        found.append(Requirement(symbol("h"), ">"))
    for node in tape.nodes:
        operand = node.inputs[-1] if node.inputs else None
        if operand is None or not _asks(node):
            continue
        inside = written([operand], _MOST_WRITTEN)
        if inside is None:
            words.append(_NOT_WRITTEN)
        else:
            found += _asked(node, inside[0])
    return Domain.of(found, *words) if found or words else EVERYWHERE


def _asks(node: Node) -> bool:
    power = node.operation == "power" and (node.value < 0 or node.value.denominator > 1)
    return power or node.operation in ("divide", "log", "tan", "sqrt")


def _asked(node: Node, operand: sympy.Expr) -> list[Requirement]:
    """Of a smooth map: no root is taken of 0."""
    match node.operation:
        case "divide":
            return of_divisor(operand)
        case "power" | "sqrt":
            exponent = sympy.Rational(node.value or Fraction(1, 2))
            asked = of_power(operand, exponent)
            return [Requirement(r.expression, ">") if exponent.q > 1 else r for r in asked]
        case name:
            return of_function(name, operand)
