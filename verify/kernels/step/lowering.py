"""A program's operations → lines of source, those before the loop over steps and those in it.

If a step solves equations F(Z) = 0, its unknowns Z are computed by Newton's method, in a loop of
their own. The loop ends when an update is at most 2^−(bits + 1) of the p or q that it is added to,
or when the next update would be. Each update is about a multiple of the square of
the update before; the last two, of sizes `last` and `size`, give the multiple, and the size of the
next one, size·(size/last)². This prediction is used once half of the digits are settled. From then
on an update that is no smaller than the one before is rounding only, and ends the loop too.

The wanted solution is the one that tends to 0 with h. Along it ∂F/∂Z, which is the unit matrix at
h = 0, stays regular; so a solution with a determinant that is not positive is another one. The
method starts a second time, at Z = 0, if the determinant is not positive, an update is 2^16 times
as large as the first one and the values it was added to, an unknown leaves the arithmetic's range,
or 25 updates do not settle.

If that fails too, the unknowns are set to 0/0, which ends the run at that step. (If h is so large
that several solutions have a positive determinant, the result may be any of them.)
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

import gmpy2

from verify.arithmetic.number_system import SystemNumber
from verify.kernels.step.kinds import Call, Input, Inverse, Negation, Pi, Root, Solution, Solving
from verify.kernels.step.operations import NewtonLoop, StepProgram

_INFIX = {"add": "+", "sub": "-", "mul": "*"}
_ROOT_GUARD_BITS = 64  # a root of a constant has so many bits more than the arithmetic
MAX_UPDATES = 25  # for a small h 2 … 4 updates give 17 digits, and 5 … 8 give 200
_ATTEMPTS = 2


@dataclass
class Lowering:
    """A writer of a program's lines, with the value of index i in the variable `prefix` + i.

    `functions`: the names of the arithmetic's functions. If `cos_sin` or `sin_cos` is among them,
    cos and sin of one argument are written as one call. If `root` is not, a root of a constant is
    computed beforehand, to `bits` bits and some more. `guard`: a condition on `{x}` that numbers in
    range satisfy (see `verify.arithmetic.number_system`).
    """

    program: StepProgram
    functions: Collection[str]
    prefix: str = "v"
    bits: int = 0
    guard: str | None = None
    _already_written: set[int] = field(default_factory=set)

    def name(self, index: int) -> str:
        """Return the variable that holds an operation's value."""
        return f"{self.prefix}{index}"

    def live(self, roots: Sequence[int]) -> list[int]:
        """Return the operations that the roots need, in their order."""
        return self.program.live(roots)

    def lines(self, roots: Sequence[int]) -> tuple[list[str], list[str]]:
        """Return the lines that compute the roots: those before the loop, and those in it."""
        program, live = self.program, self.live(roots)
        ops, prefix, is_static = program.ops, self.prefix, program.static
        static: list[str] = []
        dynamic: list[str] = []
        for index in live:
            op = ops[index]
            if op.kind == "add" or op.kind == "sub" or op.kind == "mul":
                x, y = op.args
                line = f"{prefix}{index} = {prefix}{x} {_INFIX[op.kind]} {prefix}{y}"
            elif op.kind == "const" or index in self._already_written:
                continue
            elif op.kind == "loop":
                loop = LoopSource(program.loops[op.number], self)
                static += loop.static
                dynamic += loop.lines()
                continue
            else:
                line = self._pair(index, live) or f"{self.name(index)} = {self._operation(index)}"
            (static if is_static[index] else dynamic).append(line)
        return static, dynamic

    def _pair(self, index: int, live: Sequence[int]) -> str | None:
        """Return the line of cos and sin of one argument as one call; None if the arithmetic has no
        such call, or one of the two is not needed."""
        op = self.program.ops[index]
        joint_name = next((f for f in ("cos_sin", "sin_cos") if f in self.functions), None)
        names = joint_name.split("_") if joint_name else ()
        if op.kind != "call" or op.function.name not in names:
            return None
        calls = {
            other.function.name: i
            for i in live
            if isinstance(other := self.program.ops[i], Call) and other.args == op.args
        }
        if not calls.keys() >= {*names}:
            return None
        self._already_written |= {calls[name] for name in names}
        first, second = (self.name(calls[name]) for name in names)
        return f"{first}, {second} = {joint_name}({self.name(op.args[0])})"

    def inner(self, loop: NewtonLoop) -> Lowering:
        """Return the lowering of an inner loop's program, with another prefix."""
        return Lowering(loop.inner, self.functions, f"n{loop.number}_", self.bits)

    def function(self, index: int) -> str | None:
        """Return the name of the function that an operation calls, or None."""
        op = self.program.ops[index]
        if op.kind == "root" and self._radicand(op) is None:
            return "sqrt" if op.degree == 2 else "root"
        return op.function.name if op.kind == "call" else None

    def function_names(self, roots: Sequence[int]) -> set[str]:
        """Return the names of all functions that the roots need, including those in inner loops."""
        live = self.live(roots)
        names = {name for index in live if (name := self.function(index))}
        for loop in self.loops(live):
            names |= self.inner(loop).function_names([*loop.updates, *loop.determinants])
        return names

    def solves(self, roots: Sequence[int]) -> bool:
        """Return True if equations are solved for the roots."""
        return bool(self.loops(self.live(roots)))

    def loops(self, live: Sequence[int]) -> list[NewtonLoop]:
        """Return the inner loops among live operations, in their order."""
        ops = (self.program.ops[index] for index in live)
        return [self.program.loops[op.number] for op in ops if op.kind == "loop"]

    def _operation(self, index: int) -> str:
        op = self.program.ops[index]
        args = [self.name(a) for a in op.args]
        match op:
            case Input(name):
                return name
            case Pi():
                return "pi"
            case Negation():
                return f"-{args[0]}"
            case Inverse():
                return f"1 / {args[0]}"
            case Solution((loop,), number):
                solving = self.program.ops[loop]
                assert isinstance(solving, Solving)  # noqa: S101 - a Solution's argument is one
                return f"u{solving.number}_{number}"
            case Root() if self._radicand(op) is not None:
                return f"number_{self.name(index)}"
            case Root(_, degree) if degree != 2:
                return f"root({args[0]}, {degree})"
        return f"{self.function(index)}({args[0]})"

    def _radicand(self, op: Root) -> Fraction | None:
        """Return the radicand, if it is a positive constant and the arithmetic has no function for
        the root; else None."""
        inner = self.program.ops[op.args[0]]
        if op.degree == 2 or "root" in self.functions or inner.kind != "const":
            return None
        return inner.value if inner.value > 0 else None

    def named_constants(
        self, number: Callable[[Fraction], SystemNumber], roots: Sequence[int] | None = None
    ) -> dict[str, SystemNumber]:
        """Return the constants, and the roots of constants, by name in the source; those that the
        values `roots` need, or all."""
        program, constants = self.program, dict[str, SystemNumber]()
        live = range(len(program.ops)) if roots is None else self.live(roots)
        for index in live:
            op = program.ops[index]
            if op.kind == "const":
                constants[self.name(index)] = number(op.value)
            elif op.kind == "root" and (radicand := self._radicand(op)) is not None:
                root = _root(radicand, op.degree, self.bits + _ROOT_GUARD_BITS)
                constants[f"number_{self.name(index)}"] = number(root)
        for loop in self.loops(live):
            inner_roots = None if roots is None else [*loop.updates, *loop.determinants]
            constants |= self.inner(loop).named_constants(number, inner_roots)
        return constants


