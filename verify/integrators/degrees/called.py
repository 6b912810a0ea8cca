"""A step of arrays as it is called, and with its h fixed as a map that probes call."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction

from verify.integrators.maps.user_map import arrays, flat
from verify.integrators.number_type import NumberType
from verify.integrators.step import Step, Theirs

_WANTED = "wanted: p', q'"


@dataclass
class StepOfArrays:
    """`names`: p1 … pn, q1 … qn, of which the step takes p and q as arrays, and returns both."""

    step: Step
    names: tuple[str, ...]

    @property
    def function(self) -> Callable[..., Theirs]:
        """The user's."""
        return self.step.function

    def called(
        self,
        function: Callable[..., Theirs],
        z: Sequence[Theirs],
        h: Theirs,
        t: Theirs,
    ) -> list[Theirs]:
        """z' in our order. Raises StepError, and what the user's code raises."""
        n = len(self.names) // 2
        with self.step.limited():
            found = flat(self.step.raw(function, *arrays(z), h, t), 2 * n, _WANTED)
        exchanged = self.step.order.index("p") > self.step.order.index("q")
        return [*found[n:], *found[:n]] if exchanged else found

    def at(self, h: Fraction, t: Fraction) -> "StepAt":
        """The map of that step size, at that time."""
        return StepAt(self, h, t)


@dataclass
class StepAt:
    """A `verify.integrators.maps.user_map.CallableMap`."""

    own: StepOfArrays
    h: Fraction
    t: Fraction

    @property
    def function(self) -> Callable[..., Theirs]:
        """The user's."""
        return self.own.function

    @property
    def names(self) -> tuple[str, ...]:
        """Of the coordinates."""
        return self.own.names

    @property
    def numbers(self) -> NumberType:
        """What it computes in."""
        return self.own.step.numbers

    def called(
        self,
        function: Callable[..., Theirs],
        z: Sequence[Theirs],
        of_number: Callable[[Fraction], Theirs],
    ) -> list[Theirs]:
        """z' in our order."""
        return self.own.called(function, z, of_number(self.h), of_number(self.t))
