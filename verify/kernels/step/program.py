"""Polynomials in generators → a straight-line program, in which no operation occurs twice.

A polynomial in p and q keeps one coefficient per monomial, whatever h and the parameters look like
inside it, since static values are computed once before the loop.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from fractions import Fraction
from itertools import permutations
from typing import Any, TypeVar

import flint

from verify.algebra.generator import Generator, terms_of
from verify.algebra.ring import Poly, Ring
from verify.functions import in_rings
from verify.kernels.step.operations import Op as Op
from verify.kernels.step.operations import Program as Program
from verify.kernels.step.operations import Tail

_MOST_VARIABLES = 4  # of which all orders are tried for nested evaluation

Term = tuple[tuple[int, ...], int]  # exponents of the dynamic generators, index of coefficient
# A polynomial by the exponents of its variables, one after the other: its coefficients' indices.
Nest = dict[int, Any]  # of nests of one variable less, or of indices
Cost = tuple[int, int]
T = TypeVar("T")


class _TooDearError(Exception):
    """A trial that costs more than the best one so far."""


class Evaluator:
    """Writes ring elements into a program, at the point whose variables are the inputs.

    `pipelined`: of the ways to sum a polynomial take that of least latency, not of fewest
    operations.
    """

    def __init__(
        self, program: Program, ring: Ring, inputs: Mapping[str, int], pipelined: bool
    ) -> None:
        self.program = program
        self.ring = ring
        self.pipelined = pipelined
        self._index_of: dict[int, int] = {}
        self._inputs = inputs
        self._cost_limit: int | None = None  # operations, beyond which a trial is given up

    def evaluate(self, x: Poly, factor: int | None = None) -> int:
        """Return the index of x's value, or of its product with a static value (the index
        `factor`)."""
        generators = self.ring.generators_in(x)
        for generator in generators:
            self.index_of_generator(generator)
        dynamic = [g.index for g in generators if not self.program.static[self._index_of[g.index]]]
        terms = self._collect(x, dynamic, {g.index for g in generators}.difference(dynamic))
        if factor is not None:
            terms = [(outer, self.program.mul(c, factor)) for outer, c in terms]
        return self._sum_terms(terms, [self._index_of[i] for i in dynamic])

    def combination(self, weights: Sequence[int], values: Sequence[int]) -> int:
        """Return the index of Σ weights · values, for static weights, in the cheapest way."""
        program = self.program
        constant, parts = program.quotient(0, 1), dict[int, int]()
        for weight, value in zip(weights, values, strict=True):
            if program.static[value]:
                constant = program.add(constant, program.mul(weight, value))
            else:
                parts[value] = program.add(parts[value], weight) if value in parts else weight
        every = [(x, w) for x, w in parts.items() if not program.is_constant(w, 0)]
        size = len(every)
        terms = [(tuple(int(k == j) for j in range(size)), w) for k, (_, w) in enumerate(every)]
        if not program.is_constant(constant, 0):
            terms.append(((0,) * size, constant))
        return self._sum_terms(terms, [x for x, _ in every])

    def choose_cheapest(self, ways: Sequence[Callable[[], T]]) -> T:
        """Return the result of the way that writes the fewest operations, the first of such."""
        if len(ways) == 1:
            return ways[0]()
        program, index_of, cost_limit, mark = (
            self.program,
            self._index_of,
            self._cost_limit,
            self.program.mark(),
        )
        best: tuple[int, Tail, dict[int, int], T] | None = None
        # Each way is written behind the mark, cut off, and the cheapest is put back; what costs
        # more than the best so far gives up on its way.
        for way in ways:
            self._index_of = dict(index_of)
            try:
                value = way()
            except _TooDearError:
                program.cut(mark)
                continue
            cost, tail = program.cost, program.cut(mark)
            if best is None or cost < best[0]:
                best = cost, tail, self._index_of, value
                self._cost_limit = cost
        self._cost_limit = cost_limit
        if best is None:
            raise _TooDearError
        program.put_back(best[1])
        self._index_of = best[2]
        return best[3]

    def copy(self) -> "Evaluator":
        """Return the same, with a copy of its program."""
        other = Evaluator(self.program.copy(), self.ring, self._inputs, self.pipelined)
        other._index_of = dict(self._index_of)
        return other

    def index_of_generator(self, generator: Generator) -> int:
        """Return the index of a generator's value."""
        if generator.index not in self._index_of:
            self._index_of[generator.index] = self._generator(generator)
        return self._index_of[generator.index]

    def _generator(self, g: Generator) -> int:
        if g.kind == "variable":
            return self._inputs[g.name]
        if g.kind == "pi":
            return self.program.pi()
        inner = self.evaluate(g.inner)
        if g.kind == "inverse":
            return self.program.inverse(inner)
        if g.kind == "root":
            return self.program.root(inner, g.degree)
        return self.program.call(in_rings()[g.kind], inner)

    def _collect(self, x: Poly, dynamic: Sequence[int], static: Collection[int]) -> list[Term]:
        """Return x by monomials in the dynamic generators, the static coefficients evaluated."""
        # The polynomial is read as one in the dynamic generators, with static polynomials as
        # coefficients.
        parts: dict[tuple[int, ...], int] = {}
        program, static_values = self.program, [(i, self._index_of[i]) for i in sorted(static)]
        by_outer: dict[tuple[int, ...], list[tuple[tuple[int, ...], flint.fmpq]]] = {}
        for monomial, c in terms_of(x):
            outer = tuple([int(monomial[i]) for i in dynamic])
            by_outer.setdefault(outer, []).append((monomial, c))
        # Static parts are summed before the loop, whatever they cost; their powers are shared.
        zero, powers = Fraction(0), dict[tuple[int, int], int]()
        for outer, terms in by_outer.items():
            total = program.constant(zero)
            for monomial, c in terms:
                product = program.quotient(int(c.p), int(c.q))
                for index, value in static_values:
                    if n := monomial[index]:
                        power = powers.get((index, n))
                        if power is None:
                            power = powers[index, n] = program.power(value, int(n))
                        product = program.mul(product, power)
                total = program.add(total, product)
            parts[outer] = total
        return list(parts.items())

    def _sum_terms(self, terms: list[Term], variables: list[int]) -> int:
        """Return the sum of the terms by the cheapest of the ways that are tried.

        Ways: each order of the variables, by Horner's rule (fewest operations) or by Estrin's
        (least latency: pairs of coefficients first, then pairs of pairs).
        """
        if not terms:
            return self.program.constant(Fraction(0))
        occurring = [k for k in range(len(variables)) if any(outer[k] for outer, _ in terms)]
        if not occurring:
            return terms[0][1]
        orders = [tuple(occurring)]
        if len(variables) <= _MOST_VARIABLES:
            orders = list(permutations(occurring))
        program, mark = self.program, self.program.mark()
        best: tuple[Cost, Tail, int] | None = None
        # With k variables there are k! orders; `_MOST_VARIABLES` bounds them by 24.
        for order in orders:
            nest = _nest(terms, order)
            values = [variables[k] for k in order]
            for sum_ in (self._horner, self._estrin):
                result = self._sum_nest(nest, values, 0, sum_)
                latency, count = program.depth[result], program.cost
                cost = (latency, count) if self.pipelined else (count, latency)
                tail = program.cut(mark)
                if best is None or cost < best[0]:
                    best = cost, tail, result
        assert best is not None  # noqa: S101 - there is one way at least
        program.put_back(best[1])
        if self._cost_limit is not None and program.cost > self._cost_limit:
            raise _TooDearError
        return best[2]

    def _sum_nest(
        self, nest: Nest, values: list[int], depth: int, sum_: Callable[[dict[int, int], int], int]
    ) -> int:
        """Return the value of a polynomial in the variable of number `depth`, its coefficients in
        those after it."""
        coefficients: dict[int, int] = nest
        if depth + 1 < len(values):
            coefficients = {
                n: self._sum_nest(part, values, depth + 1, sum_) for n, part in nest.items()
            }
        if len(coefficients) == 1 and 0 in coefficients:
            return coefficients[0]
        return sum_(coefficients, values[depth])

    def _horner(self, coefficients: dict[int, int], x: int) -> int:
        """Return Σ c_n xⁿ by Horner's rule, with powers for gaps between exponents."""
        program = self.program
        add, mul, power = program.add, program.mul, program.power
        powers = sorted(coefficients, reverse=True)
        above = powers[0]
        total = coefficients[above]
        for n in powers[1:]:
            total = add(mul(total, power(x, above - n)), coefficients[n])
            above = n
        return mul(total, power(x, above))

    def _estrin(self, coefficients: dict[int, int], x: int) -> int:
        """c₀ + c₁ x + (c₂ + c₃ x) x² + …, pairwise again in x²."""
        program = self.program
        # Each turn halves the degree: the depth is logarithmic, where Horner's rule is linear.
        while set(coefficients) != {0}:
            pairs: dict[int, int] = {}
            for n, c in sorted(coefficients.items()):
                term = program.mul(c, x) if n % 2 else c
                half = n // 2
                pairs[half] = program.add(pairs[half], term) if half in pairs else term
            coefficients, x = pairs, program.mul(x, x)
        return coefficients[0]


def _nest(terms: Sequence[Term], order: Sequence[int]) -> Nest:
    """Return the terms by the exponents of the variables in this order."""
    *outer, last = order
    nest: Nest = {}
    for exponents, coefficient in terms:
        inner = nest
        for k in outer:
            inner = inner.setdefault(exponents[k], {})
        inner[exponents[last]] = coefficient
    return nest