def _root(x: Fraction, degree: int, bits: int) -> Fraction:
    """Return x^(1/degree), too small by less than 2^(1 − bits), for x > 0."""
    # The integer division and `iroot` round down, each by less than a unit 2^−bits of the root.
    scaled = (x.numerator << degree * bits) // x.denominator
    return Fraction(int(gmpy2.iroot(gmpy2.mpz(scaled), degree)[0]), 1 << bits)


def newton_constants(
    bits: int, number: Callable[[Fraction], SystemNumber]
) -> dict[str, SystemNumber]:
    """Return the numbers with which Newton's loops compare, by name in the source, for an
    arithmetic with `bits` bits."""
    return {
        "newton_zero": number(Fraction(0)),
        "newton_last": number(Fraction(1, 2 ** (bits + 1))),
        "newton_half": number(Fraction(1, 2 ** (bits // 2))),
        "newton_most": number(Fraction(2**16)),
    }


class LoopSource:
    """A writer of one loop of Newton's method, whose unknowns are `u<number>_0`, `u<number>_1`, ….

    `static`: the lines before the loop over steps. `turn`: the lines of one iteration that compute
    the updates, to be subtracted, and the factors of the determinant of ∂F/∂Z.
    """

    def __init__(self, loop: NewtonLoop, outer: Lowering) -> None:
        inner, self.prefix = outer.inner(loop), f"u{loop.number}_"
        self.unknowns = [f"{self.prefix}{k}" for k in range(len(loop.updates))]
        self.starts, self.added_to = (
            list(map(outer.name, x)) for x in (loop.starts, loop.added_to)
        )
        self.updates = list(map(inner.name, loop.updates))
        self.determinants = list(map(inner.name, loop.determinants))
        self.static, self.turn = inner.lines([*loop.updates, *loop.determinants])
        self.guard = outer.guard

    def lines(self) -> list[str]:
        """Return the statements of both attempts."""
        converged = f"{self.prefix}found"  # a name in the source
        pairs = zip(self.unknowns, self.starts, strict=True)
        positive = " * ".join(self.determinants)
        attempt = [
            f"{converged} = 0",
            f"for turn in range({MAX_UPDATES}):",
            *(f"    {line}" for line in self._iteration_lines(f"{converged} = 1")),
            f"if {converged} == 1 and {positive} > newton_zero: break",
            f"if attempt == {_ATTEMPTS - 1}:",
            *(f"    {u} = ({u} - {u}) / ({u} - {u})" for u in self.unknowns),
            "    break",
            *(f"{u} = newton_zero" for u in self.unknowns),
        ]
        # The first values of these names are never read: they give the variables a kind.
        names = [self.prefix + n for n in ("size", "last", "first", "ratio")]
        names += [x for x in self.determinants if any(s.startswith(f"{x} =") for s in self.turn)]
        return [
            *(f"{u} = {x}" for u, x in pairs),
            f"{' = '.join(names)} = newton_zero",
            f"for attempt in range({_ATTEMPTS}):",
            *(f"    {line}" for line in attempt),
        ]

    def _iteration_lines(self, stop: str) -> list[str]:
        """Return the statements of one iteration; the statement `stop` is executed if the method
        has converged."""
        size, last, first, ratio = (self.prefix + n for n in ("size", "last", "first", "ratio"))
        pairs = zip(self.unknowns, self.updates, strict=True)
        sizes, widths, small = self._by_component()
        total_width = " + ".join(width for width, _ in widths)
        end = [f"    {stop}", "    break"]
        return [
            *self._guard_lines(),
            *self.turn,
            *(f"{u} = {u} - {d}" for u, d in pairs),
            *(f"{name} = {sum_}" for name, sum_ in (*sizes, *widths)),
            f"{size} = {' + '.join(name for name, _ in sizes)}",
            f"if {small('')}:",
            *end,
            # The first iteration sets the scale: an update 2^16 times as large has diverged.
            f"if turn == 0: {first} = {size} + {total_width}",
            f"if turn > 0 and {size} <= newton_half * ({total_width}):",
            f"    {ratio} = {size} / {last}",
            f"    if {size} >= {last} or {small(f' * {ratio} * {ratio}')}:",
            *(f"    {line}" for line in end),
            f"if not {size} <= newton_most * {first}: break",
            f"{last} = {size}",
        ]

    def _by_component(
        self,
    ) -> tuple[list[tuple[str, str]], list[tuple[str, str]], Callable[[str], str]]:
        """Return (sizes, widths, small).

        `sizes` and `widths` have (name, formula) for each coordinate: the sum of |update|, and that
        of |value| to which the updates are added. `small(factor)` is the condition that every size
        times a factor is at most 2^−(bits + 1) of its width.
        """
        sizes, widths = [], []
        for part, base in enumerate(dict.fromkeys(self.added_to)):
            members = [k for k, name in enumerate(self.added_to) if name == base]
            total = " + ".join(f"abs({self.updates[k]})" for k in members)
            sizes.append((f"{self.prefix}by{part}", total))
            total = " + ".join(f"abs({x})" for x in (base, *(self.unknowns[k] for k in members)))
            widths.append((f"{self.prefix}of{part}", total))

        def small(factor: str) -> str:
            pairs = zip(sizes, widths, strict=True)
            return " and ".join(f"{x}{factor} <= newton_last * {w}" for (x, _), (w, _) in pairs)

        return sizes, widths, small

    def _guard_lines(self) -> list[str]:
        if self.guard is None:
            return []
        inside = " and ".join(self.guard.format(x=u) for u in self.unknowns)
        return [f"if not ({inside}): break"]
