"""The Taylor series in h of a traced step, node by node, in the ring of H.

No closed form is needed: a function of a series is computed from its value at h = 0 and its
differential equation, as sin and cos from s' = c x', c' = −s x' (Griewank and Walther, Evaluating
Derivatives, section 13.2).
"""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from itertools import count

import sympy

from verify.algebra.limits import check_expression
from verify.algebra.power_series import Series
from verify.algebra.ring import Poly, Ring
from verify.functions import by_name
from verify.functions.function import Apply, Pair
from verify.hamiltonians.canonical_field import PlainField
from verify.integrators.tracing.named_functions import OPERATORS
from verify.integrators.tracing.trace import Node, evaluate_nodes, expressions, in_order
from verify.schemes.steps.step_algebra import State

_HALF = Fraction(1, 2)
_COMPUTED_ORDERS = (7, 9, 13)  # callers request one more order again and again


class TracedSeries:
    """A trace as power series in h, one for each root, an output of the trace.

    `field_with(*expressions)`: returns H's field, and the expressions as elements of its ring.
    Raises InputError if a node has no value at h = 0.
    """

    def __init__(
        self, roots: Sequence[Node], field_with: Callable[..., tuple[PlainField, list[Poly]]]
    ) -> None:
        self.roots = tuple(roots)
        self._series: dict[int, tuple[Series, ...]] = {}
        self.nodes = in_order(*roots)
        # All values at h = 0 are embedded in one ring at once, since an element that is added later
        # would change the ring of the others.
        at_zero = expressions(self.nodes, {"h": sympy.S.Zero})
        initial_expressions: dict[tuple[int, str], sympy.Expr] = {}
        for node in self.nodes:
            start = at_zero[node.number]
            check_expression(start, "step", "its value at h = 0")
            for name, expression in _beginnings(node, at_zero):
                check_expression(expression, "step", "its value at h = 0")
                initial_expressions[node.number, name] = expression
        self.field, elements = field_with(*initial_expressions.values())
        self.initial_values: dict[tuple[int, str], Poly] = dict(
            zip(initial_expressions, elements, strict=True)
        )

    def __call__(self, most: int) -> tuple[PlainField, State]:
        """Return the field, and the roots up to h^most."""
        reach = next((n for n in _COMPUTED_ORDERS if n >= most), most)
        if reach not in self._series:
            self._series[reach] = self._up_to(reach)
        ring = self.field.ring
        return self.field, tuple(
            Series.from_coefficients(ring, x.coefficients, most) for x in self._series[reach]
        )

    def _up_to(self, most: int) -> tuple[Series, ...]:
        maker = _Maker(self.field.ring, most, self.initial_values)
        series = evaluate_nodes(self.nodes, maker.series)
        return tuple(series[root.number] for root in self.roots)


def _beginnings(node: Node, at_zero: Mapping[int, sympy.Expr]) -> list[tuple[str, sympy.Expr]]:
    """Return the values at h = 0 with which the series of the node begins, by name."""
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
    """Return the pair that a function is one of, which has its partner as its derivative."""
    function = by_name().get(name)
    pair = function.pair if function else None
    return pair if pair and name in (pair.odd, pair.even) else None


def _beginnings_of_slope(
    slope: Callable[[sympy.Expr, Apply], sympy.Expr], x: sympy.Expr
) -> list[tuple[str, sympy.Expr]]:
    """Return the values at h = 0 of each function applied in the slope, in turn, by numbers."""
    values: list[sympy.Expr] = []

    def apply(name: str, inner: sympy.Expr) -> sympy.Expr:
        values.append(1 / inner)
        if name == "sqrt":
            values.append(sympy.sqrt(inner))
        return values[-1]

    slope(x, apply)
    return [(str(k), value) for k, value in enumerate(values)]


