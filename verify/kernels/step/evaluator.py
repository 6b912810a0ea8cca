"""Elements of a ring, and a step's increments → a straight-line program, no operation twice.

A polynomial in p and q keeps one coefficient per monomial, whatever h and the parameters look like
inside it, since static values are computed once before the loop.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, partial
from itertools import permutations
from typing import Any, TypeVar

import flint

from verify.algebra.identities.polynomials import Generator, terms_of
from verify.algebra.ring import Poly, Ring
from verify.functions import in_rings
from verify.kernels.step.operations import StepProgram, Tail
from verify.schemes.maps.closed_form import h_inside

_MOST_VARIABLES = 4  # of which all orders, 24 at most, are tried for nested evaluation
_MOST = 12  # times a value is added to itself at most

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
        self, program: StepProgram, ring: Ring, inputs: Mapping[str, int], pipelined: bool
    ) -> None:
        self.program, self.ring, self.pipelined = program, ring, pipelined
        self._inputs = inputs
        self._index_of: dict[int, int] = {}
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
        weighted = [(x, w) for x, w in parts.items() if not program.is_constant(w, 0)]
        size = len(weighted)
        terms = [(tuple(int(k == j) for j in range(size)), w) for k, (_, w) in enumerate(weighted)]
        if not program.is_constant(constant, 0):
            terms.append(((0,) * size, constant))
        return self._sum_terms(terms, [x for x, _ in weighted])

    def choose_cheapest(self, ways: Sequence[Callable[[], T]]) -> T:
        """Return the result of the way that writes the fewest operations, the first of such."""
        if len(ways) == 1:
            return ways[0]()
        program, index_of, cost_limit = self.program, self._index_of, self._cost_limit
        mark = program.mark()
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
        parts: list[Term] = []
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
            parts.append((outer, total))
        return parts

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
        orders = permutations(occurring) if len(variables) <= _MOST_VARIABLES else [occurring]
        program, mark = self.program, self.program.mark()
        best: tuple[Cost, Tail, int] | None = None
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
        add, mul, power = self.program.add, self.program.mul, self.program.power
        powers = sorted(coefficients, reverse=True)
        above = powers[0]
        total = coefficients[above]
        for n in powers[1:]:
            total = add(mul(total, power(x, above - n)), coefficients[n])
            above = n
        return mul(total, power(x, above))

    def _estrin(self, coefficients: dict[int, int], x: int) -> int:
        """Return c₀ + c₁ x + (c₂ + c₃ x) x² + …, pairwise again in x²."""
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


def increments(evaluator: Evaluator, moves: Sequence[Poly], h: int) -> list[int]:
    """Return the indices of the increments of all p, then of all q, of which `moves` has the
    formulas; `h` is the index of the step size.

    For H = p²/2 + V(q) the Lie-derivative scheme has q' = q + h p + (h²/2) X p + (h³/6) X² p + …
    beside p' = p + h X p + (h²/2) X² p + …: with a_k = h^k/(k+1)! X^k p they are
    p' = p + 2 a_1 + 3 a_2 + … and q' = q + h (p + a_1 + a_2 + …). So wherever the coefficient of
    h^(k+1) in one of them is the one of h^k in the other over a small integer, it is computed once.
    Both ways are tried, and the cheapest is taken.
    """
    n, pairs = len(moves) // 2, []
    for pair in zip(moves[:n], moves[n:], strict=True):
        ways = [_Way(evaluator.ring, pair, None)]
        # Sharing saves operations but makes p' wait for q': it is not tried if latency counts.
        if not (evaluator.pipelined or h_inside(evaluator.ring, *pair)):
            sharing = (_Way(evaluator.ring, pair, first) for first in (0, 1))
            ways += [way for way in sharing if way.ratios]
        pairs.append(evaluator.choose_cheapest([partial(way.write, evaluator, h) for way in ways]))
    return [pair[part] for part in (0, 1) for pair in pairs]


@dataclass
class _Way:
    """One way to write the increments of p and of q.

    `first`: the increment whose coefficients are taken from the other's; None if none are.
    """

    ring: Ring
    pair: tuple[Poly, Poly]
    first: int | None

    @cached_property
    def parts(self) -> tuple[dict[int, Poly], dict[int, Poly]]:
        """The coefficients of the first and of the second increment, by powers of h."""
        of_p, of_q = (self.ring.powers(x, "h") for x in self.pair)
        return (of_p, of_q) if self.first == 0 else (of_q, of_p)

    @cached_property
    def ratios(self) -> dict[int, int]:
        """{k: r}: the first's coefficient of h^k is r times the second's of h^(k+1)."""
        first, second = self.parts
        if not second or min(second) < 1:
            return {}
        pairs = {k: (x, second[k + 1]) for k, x in first.items() if k >= 1 and k + 1 in second}
        ratios = ((k, r) for k, (x, y) in pairs.items() for r in range(1, _MOST) if x == r * y)
        return dict(ratios)

    def write(self, evaluator: Evaluator, h: int) -> tuple[int, int]:
        """Write both increments, and return their indices."""
        program = evaluator.program
        if self.first is None:
            u, v = self.pair
            return evaluator.evaluate(u), evaluator.evaluate(v)
        (first, second), ratios = self.parts, self.ratios
        taker = evaluator.evaluate(self._sum({k: x for k, x in first.items() if k not in ratios}))
        inner = {k - 1: x for k, x in second.items() if k - 1 not in ratios}
        giver = evaluator.evaluate(self._sum(inner))
        for k, times in ratios.items():
            value = evaluator.evaluate(self._sum({k: second[k + 1]}))
            giver = program.add(giver, value)
            taker = program.add(taker, program.times(value, times))
        giver = program.mul(h, giver)
        return (taker, giver) if self.first == 0 else (giver, taker)

    def _sum(self, parts: Mapping[int, Poly]) -> Poly:
        """Return Σ h^k parts[k]."""
        h = self.ring.variable("h")
        return sum((h**k * x for k, x in parts.items()), self.ring.zero)
