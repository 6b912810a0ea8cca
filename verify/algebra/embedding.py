"""The embedding of expressions as elements of one ring, with the generators that they need.

`embed(expressions, variables)` builds one ring for all expressions: the arguments of all sines (and
those of all exponentials) together determine the basis over which the functions are expanded.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial

import flint

from verify.algebra.expressions.function_nodes import (
    applied_function,
    argument_of,
    is_natural,
    is_trigonometric,
    levels_of,
    root_degrees,
    subexpressions,
)
from verify.algebra.expressions.monomials import monomials_of
from verify.algebra.identities.algebraic_numbers import rational_root
from verify.algebra.linear_algebra import lattice, lattice_and_turns
from verify.algebra.ring import Poly, Ring, RingFullError
from verify.errors import LimitError
from verify.functions.function import CIRCLE, HYPERBOLA, Pair
from verify.lazy_sympy import sympy

MAX_TERMS = 20000
_MAX_UNSCALED_BITS = 12  # a number under a root that is 2^±12 or beyond is scaled
_EXP = "exp"  # is a generator if no hyperbolic function of the same argument occurs


def embed(
    expressions: Sequence[sympy.Expr], variables: Sequence[str], most_terms: int = MAX_TERMS
) -> tuple[Ring, list[Poly]]:
    """Return the ring of the expressions over the variables, and its element for each expression.

    Raises InputError if an expression divides by zero, or expands to more than `most_terms` terms.
    """
    nodes = subexpressions([x for x in expressions if monomials_of(x) is None])
    levels = levels_of(nodes)
    powers = {node for node in nodes if node.is_Pow and not is_natural(node.exp)}
    functions, others = sum(map(len, levels)), len(powers) + (sympy.pi in nodes)
    # Multiplication is faster with fewer generators, used or not: the usual number is tried first.
    most = 6 * (functions + others + len(variables))
    usual = min(2 * functions + 2 * others, most)
    for room in (usual, most):
        builder = _Builder(Ring(variables, room, spare=0), root_degrees(powers), most_terms)
        try:
            for level in levels:
                builder.functions(level)
            return builder.ring, [builder.element(e) for e in expressions]
        except RingFullError as error:
            problem = f"is too involved: {error}"
    raise LimitError("formula", str(expressions[0]), problem)


def _scale(u: Poly, degree: int) -> flint.fmpq:
    """Return 2^k with u/2^(k·degree) close to 1 if u is a number unfit for fixed point; else 1."""
    number = u.leading_coefficient() if u.is_constant() else flint.fmpq(0)
    bits = int(number.p).bit_length() - int(number.q).bit_length() if number > 0 else 0
    return flint.fmpq(2) ** (bits // degree if abs(bits) > _MAX_UNSCALED_BITS else 0)


class _Builder:
    """The builder of a ring's generators; it caches the element of each expression."""

    def __init__(self, ring: Ring, root_degrees: dict[sympy.Expr, int], most_terms: int) -> None:
        self.ring = ring
        self.root_degrees = root_degrees
        self.most_terms = most_terms
        self.cache: dict[sympy.Expr, Poly] = {}

    # -- functions ----------------------------------------------------------------------------

    def functions(self, level: Sequence[sympy.Expr]) -> None:
        """Add generators for one level of nested functions, whose arguments are elements."""
        self.family([f for f in level if is_trigonometric(f)], self.circle, lattice_and_turns)
        exponentials = [f for f in level if applied_function(f).pair is HYPERBOLA]
        self.family(exponentials, self.exponential, lattice)
        for function in level:
            if applied_function(function).pair is None:
                self.other(function)

    def family(
        self,
        functions: Sequence[sympy.Expr],
        make: Callable[[Poly, list[sympy.Expr]], Callable[[int], tuple[Poly, Poly]]],
        find: Callable[[Ring, Sequence[Poly]], tuple[list[Poly], list[list[int]]]],
    ) -> None:
        """Express functions f(Σ kᵢ bᵢ) by addition theorems: `find` returns the basis bᵢ and the
        multiples kᵢ of each argument, `make` the function k ↦ (even, odd) at k b."""
        if not functions:
            return
        ring = self.ring
        arguments = [self.element(argument_of(f)) for f in functions]
        basis, multiples = find(ring, arguments)
        values = [
            make(b, [f for f, row in zip(functions, multiples, strict=True) if row[k]])
            for k, b in enumerate(basis)
        ]
        for function, row in zip(functions, multiples, strict=True):
            trigonometric = is_trigonometric(function)
            even, odd = ring.one, ring.zero
            for k, value in zip(row, values, strict=True):
                c, s = value(k)
                even, odd = self.sum_of_arguments((even, odd), (c, s), -1 if trigonometric else 1)
            self.cache[function] = self.select(function, even, odd)

    def select(self, function: sympy.Expr, even: Poly, odd: Poly) -> Poly:
        def over(above: Poly, below: Poly) -> Poly:
            return self.ring.multiply(above, self.inverse(below, function))

        parts = applied_function(function).parts
        assert parts is not None  # noqa: S101 - those of a pair have them
        return self.ring.reduce(parts(odd, even, over))

    def circle(self, b: Poly, _: list[sympy.Expr]) -> Callable[[int], tuple[Poly, Poly]]:
        """Return k ↦ (cos kb, sin kb), polynomials in cos b and sin b."""
        return partial(self.multiple, *self.pair(b, CIRCLE), sign=CIRCLE.sign)

    def exponential(
        self, b: Poly, functions: list[sympy.Expr]
    ) -> Callable[[int], tuple[Poly, Poly]]:
        """Return k ↦ (even, odd) with even + odd = exp kb.

        If hyperbolic functions of b occur, the generators are cosh b and sinh b; else exp b, with
        its inverse if it is needed, and odd is 0.
        """
        ring = self.ring
        # cosh and sinh need a relation, exp does not: exp alone is the simpler generator.
        if ring.find(HYPERBOLA.even, b) is not None or any(
            applied_function(f).name != _EXP for f in functions
        ):
            return partial(self.multiple, *self.pair(b, HYPERBOLA), sign=HYPERBOLA.sign)
        e = ring.find(_EXP, b)
        if e is None:
            e = ring.add(_EXP, b)
            ring.set_gradient(e, e, b)
        return lambda k: (e**k if k >= 0 else ring.inverse(e) ** -k, ring.zero)

    def pair(self, b: Poly, pair: Pair) -> tuple[Poly, Poly]:
        """Return the even and the odd function of a pair at one argument."""
        ring, sign = self.ring, pair.sign
        c, s = ring.find(pair.even, b), ring.find(pair.odd, b)
        if c is None or s is None:
            c, s = ring.add(pair.even, b), ring.add(pair.odd, b)
            ring.relate(s, 2, s**2 - sign * c**2 + sign)
            ring.set_gradient(c, sign * s, b)
            ring.set_gradient(s, c, b)
        return c, s

    def multiple(self, c: Poly, s: Poly, k: int, *, sign: int) -> tuple[Poly, Poly]:
        """Return (c, s) at k times the argument; `sign` is that of s² in the addition theorem."""
        even, odd = self.ring.one, self.ring.zero
        for _ in range(abs(k)):
            even, odd = self.sum_of_arguments((even, odd), (c, s), sign)
        return even, odd if k >= 0 else -odd

    def sum_of_arguments(
        self, left: tuple[Poly, Poly], right: tuple[Poly, Poly], sign: int
    ) -> tuple[Poly, Poly]:
        """Return (c, s) at the sum of two arguments, by the addition theorem."""
        (c, s), (d, t), reduce = left, right, self.ring.reduce
        return reduce(c * d + sign * s * t), reduce(s * d + c * t)

    def other(self, function: sympy.Expr) -> None:
        """Add a function that belongs to no pair; its derivative is algebraic in its argument."""
        ring, u, rule = self.ring, self.element(function.args[0]), applied_function(function)
        same = ring.find(rule.name, u)
        if same is not None:
            self.cache[function] = same
            return

        def apply(name: str, x: Poly) -> Poly:
            x = ring.reduce(x)
            return self.inverse(x, function) if name == "inverse" else self.root(x, 2, function)

        outer = rule.derivative(u, None, apply)
        generator = ring.add(rule.name, u)
        ring.set_gradient(generator, outer, u)
        self.cache[function] = generator

    # -- everything else ----------------------------------------------------------------------

    def element(self, node: sympy.Expr) -> Poly:
        """Return the element of the expression. Raises InputError if that is undefined or large."""
        if node in self.cache:
            return self.cache[node]
        self.cache[node] = self.check_length(self.build(node), node)
        return self.cache[node]

    def build(self, node: sympy.Expr) -> Poly:
        ring = self.ring
        if node.is_Rational:
            return ring.context.constant(flint.fmpq(int(node.p), int(node.q)))
        if node.is_Symbol:
            return ring.variable(node.name)
        if node is sympy.pi:
            return ring.add("pi")
        if node.is_Add:
            return self.sum(node)
        if node.is_Mul:
            total = ring.one
            for argument in node.args:
                total = self.check_length(ring.multiply(total, self.element(argument)), node)
            return total
        if node.is_Pow and node.exp.is_Rational:
            return self.power(node)
        raise LimitError("formula", str(node), f"{type(node).__name__} cannot be handled exactly")

    def sum(self, node: sympy.Add) -> Poly:
        ring, plain = self.ring, dict[tuple[int, ...], flint.fmpq]()
        total, length = ring.zero, ring.room + len(ring.variables)
        for argument in node.args if monomials_of(node) is None else (node,):
            terms = monomials_of(argument)
            if terms is None:
                total += self.element(argument)
                continue
            for number, powers in terms:
                exponents = [0] * length
                for name, n in powers:
                    exponents[ring.places[name]] += n
                monomial = tuple(exponents)
                value = flint.fmpq(int(number.p), int(number.q))
                plain[monomial] = plain.get(monomial, 0) + value
        return total + ring.context.from_dict(plain)

    def power(self, node: sympy.Expr) -> Poly:
        base = self.element(node.base)
        n, degree = int(node.exp.p), int(node.exp.q)
        if degree == 1 and n > 0 and node.base.is_Symbol:
            return base**n
        if degree == 1:
            return self.power_of_element(base if n > 0 else self.inverse(base, node), abs(n), node)
        finest = self.root_degrees[node.base]
        scale = _scale(base, finest)
        root = self.root(base / scale**finest, finest, node) * scale
        n *= finest // degree
        if n < 0:
            # 1/R = R^(finest−1)/u needs no new inverse: that of u is in the derivative of R.
            inverse = self.ring.multiply(root ** (finest - 1), self.inverse(base, node))
            return self.power_of_element(inverse, -n, node)
        return self.power_of_element(root, n, node)

    def root(self, u: Poly, degree: int, node: sympy.Expr) -> Poly:
        ring = self.ring
        same = ring.find("root", u, degree)
        if same is not None:
            return same
        _, factors = u.factor()
        common = math.gcd(degree, *(int(n) for _, n in factors))
        if common > 1 and factors:
            return self.root_of_power(u, common, degree, node)
        inverse = self.inverse(u, node)
        root = ring.add("root", u, degree)
        ring.relate(root, degree, root**degree - u)
        ring.set_gradient(root, ring.multiply(root, inverse) / degree, u)
        return root

    def root_of_power(self, u: Poly, common: int, degree: int, node: sympy.Expr) -> Poly:
        """Return the root c^(1/n)·|v|^(common/n) of u = c·v^common, n = `degree`; |v| must be ±v
        everywhere."""
        from verify.algebra.positivity import size_of_base  # few formulas need it

        size = size_of_base(self.ring, u, common)
        if size is None:
            raise LimitError("formula", str(node), "is not smooth: the root of a power is |x|")
        c, v = size
        index = degree // common
        root = v if index == 1 else self.root(v, index, node)
        rational = rational_root(c, degree)
        number = self.ring.context.constant(c if rational is None else rational)
        # The root of the number c is one more generator, unless it is rational.
        number = self.root(number, degree, node) if rational is None else number
        return self.check_length(self.ring.multiply(root, number), node)

    def power_of_element(self, base: Poly, n: int, node: sympy.Expr) -> Poly:
        total = self.ring.one
        for _ in range(n):
            total = self.check_length(self.ring.multiply(total, base), node)
        return total

    def check_length(self, x: Poly, node: sympy.Expr) -> Poly:
        if len(x) > self.most_terms:
            raise LimitError("formula", str(node), f"expands to more than {self.most_terms} terms")
        return x

    def inverse(self, u: Poly, node: sympy.Expr) -> Poly:
        try:
            return self.ring.inverse(u)
        except ZeroDivisionError:
            problem = "division by zero, or by what cannot be shown not to vanish"
            raise LimitError("formula", str(node), problem) from None
