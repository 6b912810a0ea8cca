"""The Taylor series in h of a traced step, node by node, in the ring of H.

No closed form is written down: a function of a series follows from its value at h = 0 and its
differential equation, as sin and cos from s' = c x', c' = −s x' (Griewank and Walther, Evaluating
Derivatives, section 13.2).
"""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from itertools import count

import sympy

from verify.algebra.limits import checked
from verify.algebra.ring import Poly, Ring
from verify.algebra.series.power_series import Series
from verify.functions import by_name
from verify.functions.function import Apply, Pair
from verify.hamiltonians.canonical_field import CanonicalField
from verify.integrators.tracing.number import OPERATORS
from verify.integrators.tracing.trace import Node, expressions, in_order, through
from verify.schemes.steps.step_algebra import State

_HALF = Fraction(1, 2)
_REACHES = (7, 9, 13)  # who asks for one more order asks for further ones


class TracedSeries:
    """A trace as power series in h, one for each root. InputError where it has none at h = 0.

    `field_with(*expressions)`: H's field, and expressions as elements of its ring.
    """

    def __init__(
        self, roots: Sequence[Node], field_with: Callable[..., tuple[CanonicalField, list[Poly]]]
    ) -> None:
        self.roots = tuple(roots)
        self._made: dict[int, tuple[Series, ...]] = {}
        self.nodes = in_order(*roots)
        at_zero = expressions(self.nodes, {"h": sympy.S.Zero})
        wanted: dict[tuple[int, str], sympy.Expr] = {}
        for node in self.nodes:
            start = at_zero[node.number]
            checked(start, "step", "its value at h = 0")
            for name, expression in _beginnings(node, at_zero):
                checked(expression, "step", "its value at h = 0")
                wanted[node.number, name] = expression
        self.field, elements = field_with(*wanted.values())
        self.known: dict[tuple[int, str], Poly] = dict(zip(wanted, elements, strict=True))

    def __call__(self, most: int) -> tuple[CanonicalField, State]:
        """The field, and the roots up to h^most."""
        reach = next((n for n in _REACHES if n >= most), most)
        if reach not in self._made:
            self._made[reach] = self._up_to(reach)
        ring = self.field.ring
        return self.field, tuple(Series.of(ring, x.coefficients, most) for x in self._made[reach])

    def _up_to(self, most: int) -> tuple[Series, ...]:
        maker = _Maker(self.field.ring, most, self.known)
        made = through(self.nodes, maker.series)
        return tuple(made[root.number] for root in self.roots)


def _beginnings(node: Node, at_zero: Mapping[int, sympy.Expr]) -> list[tuple[str, sympy.Expr]]:
    """What its series needs at h = 0, by name."""
    x = [at_zero[one.number] for one in node.inputs]
    name = node.operation
    if name in ("add", "subtract", "multiply", "number", "symbol"):
        return []
    if name == "pi":
        return [("value", sympy.pi)]
    if name == "divide":
        return [("inverse", 1 / x[1])]
    if pair := _pair_of(name):
        return [(one, getattr(sympy, one)(x[0])) for one in (pair.odd, pair.even)]
    value = ("value", at_zero[node.number])
    if name == "power" and node.value.denominator == 1 and node.value > 0:
        return []
    if name in ("power", "sqrt"):
        return [value, ("inverse", 1 / x[0])]
    slope = by_name()[name].slope
    return [value] if slope is None else [value, *_beginnings_of_slope(slope, x[0])]


def _pair_of(name: str) -> Pair | None:
    """The pair that a function is one of, which has its partner as its derivative."""
    function = by_name().get(name)
    pair = function.pair if function else None
    return pair if pair and name in (pair.odd, pair.even) else None


def _beginnings_of_slope(
    slope: Callable[[sympy.Expr, Apply], sympy.Expr], x: sympy.Expr
) -> list[tuple[str, sympy.Expr]]:
    """What its series needs at h = 0: of each thing applied in it, in turn, by numbers."""
    values: list[sympy.Expr] = []

    def apply(name: str, inner: sympy.Expr) -> sympy.Expr:
        values.append(1 / inner)
        if name == "sqrt":
            values.append(sympy.sqrt(inner))
        return values[-1]

    slope(x, apply)
    return [(str(k), value) for k, value in enumerate(values)]


