"""Elements of a ring, and the increments of a step → a straight-line program.

A value that depends on h and the parameters alone is static: it is computed once, before the loop.
Generators of the ring (variables, functions, inverses, roots) that are not static are dynamic. A
polynomial is evaluated as one in the dynamic generators, with a static coefficient per monomial.
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

_MAX_ORDERED_VARIABLES = 4  # up to here all orders of the variables, 24 at most, are tried
_RATIO_END = 12  # ratios of coefficients from 1 to 11 are used

Term = tuple[tuple[int, ...], int]  # exponents of the dynamic generators, index of coefficient
# A polynomial: exponent of its first variable → nest in the others; of the last → coefficient.
Nest = dict[int, Any]
Cost = tuple[int, int]  # latency and number of operations, the more important one first
T = TypeVar("T")


class _TooCostlyError(Exception):
    """A trial costs more than the best one so far."""


class Evaluator:
    """A writer of ring elements into a program; the variables are the program's inputs.

    `pipelined`: a polynomial is summed with the least latency, not with the fewest operations.
    """

    def __init__(
        self, program: StepProgram, ring: Ring, inputs: Mapping[str, int], pipelined: bool
    ) -> None:
        self.program, self.ring, self.pipelined = program, ring, pipelined
        self._inputs = inputs
        self._index_of: dict[int, int] = {}
        self._cost_limit: int | None = None  # a trial that costs more is given up

    def evaluate(self, x: Poly, factor: int | None = None) -> int:
        """Return the index of the value of x, or of x times the static value of index `factor`."""
        generators = self.ring.generators_in(x)
        for generator in generators:
            self.index_of_generator(generator)
        dynamic = [g.index for g in generators if not self.program.static[self._index_of[g.index]]]
        terms = self._collect(x, dynamic, {g.index for g in generators}.difference(dynamic))
        if factor is not None:
            terms = [(outer, self.program.mul(c, factor)) for outer, c in terms]
        return self._sum_terms(terms, [self._index_of[i] for i in dynamic])

    def combination(self, weights: Sequence[int], values: Sequence[int]) -> int:
        """Return the index of Σ weight · value, for static weights, as the cheapest sum."""
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

    def choose_cheapest(self, writers: Sequence[Callable[[], T]]) -> T:
        """Return the result of the writer whose operations cost least; of several the first."""
        if len(writers) == 1:
            return writers[0]()
        program, index_of, cost_limit = self.program, self._index_of, self._cost_limit
        mark = program.mark()
        best: tuple[int, Tail, dict[int, int], T] | None = None
        # Each writer writes behind the mark, and its tail is cut off; the cheapest tail is put
        # back. A writer stops when it costs more than the best one so far.
        for write in writers:
            self._index_of = dict(index_of)
            try:
                value = write()
            except _TooCostlyError:
                program.cut(mark)
                continue
            cost, tail = program.cost, program.cut(mark)
            if best is None or cost < best[0]:
                best = cost, tail, self._index_of, value
                self._cost_limit = cost
        self._cost_limit = cost_limit
        if best is None:
            raise _TooCostlyError
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
        """Write the static coefficients of x; return its terms in the dynamic generators."""
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
        """Return the index of the sum of the terms, written as the cheapest of several forms.

        The forms: each order of the variables, by Horner's rule (fewest operations) or by Estrin's
        (least latency: first pairs of coefficients, then pairs of pairs).
        """
        if not terms:
            return self.program.constant(Fraction(0))
        occurring = [k for k in range(len(variables)) if any(outer[k] for outer, _ in terms)]
        if not occurring:
            return terms[0][1]
        orders = (
            permutations(occurring) if len(variables) <= _MAX_ORDERED_VARIABLES else [occurring]
        )
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
        assert best is not None  # noqa: S101 - at least one form was tried
        program.put_back(best[1])
        if self._cost_limit is not None and program.cost > self._cost_limit:
            raise _TooCostlyError
        return best[2]

    def _sum_nest(
        self, nest: Nest, values: list[int], depth: int, sum_: Callable[[dict[int, int], int], int]
    ) -> int:
        """Return the index of a nest's value; its first variable is `values[depth]`."""
        coefficients: dict[int, int] = nest
        if depth + 1 < len(values):
            coefficients = {
                n: self._sum_nest(part, values, depth + 1, sum_) for n, part in nest.items()
            }
        if len(coefficients) == 1 and 0 in coefficients:
            return coefficients[0]
        return sum_(coefficients, values[depth])

    def _horner(self, coefficients: dict[int, int], x: int) -> int:
        """Return the index of Σ c_n xⁿ by Horner's rule, with powers over gaps of exponents."""
        add, mul, power = self.program.add, self.program.mul, self.program.power
        powers = sorted(coefficients, reverse=True)
        above = powers[0]
        total = coefficients[above]
        for n in powers[1:]:
            total = add(mul(total, power(x, above - n)), coefficients[n])
            above = n
        return mul(total, power(x, above))

    def _estrin(self, coefficients: dict[int, int], x: int) -> int:
        """Return the index of Σ c_n xⁿ as c₀ + c₁ x + (c₂ + c₃ x) x² + …, with pairs in x² next."""
        program = self.program
        # Each pass halves the degree: the depth is logarithmic, that of Horner's rule linear.
        while set(coefficients) != {0}:
            pairs: dict[int, int] = {}
            for n, c in sorted(coefficients.items()):
                term = program.mul(c, x) if n % 2 else c
                half = n // 2
                pairs[half] = program.add(pairs[half], term) if half in pairs else term
            coefficients, x = pairs, program.mul(x, x)
        return coefficients[0]


