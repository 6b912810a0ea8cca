"""A number system: its numbers, its description, and what a kernel needs at one precision."""

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from types import CodeType
from typing import TYPE_CHECKING, Any, Protocol, Self, TypeVar

from verify.lockstep import Course

if TYPE_CHECKING:
    from verify.arithmetic.arb import Ball

SystemNumber = object  # of some system, whose functions alone take it apart
Rounding = Callable[[str, int, "Ball"], "Ball"]
State = Sequence[Any]  # the numbers that a kernel carries
Walk = Callable[[Callable[..., Any], int, int, State, State, int], Course[list[State]]]


class Element(Protocol):
    """A number that can be added, multiplied and divided by integers: of a ring, a field, or a
    ball."""

    def __neg__(self) -> Self: ...

    def __add__(self, other: Self, /) -> Self: ...

    def __sub__(self, other: Self, /) -> Self: ...

    def __mul__(self, other: Self | int, /) -> Self: ...

    def __truediv__(self, other: int, /) -> Self: ...


E = TypeVar("E", bound=Element)


@dataclass(frozen=True)
class Arithmetic:
    """One number system at one precision.

    `number` rounds an exact rational once; `exact` gives the rational that a number is. Inside
    `context()` the operators of its numbers and `functions` round as this arithmetic does; whoever
    uses them or calls a kernel enters it, and it leaves nothing changed. `compile` turns a kernel's
    source, which uses + − * / and the names in `functions`, into the function of that name. `guard`
    is a condition on `{x}`, put into the loop, that holds while the orbit is in range (None if
    infinities propagate and are found afterwards). `pipelined`: independent operations overlap, so
    that latency counts and not their number. `chunk`: steps between looks at progress and
    interruption. `absolute`: numbers have so many bits after the point, not so many significant
    ones; a kernel then scales ΔJ and has limits of its own instead of a guard. `radius`, if a
    number is an enclosure: how far from `exact` the true value may be, and `minimum` and `maximum`
    are then among the functions. `rounding`: how far the result of an operation may be off, by its
    kind in a program, its degree (of a root) and its size, a bound of |exact| and |computed|; None
    if that is not known. `walk`: what does the work of `states`, if that is
    done for several orbits together. Two arithmetics of one name and precision are equal.
    """

    name: str
    bits: int
    number: Callable[[Fraction], Any] = field(compare=False)
    exact: Callable[[Any], Fraction] = field(compare=False)
    finite: Callable[[Any], bool] = field(compare=False)
    context: Callable[[], AbstractContextManager[Any]] = field(compare=False)
    functions: Mapping[str, Any] = field(compare=False)
    compile: Callable[[str, str, Mapping[str, Any]], Callable[..., Any]] = field(compare=False)
    guard: str | None = field(compare=False)
    pipelined: bool = field(compare=False)
    chunk: int = field(compare=False)
    absolute: bool = field(default=False, compare=False)
    radius: Callable[[Any], Fraction] | None = field(default=None, compare=False)
    rounding: Rounding | None = field(default=None, compare=False)
    walk: "Walk | None" = field(default=None, compare=False)

    def expect(self, kernel: Callable[..., Any], steps: int) -> None:
        """Announce that so many steps of the kernel will be requested, of one orbit or of many."""
        if self.walk is not None:
            kernel.expect(steps)  # type: ignore[attr-defined]

    def states(
        self,
        kernel: Callable[..., Any],
        every: int,
        stops: int,
        fixed: State,
        state: State,
        later_steps: int = 0,
    ) -> Course[list[State]]:
        """Return what a kernel carries after `every` steps, twice as many, … from a state, `stops`
        times; fewer if a number left the arithmetic's range on the way.

        `fixed`: its arguments between the number of steps and what it carries. `later_steps`: the
        number of steps of this orbit that will be requested after these.
        """
        if self.walk is not None:
            return (yield from self.walk(kernel, every, stops, fixed, state, later_steps))
        reached: list[State] = []
        try:
            with self.context():
                after = state
                for _ in range(stops):
                    done, *after = kernel(every, *fixed, *after)
                    if done < every or not all(map(self._in_range, after)):
                        break
                    reached.append(after)
        except (ArithmeticError, ValueError):  # a pole, the log or root of a negative
            if stops > 1:
                return (yield from self._one_by_one(kernel, every, stops, fixed, state))
            return []
        return reached

    def _one_by_one(
        self, kernel: Callable[..., Any], every: int, stops: int, fixed: State, state: State
    ) -> Course[list[State]]:
        """Return the same, each stop in a context of its own: a shared context does not tell at
        which stop a number left the range, and may do so at the end only."""
        states: list[State] = []
        while len(states) < stops:
            last = states[-1] if states else state
            after = yield from self.states(kernel, every, 1, fixed, last)
            if not after:
                break
            states += after
        return states

    def _in_range(self, x: Any) -> bool:
        """Return False for a number out of range; float64 carried beside the arithmetic's
        numbers always passes."""
        return isinstance(x, float) or self.finite(x)


@dataclass(frozen=True)
class NumberSystem:
    """A number system as it is known before its library is imported.

    `make(digits)`: it with so many decimal digits at least. `about`: what it is, in words that
    follow its name. `cost`: about how many float64 steps a step is worth. `digits`: those that it
    has, whatever it is asked for. `compiles`: each kernel is compiled before its first step, which
    takes 0.2–0.8 s. `most_digits`: beyond them others are the faster ones. `automatic`: `auto` may
    take it; of those that it may, the one whose steps cost most has every range and function.
    `in_lanes`: several orbits of one kernel are stepped together.
    """

    name: str
    make: Callable[[int], Arithmetic]
    about: str
    cost: int
    digits: int | None = None
    compiles: bool = False
    most_digits: float = math.inf
    automatic: bool = False
    in_lanes: bool = False


class UnsupportedError(Exception):
    """An arithmetic lacks a function that a kernel needs; the message says which."""


_CORRECT = ("add", "sub", "mul", "neg", "inverse", "pi")
ESCAPE_BITS = 4000  # if exponents have no end of their own, an orbit is stopped at |z| = 2^4000
MOST_EXPONENT = 1 << 20  # and of what is carried beside it: more takes time and says nothing


def relative(bits: int, functions: int = 1) -> Rounding:
    """Return the rounding bound for so many significant bits, to nearest; functions are within
    so many times as much."""

    def bound_rounding(kind: str, _degree: int, size: "Ball") -> "Ball":
        return size * type(size)(2) ** -bits * (1 if kind in _CORRECT else functions)

    return bound_rounding


def bits_for(digits: int) -> int:
    """Return the bits of a binary mantissa that holds so many decimal digits."""
    # One bit more than the digits carry, so that half a unit in the last bit is below half a unit
    # of the last digit.
    return math.ceil(digits * math.log2(10)) + 1


@lru_cache(maxsize=64)
def _code(source: str, name: str) -> CodeType:
    """Compile the source once for all precisions, whose kernels differ in their constants alone."""
    return compile(source, f"<kernel {name}>", "exec")


def interpret(source: str, name: str, namespace: Mapping[str, Any]) -> Callable[..., Any]:
    """Return the function of that name as plain Python: the `compile` of systems without a
    compiler."""
    scope = dict(namespace)
    exec(_code(source, name), scope)  # noqa: S102 - our own source
    function: Callable[..., Any] = scope[name]
    return function
