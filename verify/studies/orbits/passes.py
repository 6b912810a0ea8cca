"""The surface that orbits pass, and a comparison of two computations of one orbit.

On the surface one coordinate has one value; passes count in one direction.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

State = Sequence[Any]  # the numbers of p1 … pn, q1 … qn


@dataclass(frozen=True)
class Surface:
    """The surface `coordinate` = `value` among the coordinates `names`.

    It is passed upwards where it is `rising`, else downwards.
    """

    names: tuple[str, ...]
    coordinate: str
    value: Fraction
    rising: bool

    @property
    def place(self) -> int:
        """The index of the coordinate among all."""
        return self.names.index(self.coordinate)

    def height(self, z: State, value: Any) -> Any:
        """Return z's height above the surface, in the direction that counts.

        `value` in z's numbers.
        """
        distance = z[self.place] - value
        return distance if self.rising else -distance


@dataclass(frozen=True)
class Passes:
    """States of an orbit at its passes, in their order; `left`: it did not reach its end."""

    states: Sequence[Mapping[str, Fraction]]
    left: bool = False


def count_agreeing(
    one: Sequence[Mapping[str, Fraction]],
    other: Sequence[Mapping[str, Fraction]],
    tolerance: Fraction,
) -> tuple[int, Fraction]:
    """Return the number of first states that agree within `tolerance`, and their difference."""
    largest = Fraction(0)
    for k, (x, y) in enumerate(zip(one, other, strict=False)):
        difference = max(abs(x[name] - y[name]) for name in x)
        if difference > tolerance:
            return k, largest
        largest = max(largest, difference)
    return min(len(one), len(other)), largest