class _Maker:
    """A builder of series up to h^most of nodes, from those of their inputs."""

    def __init__(self, ring: Ring, most: int, initial_values: dict[tuple[int, str], Poly]) -> None:
        self.ring, self.most, self.initial_values = ring, most, initial_values

    def constant(self, x: Poly) -> Series:
        return Series.from_coefficients(self.ring, [x], self.most)

    def series(self, node: Node, inputs: Sequence[Series]) -> Series:
        ring = self.ring
        match node.operation:
            case "number":
                return self.constant(ring.constant(node.value))
            case "symbol" if node.value == "h":
                return self.constant(ring.one).shift(1)
            case "symbol":
                return self.constant(ring.variable(node.value))
            case "pi":
                return self.constant(self.initial_values[node.number, "value"])
            case "add" | "subtract" | "multiply" as name:
                result: Series = OPERATORS[name](*inputs)
                return result
        return self._function(node, inputs)

    def _function(self, node: Node, inputs: Sequence[Series]) -> Series:
        x, name = inputs[0], node.operation
        if name == "divide":
            return x.divide_by(inputs[1], self.initial_values[node.number, "inverse"])
        if pair := _pair_of(name):
            odd, even = (self.initial_values[node.number, one] for one in (pair.odd, pair.even))
            return self._pair(x, odd, even, pair.sign)[name == pair.even]
        if name == "power" and (node.number, "value") not in self.initial_values:
            return self._natural(x, int(node.value))
        value = self.initial_values[node.number, "value"]
        if name in ("power", "sqrt"):
            inverse = self.initial_values[node.number, "inverse"]
            return self._power(x, node.value or _HALF, value, inverse)
        function = by_name()[name]
        if function.equation:
            return self._solve_equation(value, x, function.equation)
        slope = function.derivative(x, None, self._make_apply(node))
        return self._integral(value, slope * _slope(x))

    def _make_apply(self, node: Node) -> Apply:
        """Return the function that is applied in a slope, with the values that
        `_beginnings_of_slope` found."""
        values = (self.initial_values[node.number, str(k)] for k in count())

        def apply(name: str, x: Series) -> Series:
            inverse = next(values)
            if name == "inverse":
                return self.constant(self.ring.one).divide_by(x, inverse)
            return self._power(x, _HALF, next(values), inverse)

        return apply

    def _natural(self, x: Series, n: int) -> Series:
        result, base = None, x
        while n:
            # Binary powering: about 2 log₂ n products.
            if n & 1:
                result = base if result is None else result * base
            n >>= 1
            base = base * base if n else base
        return result or self.constant(self.ring.one)

    def _power(self, x: Series, exponent: Fraction, value: Poly, inverse: Poly) -> Series:
        """Solve x y' = r x' y for y = x^r."""
        ring, coefficients = self.ring, [value]
        for k in range(1, self.most + 1):
            # k x_0 y_k = Σ_j (r j − (k − j)) x_j y_(k−j): one product with 1/x_0 is enough.
            total = ring.zero
            for j in range(1, k + 1):
                weight = (j * exponent - (k - j)) / k
                total += ring.constant(weight) * x.coefficients[j] * coefficients[k - j]
            coefficients.append(ring.multiply(ring.reduce(total), inverse))
        return Series.from_coefficients(ring, coefficients, self.most)

    def _integral(self, value: Poly, slope: Series) -> Series:
        shares = [
            c * self.ring.constant(Fraction(1, k + 1)) for k, c in enumerate(slope.coefficients)
        ]
        return Series.from_coefficients(self.ring, [value, *shares], self.most)

    def _solve_equation(self, value: Poly, x: Series, slope: Callable[[Series], Series]) -> Series:
        """Solve y' = slope(y) x', coefficient by coefficient."""
        y = Series.from_coefficients(self.ring, [value], self.most)
        for k in range(1, self.most + 1):
            # k y_k is the coefficient of h^(k−1) in slope(y) x', which needs y_0 … y_(k−1) alone.
            product = slope(y) * _slope(x)
            coefficient = product.coefficients[k - 1] * self.ring.constant(Fraction(1, k))
            y = Series.from_coefficients(self.ring, [*y.coefficients[:k], coefficient], self.most)
        return y

    def _pair(self, x: Series, odd: Poly, even: Poly, sign: int) -> tuple[Series, Series]:
        """Solve s' = c x' and c' = ± s x'."""
        ring, s, c = self.ring, [odd], [even]
        for k in range(1, self.most + 1):
            up, down = ring.zero, ring.zero
            for j in range(1, k + 1):
                if not x.coefficients[j].is_zero():
                    part = ring.constant(Fraction(j, k)) * x.coefficients[j]
                    up, down = up + part * c[k - j], down + part * s[k - j]
            s.append(ring.reduce(up))
            c.append(ring.reduce(down * sign))
        return Series.from_coefficients(ring, s, self.most), Series.from_coefficients(
            ring, c, self.most
        )


def _slope(x: Series) -> Series:
    """Return dx/dh; its last coefficient is not known, and not needed."""
    ring = x.ring
    coefficients = [c * ring.constant(Fraction(k)) for k, c in enumerate(x.coefficients)][1:]
    return Series.from_coefficients(ring, coefficients, x.most)
