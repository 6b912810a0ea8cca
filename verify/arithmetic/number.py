"""Types of numbers, for code that serves many number systems."""

from typing import Protocol, Self, TypeVar

Number = object  # of some number system: its own functions alone take it apart


class Element(Protocol):
    """A number that can be added, multiplied and divided by integers: of a ring, a field, or a
    ball."""

    def __neg__(self) -> Self: ...

    def __add__(self, other: Self, /) -> Self: ...

    def __sub__(self, other: Self, /) -> Self: ...

    def __mul__(self, other: Self | int, /) -> Self: ...

    def __truediv__(self, other: int, /) -> Self: ...


E = TypeVar("E", bound=Element)
