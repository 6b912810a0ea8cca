"""Number systems: the description of each, and the arithmetic of each at one precision."""

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

SystemNumber = object  # a number of some system; only that system's functions read it
Rounding = Callable[[str, int, "Ball"], "Ball"]
State = Sequence[Any]  # the numbers that a kernel carries
Walk = Callable[[Callable[..., Any], int, int, State, State, int], Course[list[State]]]


class Element(Protocol):
    """An element of a ring or of a field, or a ball: it can be added, multiplied, and divided by an
    integer."""

    def __neg__(self) -> Self: ...

    def __add__(self, other: Self, /) -> Self: ...

    def __sub__(self, other: Self, /) -> Self: ...

    def __mul__(self, other: Self | int, /) -> Self: ...

    def __truediv__(self, other: int, /) -> Self: ...


E = TypeVar("E", bound=Element)


@dataclass(frozen=True)
class Arithmetic:
    """One number system at one precision.

    - `number` rounds an exact rational once; `exact` returns the rational that equals a number.
    - `finite`: True for a number that is in range.
    - `context`: inside `context()` the operators of the numbers and `functions` round as this
      arithmetic does. Whoever uses them or calls a kernel enters it; on exit it restores
      everything.
    - `compile` turns a kernel's source, which uses + − * / and the names in `functions`, into the
      function of that name.
    - `guard`: a condition on `{x}` in the loop that holds while the orbit is in range; None if
      infinities propagate and are found afterwards.
    - `pipelined`: independent operations overlap, so that latency counts and not their number.
    - `chunk`: the number of steps between two looks at progress and interruption.
    - `absolute`: `bits` counts the bits after the point, not the significant ones; a kernel then
      scales ΔJ and has limits instead of a guard.
    - `radius`, if a number is an enclosure: how far from `exact` the true value may be. `minimum`
      and `maximum` are then among the functions.
    - `rounding` bounds the rounding error of an operation. Its arguments: the operation's kind in a
      program, a root's degree, and a bound on the size of the exact and of the computed result.
      None if no bound is known.
    - `walk` replaces the loop in `states`, if several orbits are stepped together.

    Two arithmetics of one name and precision are equal.
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
        """Return the `stops` states that a kernel reaches after `every` steps each, from a state;
        fewer if a number leaves the arithmetic's range on the way.

        `fixed`: the kernel's arguments between the number of steps and the state. `later_steps`:
        the number of steps of this orbit that will be requested after these.
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
        except (ArithmeticError, ValueError):  # a pole, or the log or root of a negative number
            if stops > 1:
                return (yield from self._one_by_one(kernel, every, stops, fixed, state))
            return []
        return reached

    def _one_by_one(
        self, kernel: Callable[..., Any], every: int, stops: int, fixed: State, state: State
    ) -> Course[list[State]]:
        """Return the same as `states`, with a context of its own for each stop: a shared one does
        not tell at which stop a number left the range, since it may raise only on exit."""
        states: list[State] = []
        while len(states) < stops:
            last = states[-1] if states else state
            after = yield from self.states(kernel, every, 1, fixed, last)
            if not after:
                break
            states += after
        return states

    def _in_range(self, x: Any) -> bool:
        """Return True if a number is in range; a float64 that is carried beside the arithmetic's
        numbers counts as in range."""
        return isinstance(x, float) or self.finite(x)


@dataclass(frozen=True)
class NumberSystem:
    """The description of a number system, without its library.

    - `make(digits)` returns its arithmetic with at least so many decimal digits.
    - `about`: a description that follows the name.
    - `cost`: about how many steps of float64 take as long as one step.
    - `digits`: the number of digits, if the system has only one precision.
    - `compiles`: each kernel is compiled before its first step, which takes 0.2–0.8 s.
    - `most_digits`: with more digits other systems are faster.
    - `automatic`: `auto` may choose it. The costliest of these must have every range and function,
      since `auto` tries it last.
    - `in_lanes`: several orbits of one kernel are stepped together.
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


_CORRECTLY_ROUNDED = ("add", "sub", "mul", "neg", "inverse", "pi")
ESCAPE_BITS = 4000  # without an end of the exponents an orbit is stopped at |z| = 2^4000
# The largest binary exponent of numbers carried beside z: larger ones take time, and say nothing.
MAX_EXPONENT = 1 << 20


def relative(bits: int, functions: int = 1) -> Rounding:
    """Return the rounding bound of a floating-point system that rounds to nearest.

    `bits`: the significant bits. `functions`: the bound of a function in multiples of that of an
    operation.
    """

    def bound_rounding(kind: str, _degree: int, size: "Ball") -> "Ball":
        return size * type(size)(2) ** -bits * (1 if kind in _CORRECTLY_ROUNDED else functions)

    return bound_rounding


def bits_for(digits: int) -> int:
    """Return the number of bits of a binary mantissa that holds `digits` decimal digits."""
    # One bit more than digits·log₂ 10, so that half a unit in the last bit is below half a unit of
    # the last digit.
    return math.ceil(digits * math.log2(10)) + 1


@lru_cache(maxsize=64)
def _code(source: str, name: str) -> CodeType:
    """Compile the source once for all precisions: their kernels differ only in the constants."""
    return compile(source, f"<kernel {name}>", "exec")


def interpret(source: str, name: str, namespace: Mapping[str, Any]) -> Callable[..., Any]:
    """Return the function `name` of a source in plain Python: the `compile` of number systems
    without a compiler."""
    scope = dict(namespace)
    exec(_code(source, name), scope)  # noqa: S102 - our own source
    function: Callable[..., Any] = scope[name]
    return function
