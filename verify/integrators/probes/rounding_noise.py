"""How far a user's floats may be from what a trace of his step has, by their rounding alone."""

import math
from collections.abc import Sequence

import gmpy2

from verify.integrators.tracing.dual import SLOPES
from verify.integrators.tracing.trace import Node, through

_EPSILON = 2.0**-52
Rounded = tuple[float, float]  # a value, and a bound of its error to first order


def rounding_noise(nodes: Sequence[Node], start: dict[str, float]) -> dict[int, float]:
    """A bound of each node's error where each operation is rounded, by the nodes' numbers.

    `start`: the coordinates, h and t by name. Raises ArithmeticError or ValueError where floats do
    not reach.
    """

    def rounded(node: Node, x: list[Rounded]) -> Rounded:
        value, inherited = _made(node, x, start)
        if not math.isfinite(value):
            raise OverflowError
        own = 0.0 if node.operation == "symbol" else 4 * _EPSILON * abs(value)
        return value, inherited + own

    return {number: error for number, (_, error) in through(nodes, rounded).items()}


def _made(node: Node, x: list[Rounded], start: dict[str, float]) -> Rounded:
    """Its value, and the error that its inputs' errors make."""
    match node.operation:
        case "symbol":
            return start[node.value], 0.0
        case "number":
            return float(node.value), 0.0
        case "pi":
            return math.pi, 0.0
        case "power":
            (a, e), n = x[0], float(node.value)
            value = float(a**n)
            # x·x·…, by which whole powers may be made, is rounded n times.
            return value, abs(n * a ** (n - 1)) * e + abs(n * value) * _EPSILON
        case "add" | "subtract" as name:
            (a, e), (b, f) = x
            return a + b if name == "add" else a - b, e + f
        case "multiply":
            (a, e), (b, f) = x
            return a * b, abs(a) * f + abs(b) * e
        case "divide":
            (a, e), (b, f) = x
            return a / b, (e + abs(a / b) * f) / abs(b)
        case name:
            a, e = x[0]
            value = getattr(math, name)(a)
            slope = SLOPES[name](gmpy2.mpfr(a), gmpy2.mpfr(value))
            return value, abs(float(slope)) * e
