"""What a user's step does to symbols: its operations as a graph, each written once.

`Tape` makes the symbols p, q, h and holds the nodes; numbers are folded as they come, exactly.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, TypeVar

import sympy

from verify.algebra.formula import function, symbol
from verify.algebra.limits import MAX_EXPONENT
from verify.integrators.tracing.number import OPERATORS, Kind, TracedNumber, UntraceableError

MOST_NODES = 20_000
_MOST_BITS = 20_000  # of a folded number
_SYMBOLS = "symbol"
Made = TypeVar("Made")


@dataclass(frozen=True, eq=False)
class Node:
    """One operation; `value` is a number's Fraction, a power's exponent or a symbol's name.

    Nodes are written once, so that the same operation is the same object. `number` says which.
    """

    operation: str
    inputs: tuple["Node", ...]
    value: Any
    number: int


class Tape(Kind):
    """Makes nodes, and the numbers that record."""

    ordered = False

    def __init__(self) -> None:
        super().__init__()
        self.positive = False  # whether it was asked for the sign of h
        self._nodes: dict[tuple[object, ...], Node] = {}

    def symbol(self, name: str) -> "Traced":
        return Traced(self, self.node(_SYMBOLS, (), name))

    def rational(self, value: Fraction) -> "Traced":
        if max(value.numerator.bit_length(), value.denominator.bit_length()) > _MOST_BITS:
            raise UntraceableError("its numbers become too long")
        return Traced(self, self.node("number", (), value))

    def pi(self) -> "Traced":
        return Traced(self, self.node("pi", (), None))

    @property
    def nodes(self) -> Iterable[Node]:
        """All that were made, in their order."""
        return self._nodes.values()

    def check(self) -> None:
        """UntraceableError where code caught the error of what a symbol cannot.

        What is traced is then what it does where that fails.
        """
        if self.refused:
            caught = "and catches the error of a symbol that cannot"
            raise UntraceableError(f"{self.refused[0]}, {caught}")

    def node(self, operation: str, inputs: tuple[Node, ...], value: Any = None) -> Node:
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

    def known(self) -> Fraction | None:
        return self.node.value if self.node.operation == "number" else None

    def compared(self, other: "Traced") -> int:
        """h > 0, and nothing is known of the sign of anything else."""
        known = other.known()
        is_h = (self.node.operation, self.node.value) == (_SYMBOLS, "h")
        if is_h and known is not None and known <= 0:
            self.kind.positive = True
            return 1
        self.refuse("it compares numbers")

    def combined(self, name: str, other: "Traced") -> "Traced":
        x, y = self.known(), other.known()
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
        """The number stands first, and 0 times anything is 0."""
        number = self.kind.rational(x)
        if x == 0:
            return number
        return Traced(self.kind, self.kind.node("multiply", (number.node, self.node)))

    def applied(self, name: str) -> "Traced":
        return Traced(self.kind, self.kind.node(name, (self.node,)))

    def raised(self, exponent: Fraction) -> "Traced":
        if abs(exponent.numerator) > MAX_EXPONENT or exponent.denominator > MAX_EXPONENT:
            raise UntraceableError(f"it has the exponent {float(exponent):g}")
        if exponent == 0:
            return self.kind.rational(Fraction(1))
        if exponent == 1:
            return self
        known = self.known()
        if known is not None and exponent.denominator == 1:
            return self.kind.rational(known ** int(exponent))
        return Traced(self.kind, self.kind.node("power", (self.node,), exponent))


def in_order(*roots: Node) -> list[Node]:
    """The nodes that the roots are made of, each after its inputs."""
    seen: dict[int, Node] = {}
    waiting = list(roots)
    while waiting:
        node = waiting.pop()
        if node.number not in seen:
            seen[node.number] = node
            waiting += node.inputs
    return [seen[number] for number in sorted(seen)]


def through(
    nodes: Iterable[Node],
    made_of: Callable[[Node, list[Any]], Made],
    known: Mapping[int, Made] | None = None,
) -> dict[int, Made]:
    """What is made of each node, from what was made of its inputs, by the nodes' numbers.

    `known`: of other nodes, of which these are made.
    """
    made = dict(known or {})
    for node in nodes:
        made[node.number] = made_of(node, [made[x.number] for x in node.inputs])
    return made


def replayed(kind: Kind, symbols: Mapping[str, Any]) -> Callable[[Node, list[Any]], Any]:
    """What makes a node again in numbers of that kind, from its inputs; see `through`."""

    def made(node: Node, x: list[Any]) -> Any:
        match node.operation:
            case "symbol":
                return symbols[node.value]
            case "number":
                return kind.rational(node.value)
            case "pi":
                return kind.pi()
            case "power":
                return x[0].raised(node.value)
            case "add" | "subtract" | "multiply" | "divide" as name:
                return x[0].combined(name, x[1])
            case name:
                return x[0].applied(name)

    return made


def expressions(
    nodes: Iterable[Node],
    put: Mapping[str, sympy.Expr],
    known: Mapping[int, sympy.Expr] | None = None,
) -> dict[int, sympy.Expr]:
    """Each node as an expression, with symbols replaced by what is put for them; see `through`."""
    return through(nodes, lambda node, inputs: _expression(node, inputs, put), known)


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
    """How many operations each node is, where nothing is written once; see `through`."""
    return through(nodes, lambda _, inputs: 1 + sum(inputs))


def written(
    roots: Sequence[Node], most: int, put: Mapping[str, sympy.Expr] | None = None
) -> list[sympy.Expr] | None:
    """The roots as expressions; None where they are more operations than that, all together."""
    nodes = in_order(*roots)
    size = sizes(nodes)
    if sum(size[root.number] for root in roots) > most:
        return None
    made = expressions(nodes, put or {})
    return [made[root.number] for root in roots]
