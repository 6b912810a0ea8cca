"""A straight-line program: operations, none of them twice, and loops that solve equations.

Operations are hash-consed, so a subexpression that occurs twice is computed once. What depends
only on the step size, the parameters and constants is `static`, and is computed once before the
loop. Constants stay exact rationals; an arithmetic converts them at the edge.

A way to write something is tried in the program itself, and taken back; what is best is put back as
it was. So a trial costs what it adds, however long the program is.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

from verify.functions.function import Function
from verify.kernels.step import kinds
from verify.kernels.step.kinds import Op as Op

_SPECIAL = (0, 1, -1)  # constants that products and sums are shorter with


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


Key = tuple[object, ...]  # what a result is of: its operation, and indices, numbers or texts


class Mark(NamedTuple):
    """How long a program was: its operations, what is known of them, its loops, and their cost."""

    ops: int
    keys: int
    loops: int
    cost: int


class Tail(NamedTuple):
    """What a program had beyond a mark."""

    ops: list[Op]
    static: list[bool]
    depth: list[int]
    keys: list[Key]
    known: list[int]
    loops: list[Loop]
    cost: int


class Program:
    """A growing list of operations; each method returns the index of its result.

    `cost`: what the loop's operations cost; a product is worth several sums.
    """

    def __init__(self) -> None:
        self.loops: list[Loop] = []
        self.ops: list[Op] = []
        self.static: list[bool] = []
        self.depth: list[int] = []
        self.cost = 0
        # Results by what they are of: numbers and texts, as the hash of a Fraction takes long.
        self._known: dict[Key, int] = {}
        self._keys: list[Key] = []  # of `_known`, in their order
        self._special: dict[int, int] = {}  # which constants are 0, 1 and −1
        self._live: dict[tuple[int, ...], tuple[int, list[int]]] = {}

    def copy(self) -> "Program":
        """One that grows on its own from here."""
        other = Program()
        other.put_back(Tail(self.ops, self.static, self.depth, self._keys,
                            list(self._known.values()), self.loops, self.cost))  # fmt: skip
        return other

    # -- trials -------------------------------------------------------------------------------

    def mark(self) -> Mark:
        return Mark(len(self.ops), len(self._keys), len(self.loops), self.cost)

    def cut(self, mark: Mark) -> Tail:
        """Takes back all that was written since the mark."""
        known, keys = self._known, self._keys[mark.keys :]
        tail = Tail(
            self.ops[mark.ops :], self.static[mark.ops :], self.depth[mark.ops :],
            keys, [known.pop(key) for key in keys], self.loops[mark.loops :], self.cost,
        )  # fmt: skip
        del self.ops[mark.ops :], self.static[mark.ops :], self.depth[mark.ops :]
        del self._keys[mark.keys :], self.loops[mark.loops :]
        self.cost = mark.cost
        self._live.clear()  # what is written next may be as long, and is other
        if any(index >= mark.ops for index in self._special):
            self._special = {i: x for i, x in self._special.items() if i < mark.ops}
        return tail

    def put_back(self, tail: Tail) -> None:
        """Writes what was cut off where the program now ends."""
        self.ops += tail.ops
        self.static += tail.static
        self.depth += tail.depth
        self._keys += tail.keys
        self._known.update(zip(tail.keys, tail.known, strict=True))
        self.loops += tail.loops
        self.cost = tail.cost
        self._special.update((i, x) for x in _SPECIAL if (i := self._known.get((x, 1))) is not None)

    def live(self, roots: Sequence[int]) -> list[int]:
        """The operations that the roots need, in their order."""
        length, live = self._live.get(key := tuple(roots), (-1, []))
        if length != len(self.ops):
            live = self._found_live(roots)
            self._live[key] = len(self.ops), live
        return live

    def _found_live(self, roots: Sequence[int]) -> list[int]:
        ops, live, stack = self.ops, set[int](), list(roots)
        while stack:
            index = stack.pop()
            if index not in live:
                live.add(index)
                stack += ops[index].args
        return sorted(live)

    # -- operations ---------------------------------------------------------------------------

    def _new(self, key: Key, op: Op, static: bool) -> int:
        index = len(self.ops)
        self._known[key] = index
        self._keys.append(key)
        self.ops.append(op)
        self.static.append(static)
        if static:
            self.depth.append(0)
            return index
        depth = self.depth
        depth.append(max([depth[a] for a in op.args], default=0) + op.latency)
        self.cost += op.cost
        return index

    def _binary(self, kind: type[kinds.Binary], x: int, y: int) -> int:
        key = kind, x, y
        found = self._known.get(key)
        if found is not None:
            return found
        index, depth = len(self.ops), self.depth
        self._known[key] = index
        self._keys.append(key)
        self.ops.append(kind((x, y)))
        if self.static[x] and self.static[y]:
            self.static.append(True)
            depth.append(0)
        else:
            self.static.append(False)
            depth.append((depth[x] if depth[x] > depth[y] else depth[y]) + kind.latency)
            self.cost += kind.cost
        return index

    def input(self, name: str, *, static: bool) -> int:
        key = "input", name
        found = self._known.get(key)
        return self._new(key, kinds.Input(name), static) if found is None else found

    def constant(self, value: Fraction) -> int:
        return self.quotient(value.numerator, value.denominator)

    def quotient(self, numerator: int, denominator: int) -> int:
        """The constant that is their quotient, in lowest terms with a positive denominator."""
        key = numerator, denominator
        found = self._known.get(key)
        if found is not None:
            return found
        index = self._new(key, kinds.Constant(Fraction(numerator, denominator)), True)
        if denominator == 1 and numerator in _SPECIAL:
            self._special[index] = numerator
        return index

    def pi(self) -> int:
        """π."""
        at = self._known.get(("pi",))
        return self._new(("pi",), kinds.Pi(), True) if at is None else at

    def inverse(self, x: int) -> int:
        """1/x."""
        return self._of_one(("inverse", x), kinds.Inverse((x,)))

    def root(self, x: int, degree: int) -> int:
        """x^(1/degree)."""
        return self._of_one(("root", degree, x), kinds.Root((x,), degree))

    def call(self, function: Function, x: int) -> int:
        """A function of x."""
        return self._of_one((function.name, x), kinds.Call((x,), function))

    def _of_one(self, key: Key, op: kinds.Unary) -> int:
        at = self._known.get(key)
        return self._new(key, op, self.static[op.args[0]]) if at is None else at

    def solve(self, loop: Loop, given: Sequence[int]) -> list[int]:
        """The values that a loop finds; `given`: what it reads of this program."""
        self.loops.append(loop)
        read = (*loop.starts, *loop.added_to, *given)
        made = self._new(("loop", loop.number), kinds.Solving(read, loop.number), False)
        return [
            self._new(("solved", made, k), kinds.Solution((made,), k), False)
            for k in range(len(loop.starts))
        ]

    def is_constant(self, x: int, value: int) -> bool:
        return self._known.get((value, 1)) == x

    def neg(self, x: int) -> int:
        op = self.ops[x]
        if op.kind == "const":
            return self.quotient(-op.value.numerator, op.value.denominator)
        if op.kind == "neg":
            return op.args[0]
        return self._of_one(("neg", x), kinds.Opposite((x,)))

    def add(self, x: int, y: int) -> int:
        special, ops = self._special, self.ops
        if x in special and special[x] == 0:
            return y
        if y in special and special[y] == 0:
            return x
        if ops[y].kind == "neg":
            return self._binary(kinds.Difference, x, ops[y].args[0])
        if ops[x].kind == "neg":
            return self._binary(kinds.Difference, y, ops[x].args[0])
        return self._binary(kinds.Sum, x, y) if x <= y else self._binary(kinds.Sum, y, x)

    def mul(self, x: int, y: int) -> int:
        special, ops, static = self._special, self.ops, self.static
        if x in special:
            return self._multiple(special[x], x, y)
        if ops[x].kind == "neg" and not static[x]:
            return self.neg(self.mul(ops[x].args[0], y))
        if y in special:
            return self._multiple(special[y], y, x)
        if ops[y].kind == "neg" and not static[y]:
            return self.neg(self.mul(ops[y].args[0], x))
        return self._binary(kinds.Product, x, y) if x <= y else self._binary(kinds.Product, y, x)

    def _multiple(self, n: int, constant: int, x: int) -> int:
        """n x for n = 0, 1, −1, which is a constant of that index."""
        if n == 0:
            return constant
        return x if n == 1 else self.neg(x)

    def times(self, x: int, n: int) -> int:
        """n x for a positive integer n, by sums."""
        return _repeated(self.add, x, n)

    def power(self, x: int, n: int) -> int:
        return _repeated(self.mul, x, n) if n else self.quotient(1, 1)


def _repeated(combine: Callable[[int, int], int], x: int, n: int) -> int:
    """n of x combined, by doubling."""
    if n == 1:
        return x
    half = _repeated(combine, x, n // 2)
    double = combine(half, half)
    return combine(double, x) if n % 2 else double
