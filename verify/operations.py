"""A straight-line program: operations, none of them twice, and loops that solve equations.

Operations are hash-consed, so a subexpression that occurs twice is computed once. What depends
only on the step size, the parameters and constants is `static`, and is computed once before the
loop. Constants stay exact rationals; an arithmetic converts them at the edge.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

_LATENCY = {"add": 1, "sub": 1, "mul": 1, "neg": 1, "inverse": 4}
_FUNCTION_LATENCY = 20
_COST = {"input": 0, "add": 1, "sub": 1, "neg": 1, "mul": 4}
_COST_OF_FUNCTION = 40


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

    `determinants`: of the blocks of what it divides by. `added_to`[k] is what x_k is a change of,
    which gives it its scale. In `inner` the inputs `u<number>_<k>` are the unknowns x_k, and
    `v<index>` are values of the outer program.
    """

    number: int
    inner: "Program"
    updates: tuple[int, ...]
    starts: tuple[int, ...]
    added_to: tuple[int, ...]
    determinants: tuple[int, ...]


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
        read = (*loop.starts, *loop.added_to, *given)
        made = self._add(Op("loop", read, degree=loop.number), False)
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
