"""Polynomials in generators → a straight-line program: one operation a line, nothing twice.

Operations are hash-consed, so a subexpression that occurs twice is computed once. What depends
only on the step size, the parameters and constants is `static`, and is computed once before the
loop; so a polynomial in p and q keeps one coefficient per monomial, whatever h and the parameters
look like inside it. Constants stay exact rationals; an arithmetic converts them at the edge.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise, permutations

from verify.generator import Generator
from verify.ring import Poly, Ring
from verify.solved import System

_LATENCY = {"add": 1, "sub": 1, "mul": 1, "neg": 1, "inverse": 4}
_FUNCTION_LATENCY = 20
_COST = {"input": 0, "add": 1, "sub": 1, "neg": 1, "mul": 4}
_COST_OF_FUNCTION = 40
_MOST_VARIABLES = 4  # of which all orders are tried for nested evaluation

Term = tuple[tuple[int, ...], int]  # exponents of the dynamic generators, index of coefficient


@dataclass(frozen=True)
class Op:
    """`kind`: input, const, add, sub, mul, neg, inverse, root, loop, solved, or a function's name.

    `loop` is the program's loop number `degree`, and depends on `args`; `solved` is the unknown of
    number `degree` that a loop, its one argument, has found.
    """

    kind: str
    args: tuple[int, ...] = ()
    name: str = ""
    value: Fraction = Fraction(0)
    degree: int = 1


@dataclass(frozen=True)
class Loop:
    """Newton's method: x_k ← x_k − `updates`[k] in `inner`, from the outer program's `starts`[k].

    `added_to`[k] is what x_k is a change of, which gives it its scale. In `inner` the inputs `u<number>_<k>` are the unknowns x_k, and `v<index>` are values of the
    outer program.
    """

    number: int
    inner: "Program"
    updates: tuple[int, ...]
    starts: tuple[int, ...]
    added_to: tuple[int, ...]


class Program:
    """A growing list of operations; each method returns the index of its result."""

    def __init__(self) -> None:
        self.loops: list[Loop] = []
        self.ops: list[Op] = []
        self.static: list[bool] = []
        self.depth: list[int] = []
        self._known: dict[Op, int] = {}

    def _add(self, op: Op, static: bool) -> int:
        if op not in self._known:
            self._known[op] = len(self.ops)
            self.ops.append(op)
            self.static.append(static)
            ready = max((self.depth[a] for a in op.args), default=0)
            cost = 0 if static else _LATENCY.get(op.kind, _FUNCTION_LATENCY if op.args else 0)
            self.depth.append(0 if static else ready + cost)
        return self._known[op]

    def copy(self) -> "Program":
        """One that grows on its own from here."""
        other = Program()
        other.ops, other.static, other.depth = self.ops[:], self.static[:], self.depth[:]
        other.loops = self.loops[:]
        other._known = dict(self._known)
        return other

    @property
    def cost(self) -> int:
        """What the loop's operations cost; a product is worth several sums."""
        return sum(
            _COST.get(op.kind, _COST_OF_FUNCTION)
            for op, static in zip(self.ops, self.static, strict=True)
            if not static
        )

    def input(self, name: str, *, static: bool) -> int:
        return self._add(Op("input", name=name), static)

    def constant(self, value: Fraction) -> int:
        return self._add(Op("const", value=value), True)

    def apply(self, kind: str, *args: int, degree: int = 1) -> int:
        """A function, `neg`, `inverse` or `root` of earlier results."""
        return self._add(Op(kind, args, degree=degree), all(self.static[a] for a in args))

    def solve(self, loop: Loop, given: Sequence[int]) -> list[int]:
        """The values that a loop finds; `given`: what it reads of this program."""
        self.loops.append(loop)
        made = self._add(Op("loop", (*loop.starts, *loop.added_to, *given), degree=loop.number), False)
        return [self._add(Op("solved", (made,), degree=k), False) for k in range(len(loop.starts))]

    def is_constant(self, x: int, value: int) -> bool:
        return self.ops[x].kind == "const" and self.ops[x].value == value

    def neg(self, x: int) -> int:
        if self.ops[x].kind == "const":
            return self.constant(-self.ops[x].value)
        if self.ops[x].kind == "neg":
            return self.ops[x].args[0]
        return self.apply("neg", x)

    def add(self, x: int, y: int) -> int:
        for a, b in ((x, y), (y, x)):
            if self.is_constant(a, 0):
                return b
        if self.ops[y].kind == "neg":
            return self.apply("sub", x, self.ops[y].args[0])
        if self.ops[x].kind == "neg":
            return self.apply("sub", y, self.ops[x].args[0])
        return self.apply("add", *sorted((x, y)))

    def mul(self, x: int, y: int) -> int:
        for a, b in ((x, y), (y, x)):
            if self.is_constant(a, 0):
                return a
            if self.is_constant(a, 1):
                return b
            if self.is_constant(a, -1):
                return self.neg(b)
            if self.ops[a].kind == "neg" and not self.static[a]:
                return self.neg(self.mul(self.ops[a].args[0], b))
        return self.apply("mul", *sorted((x, y)))

    def times(self, x: int, n: int) -> int:
        """n x for a positive integer n, by sums."""
        if n == 1:
            return x
        half = self.times(x, n // 2)
        double = self.add(half, half)
        return self.add(double, x) if n % 2 else double

    def power(self, x: int, n: int) -> int:
        if n == 0:
            return self.constant(Fraction(1))
        if n == 1:
            return x
        half = self.power(x, n // 2)
        square = self.mul(half, half)
        return self.mul(square, x) if n % 2 else square


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
        loop = Loop(number, inner, updates, starts, added_to)
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
