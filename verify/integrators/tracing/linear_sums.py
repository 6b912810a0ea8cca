"""Traced nodes as linear sums: coefficients that are polynomials in h and in constants.

- A coefficient is a dictionary {monomial: number}.
- A monomial is a tuple ((node's number, power), …) of nodes that depend on neither p nor q.
- A sum is a dictionary {leaf: coefficient}. A leaf is the number of a node that is neither a sum
  nor a multiple; `ONE` is the leaf of a constant term.
"""

import operator
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, TypeVar

import sympy

from verify.integrators.tracing.trace import Node, evaluate_nodes, expressions

ONE = -1
T = TypeVar("T")
Monomial = tuple[tuple[int, int], ...]
Scalar = dict[Monomial, Fraction]
Linear = dict[Any, Scalar]
_MAX_TERMS = 400  # of a coefficient; a node with more is taken as a leaf


def _merge(x: dict[Any, T], y: dict[Any, T], plus: Callable[[T, T], T], zero: T) -> dict[Any, T]:
    """Add the values of the two under each key, and drop sums that are 0."""
    total = dict(x)
    for key, value in y.items():
        total[key] = plus(total.get(key, zero), value)
    return {key: value for key, value in total.items() if value}


def add(x: Linear, y: Linear) -> Linear:
    return _merge(x, y, _sum, {})


def scale(x: Linear, factor: Scalar) -> Linear:
    products = {leaf: product(c, factor) for leaf, c in x.items()}
    return {leaf: c for leaf, c in products.items() if c}


def _sum(x: Scalar, y: Scalar) -> Scalar:
    return _merge(x, y, operator.add, Fraction(0))


def product(x: Scalar, y: Scalar) -> Scalar:
    total: Scalar = {}
    for one, a in x.items():
        for two, b in y.items():
            powers = dict(one)
            for number, n in two:
                powers[number] = powers.get(number, 0) + n
            monomial = tuple(sorted((k, n) for k, n in powers.items() if n))
            total[monomial] = total.get(monomial, Fraction(0)) + a * b
    return {monomial: value for monomial, value in total.items() if value}


class Scalars:
    """A reader of the nodes of one trace.

    `moving`: the numbers of the nodes that depend on p or q.
    """

    one: Scalar = {(): Fraction(1)}  # noqa: RUF012 - never changed

    def __init__(self, nodes: Sequence[Node]) -> None:
        self.nodes = {node.number: node for node in nodes}
        self.symbols = {n.value: n.number for n in nodes if n.operation == "symbol"}
        self.moving: set[int] = set()
        for node in nodes:
            is_coordinate = node.operation == "symbol" and node.value in ("p", "q")
            if is_coordinate or any(x.number in self.moving for x in node.inputs):
                self.moving.add(node.number)
        still = [node for node in nodes if node.number not in self.moving]
        self._written = expressions(still, {})
        self._scalar = evaluate_nodes(still, self._as_scalar)
        self._linear: dict[int, Linear] = {}
        for node in nodes:
            self._linear[node.number] = self._as_linear(node)

    def leaf(self, number: int) -> Node:
        """Return the node of a leaf; for `ONE`, a node that is the number 1."""
        return self.nodes[number] if number != ONE else Node("number", (), Fraction(1), ONE)

    def linear(self, node: Node) -> Linear:
        return self._linear[node.number] if node.number != ONE else {ONE: self.one}

    def clock(self, node: Node) -> tuple[Fraction, Fraction] | None:
        """Return a and c if the node is a (t + c h) with a ≠ 0; None otherwise."""
        terms = self._scalar.get(node.number, {})
        # A clock is linear in t and h alone: any other monomial ends the search.
        named = {(("t", 1),): Fraction(0), (("h", 1),): Fraction(0)}
        for monomial, value in terms.items():
            key = tuple((self.nodes[number].value, power) for number, power in monomial)
            if key not in named:
                return None
            named[key] = value
        a, b = named.values()
        return (a, b / a) if a else None

    def sum(self, terms: Sequence[tuple[Scalar, Node]]) -> Linear:
        total: Linear = {}
        for coefficient, node in terms:
            total = add(total, scale(self.linear(node), coefficient))
        return total

    def parts(self, node: Node) -> list[tuple[Scalar, Node]]:
        """Return the parts of a sum or a multiple; an empty list for another node."""
        minus: Scalar = {(): Fraction(-1)}
        match node.operation:
            case "add" | "subtract":
                sign = self.one if node.operation == "add" else minus
                return [(self.one, node.inputs[0]), (sign, node.inputs[1])]
            case "multiply":
                for x, y in (node.inputs, node.inputs[::-1]):
                    if x.number not in self.moving:
                        return [(self._scalar[x.number], y)]
            case "divide" if node.inputs[1].number not in self.moving:
                inverse = _inverse(self._scalar[node.inputs[1].number])
                return [] if inverse is None else [(inverse, node.inputs[0])]
        return []

    def expression(self, x: Scalar) -> sympy.Expr:
        terms = [
            sympy.Rational(value.numerator, value.denominator)
            * sympy.Mul(*(self._written[number] ** n for number, n in monomial))
            for monomial, value in x.items()
        ]
        return sympy.Add(*terms)

    def _as_scalar(self, node: Node, x: Sequence[Scalar]) -> Scalar:
        scalar: Scalar | None = None
        match node.operation:
            case "number":
                return {(): node.value} if node.value else {}
            case "add":
                scalar = _sum(*x)
            case "subtract":
                scalar = _sum(x[0], product(x[1], {(): Fraction(-1)}))
            case "multiply":
                scalar = product(*x)
            case "divide":
                inverse = _inverse(x[1])
                scalar = None if inverse is None else product(x[0], inverse)
            case "power" if node.value.denominator == 1 and node.value > 0:
                scalar = self.one
                for _ in range(int(node.value)):
                    scalar = product(scalar, x[0])
        # A polynomial of too many terms is replaced by its node as one more symbol. Equal
        # polynomials may then look different, so that a shear may be missed, but none is invented.
        short = scalar is not None and len(scalar) <= _MAX_TERMS
        return scalar if scalar is not None and short else {((node.number, 1),): Fraction(1)}

    def _as_linear(self, node: Node) -> Linear:
        if node.number not in self.moving:
            constant = self._scalar[node.number]
            return {ONE: constant} if constant else {}
        parts = self.parts(node)
        return self.sum(parts) if parts else {node.number: self.one}


def _inverse(x: Scalar) -> Scalar | None:
    """Return 1/x of a single term; None of a sum."""
    if len(x) != 1:
        return None
    ((monomial, value),) = x.items()
    return {tuple((number, -n) for number, n in monomial): 1 / value}
