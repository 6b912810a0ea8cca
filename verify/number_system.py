"""What a kernel needs of a number system."""

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from fractions import Fraction
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
    interruption. Two arithmetics of one name and precision are equal.
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
