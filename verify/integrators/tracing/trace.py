"""A user's step applied to symbols: its operations as a graph, in which each stands once.

A `Tape` creates the symbols p, q, t and h and holds the nodes. Operations on constants are carried
out at once, exactly.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, TypeVar

import sympy

from verify.algebra.formula import function, symbol
from verify.algebra.limits import MAX_EXPONENT
from verify.integrators.tracing.named_functions import OPERATORS
from verify.integrators.tracing.traced_number import Kind, TracedNumber, UntraceableError

MOST_NODES = 20_000
_MAX_BITS = 20_000  # of the numerator and the denominator of a constant
_SYMBOLS = "symbol"
Value = TypeVar("Value")


@dataclass(frozen=True, eq=False)
class Node:
    """One operation; `value` is a number's Fraction, a power's exponent or a symbol's name.

    The same operation on the same inputs is the same object. `number`: its index on the tape.
    """

    operation: str
    inputs: tuple["Node", ...]
    value: Any
    number: int


class Tape(Kind):
    """A factory of symbols and constants that record the operations on them as nodes."""

    ordered = False

    def __init__(self) -> None:
        super().__init__()
        self.positive = False  # True if the code has relied on h > 0
        self._nodes: dict[tuple[object, ...], Node] = {}

    def symbol(self, name: str) -> "Traced":
        return Traced(self, self.node(_SYMBOLS, (), name))

    def rational(self, value: Fraction) -> "Traced":
        if max(value.numerator.bit_length(), value.denominator.bit_length()) > _MAX_BITS:
            raise UntraceableError("its numbers become too long")
        return Traced(self, self.node("number", (), value))

    def pi(self) -> "Traced":
        return Traced(self, self.node("pi", (), None))

    @property
    def nodes(self) -> Iterable[Node]:
        """All nodes, in the order in which they were recorded."""
        return self._nodes.values()

    def check(self) -> None:
        """Raise UntraceableError where code caught the error of what a symbol cannot do.

        The trace is then of what the code does where that fails.
        """
        if self.refused:
            caught = "and catches the error of a symbol that cannot"
            raise UntraceableError(f"{self.refused[0]}, {caught}")

    def node(self, operation: str, inputs: tuple[Node, ...], value: Any = None) -> Node:
        # The same operation on the same nodes is the same node, so that common subexpressions are
        # recorded once.
        key = (operation, *(x.number for x in inputs), value)
        if key not in self._nodes:
            if len(self._nodes) >= MOST_NODES:
                raise UntraceableError(f"it does more than {MOST_NODES} operations")
            self._nodes[key] = Node(operation, inputs, value, len(self._nodes))
        return self._nodes[key]


class Traced(TracedNumber):
    """A number that records what is done to it."""

    __slots__ = ("node",)
    kind: Tape

    def __init__(self, kind: Tape, node: Node) -> None:
        super().__init__(kind)
        self.node = node

    def exact_value(self) -> Fraction | None:
        return self.node.value if self.node.operation == "number" else None

    def compare(self, other: "Traced") -> int:
        """Return 1 for h > 0; nothing is known of the sign of anything else."""
        value = other.exact_value()
        is_h = (self.node.operation, self.node.value) == (_SYMBOLS, "h")
        if is_h and value is not None and value <= 0:
            self.kind.positive = True
            return 1
        self.refuse("it compares numbers")

    def combine(self, name: str, other: "Traced") -> "Traced":
        x, y = self.exact_value(), other.exact_value()
        if x is not None and y is not None:
            if name == "divide" and y == 0:
                raise ZeroDivisionError
            return self.kind.rational(OPERATORS[name](x, y))
        if y == (0 if name in ("add", "subtract") else 1):
            return self
        if name == "multiply" and x is not None and y is None:
            return other if x == 1 else other._times(x)
        if name == "multiply" and y is not None:
            return self._times(y)
        if name == "add" and x == 0:
            return other
        return Traced(self.kind, self.kind.node(name, (self.node, other.node)))

    def _times(self, x: Fraction) -> "Traced":
        """Multiply by x; the number stands first, and 0 times anything is 0."""
        number = self.kind.rational(x)
        if x == 0:
            return number
        return Traced(self.kind, self.kind.node("multiply", (number.node, self.node)))

    def apply(self, name: str) -> "Traced":
        return Traced(self.kind, self.kind.node(name, (self.node,)))

    def raise_to(self, exponent: Fraction) -> "Traced":
        if abs(exponent.numerator) > MAX_EXPONENT or exponent.denominator > MAX_EXPONENT:
            raise UntraceableError(f"it has the exponent {float(exponent):g}")
        if exponent == 0:
            return self.kind.rational(Fraction(1))
        if exponent == 1:
            return self
        value = self.exact_value()
        if value is not None and exponent.denominator == 1:
            return self.kind.rational(value ** int(exponent))
        return Traced(self.kind, self.kind.node("power", (self.node,), exponent))


def in_order(*roots: Node) -> list[Node]:
    """Return the nodes that the roots are made of, each after its inputs."""
    nodes: dict[int, Node] = {}
    pending = list(roots)
    while pending:
        node = pending.pop()
        if node.number not in nodes:
            nodes[node.number] = node
            pending += node.inputs
    # Numbers grow from inputs to results, so that they sort the nodes. A recursion would reach
    # Python's limit in long traces.
    return [nodes[number] for number in sorted(nodes)]


def evaluate_nodes(
    nodes: Iterable[Node],
    made_of: Callable[[Node, list[Any]], Value],
    prior_values: Mapping[int, Value] | None = None,
) -> dict[int, Value]:
    """Evaluate each node from its inputs' values, and return the values by the nodes' numbers.

    `prior_values`: of other nodes, from which these are computed.
    """
    values = dict(prior_values or {})
    for node in nodes:
        values[node.number] = made_of(node, [values[x.number] for x in node.inputs])
    return values


def replay_in(kind: Kind, symbols: Mapping[str, Any]) -> Callable[[Node, list[Any]], Any]:
    """Return a function that evaluates a node in numbers of that kind, from its inputs; see
    `evaluate_nodes`."""

    def replay_node(node: Node, x: list[Any]) -> Any:
        match node.operation:
            case "symbol":
                return symbols[node.value]
            case "number":
                return kind.rational(node.value)
            case "pi":
                return kind.pi()
            case "power":
                return x[0].raise_to(node.value)
            case "add" | "subtract" | "multiply" | "divide" as name:
                return x[0].combine(name, x[1])
            case name:
                return x[0].apply(name)

    return replay_node


def expressions(
    nodes: Iterable[Node],
    put: Mapping[str, sympy.Expr],
    prior_values: Mapping[int, sympy.Expr] | None = None,
) -> dict[int, sympy.Expr]:
    """Return each node as an expression, with symbols replaced as `put` says; see
    `evaluate_nodes`."""
    return evaluate_nodes(nodes, lambda node, inputs: _expression(node, inputs, put), prior_values)


def _expression(node: Node, inputs: list[Any], put: Mapping[str, sympy.Expr]) -> sympy.Expr:
    match node.operation:
        case "symbol":
            return put.get(node.value, symbol(node.value))
        case "number":
            return sympy.Rational(node.value.numerator, node.value.denominator)
        case "pi":
            return sympy.pi
        case "power":
            return inputs[0] ** sympy.Rational(node.value.numerator, node.value.denominator)
        case "add" | "subtract" | "multiply" | "divide" as name:
            return OPERATORS[name](*inputs)
        case name:
            return function(name)(inputs[0])


def sizes(nodes: Iterable[Node]) -> dict[int, int]:
    """Count the operations of each node, where nothing is written once; see `evaluate_nodes`."""
    return evaluate_nodes(nodes, lambda _, inputs: 1 + sum(inputs))


def write_expressions(
    roots: Sequence[Node], most: int, put: Mapping[str, sympy.Expr] | None = None
) -> list[sympy.Expr] | None:
    """Return the roots as expressions; None where they are more operations than that, all
    together."""
    nodes = in_order(*roots)
    size = sizes(nodes)
    if sum(size[root.number] for root in roots) > most:
        return None
    values = expressions(nodes, put or {})
    return [values[root.number] for root in roots]