def _nest(terms: Sequence[Term], order: Sequence[int]) -> Nest:
    """Return the nest of the terms, for this order of the variables."""
    *outer, last = order
    nest: Nest = {}
    for exponents, coefficient in terms:
        inner = nest
        for k in outer:
            inner = inner.setdefault(exponents[k], {})
        inner[exponents[last]] = coefficient
    return nest


def increments(evaluator: Evaluator, moves: Sequence[Poly], h: int) -> list[int]:
    """Return the indices of the increments `moves` of all p, then of all q; `h`: that of h.

    For H = p²/2 + V(q) the Lie-derivative scheme has q' = q + h p + (h²/2) X p + (h³/6) X² p + …
    beside p' = p + h X p + (h²/2) X² p + …, where X is the derivative along the flow. With
    a_k = h^k/(k+1)! X^k p they are p' = p + 2 a_1 + 3 a_2 + … and q' = q + h (p + a_1 + a_2 + …).
    So if the coefficient of h^k in one increment is a small integer times that of h^(k+1) in the
    other, it is computed once. Sharing is tried in both directions; the cheapest form is taken.
    """
    if len(moves) % 2:  # of equations
        return [evaluator.evaluate(x) for x in moves]
    n, pairs = len(moves) // 2, []
    for pair in zip(moves[:n], moves[n:], strict=True):
        forms = [_IncrementPair(evaluator.ring, pair, None)]
        # Sharing makes p' wait for q': not if latency counts.
        if not (evaluator.pipelined or h_inside(evaluator.ring, *pair)):
            sharing = (_IncrementPair(evaluator.ring, pair, taker) for taker in (0, 1))
            forms += [form for form in sharing if form.ratios]
        writers = [partial(form.write, evaluator, h) for form in forms]
        pairs.append(evaluator.choose_cheapest(writers))
    return [pair[part] for part in (0, 1) for pair in pairs]


@dataclass
class _IncrementPair:
    """The increments of p and of q in one form. `taker`: the increment, 0 or 1, that takes
    coefficients from the other one, the giver; None if neither does."""

    ring: Ring
    pair: tuple[Poly, Poly]
    taker: int | None

    @cached_property
    def parts(self) -> tuple[dict[int, Poly], dict[int, Poly]]:
        """The coefficients of the taker and of the giver, by powers of h."""
        of_p, of_q = (self.ring.powers(x, "h") for x in self.pair)
        return (of_p, of_q) if self.taker == 0 else (of_q, of_p)

    @cached_property
    def ratios(self) -> dict[int, int]:
        """{k: r}: the taker's coefficient of h^k is r times the giver's coefficient of h^(k+1)."""
        taker, giver = self.parts
        if not giver or min(giver) < 1:
            return {}
        pairs = {k: (x, giver[k + 1]) for k, x in taker.items() if k >= 1 and k + 1 in giver}
        ratios = ((k, r) for k, (x, y) in pairs.items() for r in range(1, _RATIO_END) if x == r * y)
        return dict(ratios)

    def write(self, evaluator: Evaluator, h: int) -> tuple[int, int]:
        """Write both increments, and return their indices."""
        program = evaluator.program
        if self.taker is None:
            u, v = self.pair
            return evaluator.evaluate(u), evaluator.evaluate(v)
        (taker_parts, giver_parts), ratios = self.parts, self.ratios
        taker = evaluator.evaluate(
            self._sum({k: x for k, x in taker_parts.items() if k not in ratios})
        )

        inner = {k - 1: x for k, x in giver_parts.items() if k - 1 not in ratios}
        giver = evaluator.evaluate(self._sum(inner))
        for k, times in ratios.items():
            value = evaluator.evaluate(self._sum({k: giver_parts[k + 1]}))
            giver = program.add(giver, value)
            taker = program.add(taker, program.times(value, times))
        giver = program.mul(h, giver)
        return (taker, giver) if self.taker == 0 else (giver, taker)

    def _sum(self, parts: Mapping[int, Poly]) -> Poly:
        """Return Σ h^k parts[k]."""
        h = self.ring.variable("h")
        return sum((h**k * x for k, x in parts.items()), self.ring.zero)
