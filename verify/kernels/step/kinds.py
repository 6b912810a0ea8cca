"""The kinds of operations of a straight-line program, with their costs.

`args` are the indices of earlier results; `kind` is the kind's name. `latency` and `cost` count for
operations in the loop, in units of a sum: the time until the result is available, and the work.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar, Literal, TypeAlias

from verify.functions.function import Function


@dataclass(frozen=True, slots=True)
class _OfNone:
    args: ClassVar[tuple[()]] = ()
    latency: ClassVar[int] = 0
    cost: ClassVar[int] = 0


@dataclass(frozen=True, slots=True)
class _OfOne:
    args: tuple[int]
    latency: ClassVar[int] = 20
    cost: ClassVar[int] = 40


@dataclass(frozen=True, slots=True)
class _OfTwo:
    args: tuple[int, int]
    latency: ClassVar[int] = 1
    cost: ClassVar[int] = 1


@dataclass(frozen=True, slots=True)
class Input(_OfNone):
    """A named input."""

    kind: ClassVar[Literal["input"]] = "input"
    name: str


@dataclass(frozen=True, slots=True)
class RationalConstant(_OfNone):
    """A rational number."""

    kind: ClassVar[Literal["const"]] = "const"
    value: Fraction


class Pi(_OfNone):
    """π."""

    __slots__ = ()
    kind: ClassVar[Literal["pi"]] = "pi"


class Addition(_OfTwo):
    """x + y."""

    __slots__ = ()
    kind: ClassVar[Literal["add"]] = "add"


class Subtraction(_OfTwo):
    """x − y."""

    __slots__ = ()
    kind: ClassVar[Literal["sub"]] = "sub"


class Multiplication(_OfTwo):
    """x y."""

    __slots__ = ()
    kind: ClassVar[Literal["mul"]] = "mul"
    cost = 4


class Negation(_OfOne):
    """−x."""

    __slots__ = ()
    kind: ClassVar[Literal["neg"]] = "neg"
    latency = cost = 1


class Inverse(_OfOne):
    """1/x."""

    __slots__ = ()
    kind: ClassVar[Literal["inverse"]] = "inverse"
    latency = 4


@dataclass(frozen=True, slots=True)
class Root(_OfOne):
    """x^(1/degree)."""

    kind: ClassVar[Literal["root"]] = "root"
    degree: int


@dataclass(frozen=True, slots=True)
class Call(_OfOne):
    """A function of x."""

    kind: ClassVar[Literal["call"]] = "call"
    function: Function


@dataclass(frozen=True, slots=True)
class Solution(_OfOne):
    """One unknown, by its number, of a loop of Newton's method, which is the one argument."""

    kind: ClassVar[Literal["solved"]] = "solved"
    number: int


@dataclass(frozen=True, slots=True)
class Solving:
    """A loop of Newton's method, by its number in the program; it reads `args`."""

    kind: ClassVar[Literal["loop"]] = "loop"
    args: tuple[int, ...]
    number: int
    latency: ClassVar[int] = 20
    cost: ClassVar[int] = 40


Unary: TypeAlias = Negation | Inverse | Root | Call
Binary: TypeAlias = Addition | Subtraction | Multiplication
Op: TypeAlias = Input | RationalConstant | Pi | Unary | Binary | Solving | Solution


def may_leave_range(op: Op) -> bool:
    """Return True if the value may leave a range ±r that contains the argument: the kernel's guard
    must then check it."""
    return op.kind in ("inverse", "root") or (op.kind == "call" and op.function.lipschitz is None)
