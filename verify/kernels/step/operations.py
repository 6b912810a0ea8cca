"""A straight-line program: operations without repetitions, and loops that solve equations.

An operation with the same arguments as an earlier one gets the earlier one's index, so a common
subexpression is computed once. An operation on the step size, the parameters and constants alone is
`static`, and is computed once, before the loop. Constants are exact rationals; an arithmetic
converts them when a kernel is written.

To try a form of a sum, it is written into the program and cut off again; the best one is put back.
So a trial costs only the operations that it adds, however long the program is.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

from verify.functions.function import Function
from verify.kernels.step import kinds
from verify.kernels.step.kinds import Op

_SIMPLIFYING = (0, 1, -1)  # a product or a sum with one of these constants needs no operation


@dataclass(frozen=True)
class NewtonLoop:
    """Newton's method: x_k ← x_k − `updates`[k] in `inner`, from the outer program's `starts`[k].

    `determinants`: factors, in `inner`, whose product is the determinant of the matrix of the
    linear system. `added_to`[k]: the value to which x_k is added, which sets its scale. In `inner`
    the inputs `u<number>_<k>` are the unknowns x_k, and `v<index>` are values of the outer program.
    """

    number: int
    inner: "StepProgram"
    updates: tuple[int, ...]
    starts: tuple[int, ...]
    added_to: tuple[int, ...]
    determinants: tuple[int, ...]


Key = tuple[object, ...]  # identifies a result: its operation, with indices, numbers or texts


class Mark(NamedTuple):
    """The length of a program at some moment: its operations, keys and loops; and its cost."""

    ops: int
    keys: int
    loops: int
    cost: int


class Tail(NamedTuple):
    """The part of a program behind a mark."""

    ops: list[Op]
    static: list[bool]
    depth: list[int]
    keys: list[Key]
    indices: list[int]
    loops: list[NewtonLoop]
    cost: int


class StepProgram:
    """A growing list of operations; a method that adds one returns the index of its result.

    `cost`: that of all operations in the loop over steps. `depth`: for each value the latency of
    the longest path to it.
    """

    def __init__(self) -> None:
        self.loops: list[NewtonLoop] = []
        self.ops: list[Op] = []
        self.static: list[bool] = []
        self.depth: list[int] = []
        self.cost = 0
        # Keys have numerators and denominators, since the hash of a Fraction takes long.
        self._index_of: dict[Key, int] = {}
        self._keys: list[Key] = []  # the keys of `_index_of` in their order
        self._special: dict[int, int] = {}  # index → value of the constants 0, 1 and −1
        self._live: dict[tuple[int, ...], tuple[int, list[int]]] = {}

    def copy(self) -> "StepProgram":
        """Return a copy that grows on its own from here."""
        program = StepProgram()
        program.put_back(Tail(self.ops, self.static, self.depth, self._keys,
                            list(self._index_of.values()), self.loops, self.cost))  # fmt: skip
        return program

    # -- trials -------------------------------------------------------------------------------

    def mark(self) -> Mark:
        """Return the mark of the present end, for `cut`."""
        return Mark(len(self.ops), len(self._keys), len(self.loops), self.cost)

    def cut(self, mark: Mark) -> Tail:
        """Remove and return everything written since the mark."""
        index_of, keys = self._index_of, self._keys[mark.keys :]
        tail = Tail(
            self.ops[mark.ops :], self.static[mark.ops :], self.depth[mark.ops :],
            keys, [index_of.pop(key) for key in keys], self.loops[mark.loops :], self.cost,
        )  # fmt: skip
        del self.ops[mark.ops :], self.static[mark.ops :], self.depth[mark.ops :]
        del self._keys[mark.keys :], self.loops[mark.loops :]
        self.cost = mark.cost
        self._live.clear()  # a later program may have the same length and other operations
        if any(index >= mark.ops for index in self._special):
            self._special = {i: x for i, x in self._special.items() if i < mark.ops}
        return tail

    def put_back(self, tail: Tail) -> None:
        """Append a tail that was cut off at the present end."""
        self.ops += tail.ops
        self.static += tail.static
        self.depth += tail.depth
        self._keys += tail.keys
        self._index_of.update(zip(tail.keys, tail.indices, strict=True))
        self.loops += tail.loops
        self.cost = tail.cost
        self._special.update(
            (i, x) for x in _SIMPLIFYING if (i := self._index_of.get((x, 1))) is not None
        )

    def live(self, roots: Sequence[int]) -> list[int]:
        """Return the indices of the operations that the roots need, in their order."""
        length, live = self._live.get(key := tuple(roots), (-1, []))
        if length != len(self.ops):
            live = self._find_live(roots)
            self._live[key] = len(self.ops), live
        return live

    def _find_live(self, roots: Sequence[int]) -> list[int]:
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
        self._index_of[key] = index
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
        existing = self._index_of.get(key)
        if existing is not None:
            return existing
        index, depth = len(self.ops), self.depth
        self._index_of[key] = index
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
        """Return the input of that name; `static`: it is the same in all steps."""
        key = "input", name
        existing = self._index_of.get(key)
        return self._new(key, kinds.Input(name), static) if existing is None else existing

    def constant(self, value: Fraction) -> int:
        return self.quotient(value.numerator, value.denominator)

    def quotient(self, numerator: int, denominator: int) -> int:
        """Return the constant numerator/denominator, which must be in lowest terms with a positive
        denominator."""
        key = numerator, denominator
        existing = self._index_of.get(key)
        if existing is not None:
            return existing
        index = self._new(key, kinds.RationalConstant(Fraction(numerator, denominator)), True)
        if denominator == 1 and numerator in _SIMPLIFYING:
            self._special[index] = numerator
        return index

    def pi(self) -> int:
        """Return π."""
        existing = self._index_of.get(("pi",))
        return self._new(("pi",), kinds.Pi(), True) if existing is None else existing

    def inverse(self, x: int) -> int:
        """Return 1/x."""
        return self._unary(("inverse", x), kinds.Inverse((x,)))

    def root(self, x: int, degree: int) -> int:
        """Return x^(1/degree)."""
        return self._unary(("root", degree, x), kinds.Root((x,), degree))

    def call(self, function: Function, x: int) -> int:
        """Return the function's value at x."""
        return self._unary((function.name, x), kinds.Call((x,), function))

    def _unary(self, key: Key, op: kinds.Unary) -> int:
        existing = self._index_of.get(key)
        return self._new(key, op, self.static[op.args[0]]) if existing is None else existing

    def solve(self, loop: NewtonLoop, more_read: Sequence[int]) -> list[int]:
        """Return the unknowns that a loop computes. `more_read`: the values of this program that
        the loop reads, besides its `starts` and `added_to`."""
        self.loops.append(loop)
        args = (*loop.starts, *loop.added_to, *more_read)
        solving = self._new(("loop", loop.number), kinds.Solving(args, loop.number), False)
        return [
            self._new(("solved", solving, k), kinds.Solution((solving,), k), False)
            for k in range(len(loop.starts))
        ]

    def is_constant(self, x: int, value: int) -> bool:
        """Return True if x is the index of the integer constant `value`."""
        return self._index_of.get((value, 1)) == x

    def neg(self, x: int) -> int:
        """Return −x."""
        op = self.ops[x]
        if op.kind == "const":
            return self.quotient(-op.value.numerator, op.value.denominator)
        if op.kind == "neg":
            return op.args[0]
        return self._unary(("neg", x), kinds.Negation((x,)))

    # Identities with 0, ±1 and signs are applied when an operation is added, so that equal values
    # get one index in whatever form they are written.
    def add(self, x: int, y: int) -> int:
        """Return x + y."""
        special, ops = self._special, self.ops
        if x in special and special[x] == 0:
            return y
        if y in special and special[y] == 0:
            return x
        if ops[y].kind == "neg":
            return self._binary(kinds.Subtraction, x, ops[y].args[0])
        if ops[x].kind == "neg":
            return self._binary(kinds.Subtraction, y, ops[x].args[0])
        # Commutative operations are stored with sorted arguments, so that x + y and y + x are one.
        return self._binary(kinds.Addition, x, y) if x <= y else self._binary(kinds.Addition, y, x)

    def mul(self, x: int, y: int) -> int:
        """Return x y."""
        special, ops, static = self._special, self.ops, self.static
        if x in special:
            return self._multiple(special[x], x, y)
        # Signs are moved outwards, where they merge with sums or cancel; static ones cost nothing,
        # and stay.
        if ops[x].kind == "neg" and not static[x]:
            return self.neg(self.mul(ops[x].args[0], y))
        if y in special:
            return self._multiple(special[y], y, x)
        if ops[y].kind == "neg" and not static[y]:
            return self.neg(self.mul(ops[y].args[0], x))
        return (
            self._binary(kinds.Multiplication, x, y)
            if x <= y
            else self._binary(kinds.Multiplication, y, x)
        )

    def _multiple(self, n: int, constant: int, x: int) -> int:
        """Return n x for n = 0, 1, −1; `constant` is the index of the constant n."""
        if n == 0:
            return constant
        return x if n == 1 else self.neg(x)

    def times(self, x: int, n: int) -> int:
        """Return n x for a positive integer n, by sums."""
        return _combine_repeatedly(self.add, x, n)

    def power(self, x: int, n: int) -> int:
        """Return xⁿ, n ≥ 0."""
        return _combine_repeatedly(self.mul, x, n) if n else self.quotient(1, 1)


def _combine_repeatedly(combine: Callable[[int, int], int], x: int, n: int) -> int:
    """Combine n copies of x, by doubling."""
    if n == 1:
        return x
    half = _combine_repeatedly(combine, x, n // 2)
    double = combine(half, half)
    return combine(double, x) if n % 2 else double