class _Maker:
    """Series up to h^most of nodes, from those of their inputs."""

    def __init__(self, ring: Ring, most: int, known: dict[tuple[int, str], Poly]) -> None:
        self.ring, self.most, self.known = ring, most, known

    def constant(self, x: Poly) -> Series:
        return Series.of(self.ring, [x], self.most)

    def series(self, node: Node, inputs: Sequence[Series]) -> Series:
        ring = self.ring
        match node.operation:
            case "number":
                return self.constant(ring.constant(node.value))
            case "symbol" if node.value == "h":
                return self.constant(ring.one).shifted(1)
            case "symbol":
                return self.constant(ring.variable(node.value))
            case "pi":
                return self.constant(self.known[node.number, "value"])
            case "add" | "subtract" | "multiply" as name:
                combined: Series = OPERATORS[name](*inputs)
                return combined
        return self._function(node, inputs)

    def _function(self, node: Node, inputs: Sequence[Series]) -> Series:
        x, name = inputs[0], node.operation
        if name == "divide":
            return x.over(inputs[1], self.known[node.number, "inverse"])
        if pair := _pair_of(name):
            odd, even = (self.known[node.number, one] for one in (pair.odd, pair.even))
            return self._pair(x, odd, even, pair.sign)[name == pair.even]
        if name == "power" and (node.number, "value") not in self.known:
            return self._natural(x, int(node.value))
        value = self.known[node.number, "value"]
        if name in ("power", "sqrt"):
            inverse = self.known[node.number, "inverse"]
            return self._power(x, node.value or _HALF, value, inverse)
        function = by_name()[name]
        if function.equation:
            return self._solved(value, x, function.equation)
        slope = function.derivative(x, None, self._applied(node))
        return self._integral(value, slope * _slope(x))

    def _applied(self, node: Node) -> Apply:
        """What is applied in a function's slope, from where `_beginnings_of_slope` has it begin."""
        values = (self.known[node.number, str(k)] for k in count())

        def apply(name: str, x: Series) -> Series:
            inverse = next(values)
            if name == "inverse":
                return self.constant(self.ring.one).over(x, inverse)
            return self._power(x, _HALF, next(values), inverse)

        return apply

    def _natural(self, x: Series, n: int) -> Series:
        result, base = None, x
        while n:
            if n & 1:
                result = base if result is None else result * base
            n >>= 1
            base = base * base if n else base
        return result or self.constant(self.ring.one)

    def _power(self, x: Series, exponent: Fraction, value: Poly, inverse: Poly) -> Series:
        """x y' = r x' y for y = x^r."""
        ring, found = self.ring, [value]
        for k in range(1, self.most + 1):
            total = ring.zero
            for j in range(1, k + 1):
                weight = (j * exponent - (k - j)) / k
                total += ring.constant(weight) * x.coefficients[j] * found[k - j]
            found.append(ring.multiply(ring.reduce(total), inverse))
        return Series.of(ring, found, self.most)

    def _integral(self, value: Poly, slope: Series) -> Series:
        shares = [
            c * self.ring.constant(Fraction(1, k + 1)) for k, c in enumerate(slope.coefficients)
        ]
        return Series.of(self.ring, [value, *shares], self.most)

    def _solved(self, value: Poly, x: Series, slope: Callable[[Series], Series]) -> Series:
        """y' = slope(y) x', coefficient by coefficient."""
        y = Series.of(self.ring, [value], self.most)
        for k in range(1, self.most + 1):
            product = slope(y) * _slope(x)
            coefficient = product.coefficients[k - 1] * self.ring.constant(Fraction(1, k))
            y = Series.of(self.ring, [*y.coefficients[:k], coefficient], self.most)
        return y

    def _pair(self, x: Series, odd: Poly, even: Poly, sign: int) -> tuple[Series, Series]:
        """s' = c x' and c' = ± s x'."""
        ring, s, c = self.ring, [odd], [even]
        for k in range(1, self.most + 1):
            up, down = ring.zero, ring.zero
            for j in range(1, k + 1):
                if not x.coefficients[j].is_zero():
                    part = ring.constant(Fraction(j, k)) * x.coefficients[j]
                    up, down = up + part * c[k - j], down + part * s[k - j]
            s.append(ring.reduce(up))
            c.append(ring.reduce(down * sign))
        return Series.of(ring, s, self.most), Series.of(ring, c, self.most)


def _slope(x: Series) -> Series:
    """dx/dh; its last coefficient is not known, and not asked for."""
    ring = x.ring
    moved = [c * ring.constant(Fraction(k)) for k, c in enumerate(x.coefficients)][1:]
    return Series.of(ring, moved, x.most)
