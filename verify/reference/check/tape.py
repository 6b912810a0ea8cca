"""A formula as a list of operations, and its derivatives as further operations of the list.

It serves to recompute reference data, and shares no code with the rest of `verify`: the formula is
read from Python's syntax tree, and derivatives are taken operation by operation. Equal operations
are one node. sympy would read and differentiate in fewer lines, but the data are made with it: an
error of sympy is to show here.
"""

import ast
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

Node = tuple[Any, ...]  # (kind, operands …); operands are indices of earlier nodes
PAIRS = {"sin": "cos", "cos": "sin", "sinh": "cosh", "cosh": "sinh"}
# A list of its own, like all else here: it must not depend on the code that made the data.
_FUNCTIONS = ("sin", "cos", "tan", "exp", "log", "sqrt", "sinh", "cosh", "tanh", "atan", "asinh")


class NotReadError(ValueError):
    """A formula contains something that this module does not support."""


class FormulaTape:
    """Operations in p, q and t, or in other `variables`; each node comes after its operands.

    Kinds: const, pi, the variables' names, add, mul, scale (by a Fraction), power (to a Fraction),
    sin, cos, exp, log, sinh, cosh, atan (with 1 + u² as second operand). sin and cos of a node
    come together, and so do sinh and cosh.
    """

    def __init__(
        self, parameters: Mapping[str, Fraction], variables: Sequence[str] = ("p", "q", "t")
    ) -> None:
        self.parameters, self.variables = parameters, tuple(variables)
        self.nodes: list[Node] = []
        self._index_of: dict[Node, int] = {}
        self._derived: dict[tuple[int, str], int] = {}

    # -- building -------------------------------------------------------------------------------

    def node(self, *content: Any) -> int:
        """Return the node of that kind and those operands, created if it is new."""
        if content not in self._index_of:
            self._index_of[content] = len(self.nodes)
            self.nodes.append(content)
        return self._index_of[content]

    def const(self, value: Fraction | int) -> int:
        """Return the node of a rational."""
        return self.node("const", Fraction(value))

    def value(self, x: int) -> Fraction | None:
        """Return the rational that a node is, or None."""
        kind, *operands = self.nodes[x]
        return operands[0] if kind == "const" else None

    def add(self, x: int, y: int) -> int:
        """Return x + y."""
        a, b = self.value(x), self.value(y)
        if a is not None and b is not None:
            return self.const(a + b)
        if a == 0 or b == 0:
            return y if a == 0 else x
        return self.node("add", *sorted((x, y)))

    def scale(self, factor: Fraction | int, x: int) -> int:
        """Return factor · x."""
        kind, *operands = self.nodes[x]
        if kind == "const":
            return self.const(factor * operands[0])
        if kind == "scale":
            return self.scale(factor * operands[0], operands[1])
        if factor == 0:
            return self.const(0)
        return x if factor == 1 else self.node("scale", Fraction(factor), x)

    def mul(self, x: int, y: int) -> int:
        """Return x y."""
        for factor, cofactor in ((x, y), (y, x)):
            kind, *operands = self.nodes[factor]
            if kind == "const":
                return self.scale(operands[0], cofactor)
            if kind == "scale":
                return self.scale(operands[0], self.mul(operands[1], cofactor))
        return self.node("mul", *sorted((x, y)))

    def power(self, x: int, exponent: Fraction) -> int:
        """Return x^exponent; whole positive powers are products."""
        a = self.value(x)
        if exponent == 1:
            return x
        if a is not None and exponent.denominator == 1:
            return self.const(a ** int(exponent))
        if exponent.denominator == 1 and exponent >= 0:
            half = self.power(x, exponent // 2 + Fraction(0)) if exponent > 1 else self.const(1)
            square = self.mul(half, half)
            return self.mul(square, x) if exponent % 2 else square
        return self.node("power", Fraction(exponent), x)

    def function(self, name: str, x: int) -> int:
        """Return the node of a function of x, by its name in formulas.

        tan and tanh are quotients, a root is a power, and asinh x is log(x + √(1 + x²)).
        """
        if name in ("tan", "tanh"):
            numerator, denominator = ("sin", "cos") if name == "tan" else ("sinh", "cosh")
            inverse = self.power(self.function(denominator, x), Fraction(-1))
            return self.mul(self.function(numerator, x), inverse)
        if name == "sqrt":
            return self.power(x, Fraction(1, 2))
        if name == "asinh":
            square = self.add(self.const(1), self.mul(x, x))
            return self.function("log", self.add(x, self.function("sqrt", square)))
        if name == "atan":
            return self.node("atan", x, self.add(self.const(1), self.mul(x, x)))
        if name in PAIRS:
            first, second = sorted((name, PAIRS[name]))
            self.node(first, x)
            self.node(second, x)
        return self.node(name, x)

    # -- reading --------------------------------------------------------------------------------

    def read(self, formula: str) -> int:
        """Return the node of a formula in the variables and the parameters.

        Raises NotReadError for any other text.
        """
        try:
            return self._read(ast.parse(formula, mode="eval").body, formula)
        except (SyntaxError, RecursionError, ArithmeticError, MemoryError) as error:
            raise NotReadError(f"{formula[:60]!r} is not a formula: {error}") from None

    def _read(self, node: ast.expr, source: str) -> int:
        match node:
            case ast.Constant(value=int(value)) if not isinstance(value, bool):
                return self.const(value)
            case ast.Constant(value=float()):
                return self.const(Fraction(ast.get_source_segment(source, node) or ""))
            case ast.Name(id=name) if name in self.variables or name == "pi":
                return self.node(name)
            case ast.Name(id=name) if name in self.parameters:
                return self.const(self.parameters[name])
            case ast.UnaryOp(op=ast.USub()):
                return self.scale(-1, self._read(node.operand, source))
            case ast.UnaryOp(op=ast.UAdd()):
                return self._read(node.operand, source)
            case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]):
                if name in _FUNCTIONS:
                    return self.function(name, self._read(argument, source))
            case ast.BinOp():
                return self._operation(node, source)
        raise NotReadError(f"{ast.unparse(node)[:60]!r} is not known here")

    def _operation(self, node: ast.BinOp, source: str) -> int:
        x, y = self._read(node.left, source), self._read(node.right, source)
        match node.op:
            case ast.Add():
                return self.add(x, y)
            case ast.Sub():
                return self.add(x, self.scale(-1, y))
            case ast.Mult():
                return self.mul(x, y)
            case ast.Div():
                return self.mul(x, self.power(y, Fraction(-1)))
            case ast.Pow():
                exponent = self.value(y)
                if exponent is not None:
                    return self.power(x, exponent)
        raise NotReadError(f"{ast.unparse(node)[:60]!r} is not known here")

    # -- derivatives ----------------------------------------------------------------------------

    def diff(self, x: int, name: str) -> int:
        """Return the node of the derivative of x by a variable."""
        if (x, name) not in self._derived:
            self._derived[x, name] = self._diff(self.nodes[x], x, name)
        return self._derived[x, name]

    def _diff(self, node: Node, x: int, name: str) -> int:
        kind, *args = node
        if kind in ("const", "pi", *self.variables):
            return self.const(int(kind == name))
        if kind == "add":
            return self.add(*(self.diff(a, name) for a in args))
        if kind == "mul":
            a, b = args
            return self.add(self.mul(self.diff(a, name), b), self.mul(a, self.diff(b, name)))
        if kind == "scale":
            return self.scale(args[0], self.diff(args[1], name))
        inner = self.diff(args[-1] if kind == "power" else args[0], name)
        if self.value(inner) == 0:
            return inner
        return self.mul(self._outer(kind, args, x), inner)

    def _outer(self, kind: str, args: Sequence[Any], x: int) -> int:
        """Return the derivative of a function by its argument."""
        if kind == "power":
            return self.scale(args[0], self.power(args[1], args[0] - 1))
        if kind == "exp":
            return x
        if kind == "log":
            return self.power(args[0], Fraction(-1))
        if kind == "atan":
            return self.power(args[1], Fraction(-1))
        partner = self.function(PAIRS[kind], args[0])
        return self.scale(-1, partner) if kind == "cos" else partner

    def nodes_below(self, *roots: int) -> tuple[int, ...]:
        """Return the nodes that the roots depend on, with the roots and partners, in order.

        Each of a pair needs the other's coefficients.
        """
        indices = set(roots)
        # Operands come before the nodes that use them, so one pass from the end reaches them all.
        for x in reversed(range(len(self.nodes))):
            if x in indices:
                indices.update(a for a in self.nodes[x][1:] if not isinstance(a, Fraction))
        operations = [self.nodes[x] for x in indices]
        partners = {
            self._index_of[PAIRS[kind], *args] for kind, *args in operations if kind in PAIRS
        }
        return tuple(sorted(indices | partners))
