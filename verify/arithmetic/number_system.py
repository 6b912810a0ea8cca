"""What a kernel needs of a number system."""

import math
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from types import CodeType
from typing import Any


@dataclass(frozen=True)
class Arithmetic:
    """One number system at one precision.

    `number` rounds an exact rational once; `exact` gives the rational that a number is. Inside
    `context()` the operators of its numbers and `functions` round as this arithmetic does; whoever
    uses them or calls a kernel enters it, and it leaves nothing changed. `compile` turns a kernel's
    source, which uses + − * / and the names in `functions`, into the function of that name. `guard`
    is a condition on `{x}`, put into the loop, that holds while the orbit is in range (None where
    infinities propagate and are found afterwards). `pipelined`: independent operations overlap, so
    that latency counts and not their number. `chunk`: steps between looks at progress and
    interruption. `absolute`: numbers have so many bits after the point, not so many significant
    ones; a kernel then scales ΔJ and has limits of its own instead of a guard. `radius`, where a
    number is an enclosure: how far from `exact` the true value may be, and `minimum` and `maximum`
    are then among the functions. Two arithmetics of one name and precision are equal.
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


class UnsupportedError(Exception):
    """An arithmetic lacks a function that a kernel needs; the message says which."""


ESCAPE_BITS = 4000  # where exponents have no end of their own, an orbit is stopped at |z| = 2^4000
MOST_EXPONENT = 1 << 20  # and of what is carried beside it: more takes time and says nothing


def bits_for(digits: int) -> int:
    """The bits of a binary mantissa that holds so many decimal digits."""
    return math.ceil(digits * math.log2(10)) + 1


@lru_cache(maxsize=64)
def _code(source: str, name: str) -> CodeType:
    """Compiled once for all precisions, whose kernels differ in their constants alone."""
    return compile(source, f"<kernel {name}>", "exec")


def interpreted(source: str, name: str, namespace: Mapping[str, Any]) -> Callable[..., Any]:
    """The function of that name as plain Python: the `compile` of what has no compiler."""
    scope = dict(namespace)
    exec(_code(source, name), scope)  # noqa: S102 - our own source
    function: Callable[..., Any] = scope[name]
    return function
