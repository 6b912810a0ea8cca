"""Polynomials in generators → a straight-line program (`verify.operations`): nothing twice.

A polynomial in p and q keeps one coefficient per monomial, whatever h and the parameters look like
inside it, since what is static is computed once before the loop.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import pairwise, permutations

from verify.generator import Generator
from verify.operations import Loop
from verify.operations import Op as Op
from verify.operations import Program as Program
from verify.ring import Poly, Ring
from verify.solved import System

_MOST_VARIABLES = 4  # of which all orders are tried for nested evaluation

Term = tuple[tuple[int, ...], int]  # exponents of the dynamic generators, index of coefficient


class Evaluator:
    """Writes ring elements into a program, at the point whose variables are given inputs.

    `pipelined`: of the ways to sum a polynomial take that of least latency, not of fewest
    operations.
    """

    def __init__(
        self, program: Program, ring: Ring, inputs: Mapping[str, int], pipelined: bool
    ) -> None:
        self.program = program
        self.ring = ring
        self.pipelined = pipelined
        self._at: dict[int, int] = {}
        self._inputs = inputs

    def evaluate(self, x: Poly, factor: int | None = None) -> int:
        """The index of x's value, or of its product with a static value (the index `factor`)."""
        used = self.ring.used(x, solved=False)
        for generator in used:
            self.at(generator)
        dynamic = [g.index for g in used if not self.program.static[self._at[g.index]]]
        terms = self._collect(x, dynamic)
        if factor is not None:
            terms = [(outer, self.program.mul(c, factor)) for outer, c in terms]
        return self._nested(terms, [self._at[i] for i in dynamic])

    def on_a_copy(self) -> "Evaluator":
        """The same, writing into a copy of the program."""
        other = Evaluator(self.program.copy(), self.ring, self._inputs, self.pipelined)
        other._at = dict(self._at)
        return other

    def at(self, generator: Generator) -> int:
        """The index of a generator's value."""
        if generator.index not in self._at:
            self._at[generator.index] = self._generator(generator)
        return self._at[generator.index]

    def set(self, generator: Generator, index: int) -> None:
        """Takes a value that the program has already for the generator's."""
        self._at[generator.index] = index

    def _generator(self, g: Generator) -> int:
        if g.kind == "variable":
            return self._inputs[str(g.expression)]
        if g.kind == "pi":
            return self.program._add(Op("pi"), True)
        if g.kind == "stage":
            return self.evaluate(g.argument)
        if g.kind == "solved":
            self._solve(self.ring.systems[g.index])
            return self._at[g.index]
        return self.program.apply(g.kind, self.evaluate(g.argument), degree=g.degree)

    def _solve(self, system: System) -> None:
        """Writes the loop that finds a system's unknowns, with what moves in it inside."""
        ring, program, number = self.ring, self.program, len(self.program.loops)
        inner, given = Program(), set()
        own = Evaluator(inner, ring, {}, self.pipelined)
        unknown = system.unknowns
        for k, g in enumerate(unknown):
            own.set(g, inner.input(f"u{number}_{k}", static=False))
        for g in ring.used(*system.updates, solved=False):
            inside = () if g.argument is None else ring.used(g.argument, solved=False)
            if g not in unknown and not any(x in unknown for x in inside):
                at = self.at(g)
                given.add(at)
                own.set(g, inner.input(f"v{at}", static=program.static[at]))
        updates = tuple(own.evaluate(x) for x in system.updates)
        starts = tuple(self.evaluate(x) for x in system.starts)
        added_to = tuple(self.evaluate(x) for x in system.added_to)
        determinants = tuple(own.evaluate(x) for x in system.determinants)
        loop = Loop(number, inner, updates, starts, added_to, determinants)
        found = program.solve(loop, sorted(given))
        for g, at in zip(unknown, found, strict=True):
            self.set(g, at)

    def _collect(self, x: Poly, dynamic: Sequence[int]) -> list[Term]:
        """x by monomials in the dynamic generators, the static coefficients evaluated."""
        parts: dict[tuple[int, ...], list[tuple[tuple[int, ...], Fraction]]] = {}
        for monomial, c in x.to_dict().items():
            outer = tuple(int(monomial[i]) for i in dynamic)
            inner = tuple(0 if i in dynamic else int(n) for i, n in enumerate(monomial))
            parts.setdefault(outer, []).append((inner, Fraction(int(c.numer()), int(c.denom()))))
        return [(outer, self._static(terms)) for outer, terms in parts.items()]

    def _static(self, terms: Sequence[tuple[tuple[int, ...], Fraction]]) -> int:
        program = self.program
        total = program.constant(Fraction(0))
        for monomial, coefficient in terms:
            product = program.constant(coefficient)
            for index, n in enumerate(monomial):
                if n:
                    product = program.mul(product, program.power(self._at[index], n))
            total = program.add(total, product)
        return total

    def _nested(self, terms: list[Term], variables: list[int]) -> int:
        """The sum of the terms by the cheapest of the ways that are tried.

        Ways: each order of the variables, by Horner's rule (fewest operations) or by Estrin's
        (least latency: pairs of coefficients first, then pairs of pairs).
        """
        orders = [tuple(range(len(variables)))]
        if 1 < len(variables) <= _MOST_VARIABLES:
            orders = list(permutations(range(len(variables))))
        ways = [(order, estrin) for order in orders for estrin in (False, True)]

        def cost(way: tuple[tuple[int, ...], bool]) -> tuple[int, int]:
            trial = Evaluator(self.program.copy(), self.ring, self._inputs, self.pipelined)
            result = trial._sum(terms, variables, *way)
            latency, count = trial.program.depth[result], trial.program.cost
            return (latency, count) if self.pipelined else (count, latency)

        return self._sum(terms, variables, *min(ways, key=cost))

    def _sum(
        self, terms: list[Term], variables: list[int], order: tuple[int, ...], estrin: bool
    ) -> int:
        """The terms as a polynomial in the first variable of `order`, its coefficients likewise."""
        if not order:
            total = self.program.constant(Fraction(0))
            for _, coefficient in terms:
                total = self.program.add(total, coefficient)
            return total
        groups: dict[int, list[Term]] = {}
        for term in terms:
            groups.setdefault(term[0][order[0]], []).append(term)
        coefficients = {
            n: self._sum(group, variables, order[1:], estrin) for n, group in groups.items()
        }
        if len(coefficients) == 1 and 0 in coefficients:
            return coefficients[0]
        evaluate = self._estrin if estrin else self._horner
        return evaluate(coefficients, variables[order[0]])

    def _horner(self, coefficients: dict[int, int], x: int) -> int:
        program = self.program
        powers = sorted(coefficients, reverse=True)
        total = coefficients[powers[0]]
        for above, n in pairwise([*powers, 0]):
            total = program.mul(total, program.power(x, above - n))
            if n in coefficients and n != above:
                total = program.add(total, coefficients[n])
        return total

    def _estrin(self, coefficients: dict[int, int], x: int) -> int:
        """c₀ + c₁ x + (c₂ + c₃ x) x² + …, pairwise again in x²."""
        program = self.program
        while set(coefficients) != {0}:
            paired: dict[int, int] = {}
            for n, c in sorted(coefficients.items()):
                term = program.mul(c, x) if n % 2 else c
                half = n // 2
                paired[half] = program.add(paired[half], term) if half in paired else term
            coefficients, x = paired, program.mul(x, x)
        return coefficients[0]
