"""A mixed kernel on its way: its states by names, at the stops that are asked for."""

import math
from bisect import bisect_left
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import takewhile
from typing import Any

from verify.arithmetic.number import Number
from verify.arithmetic.number_system import Arithmetic
from verify.studies.separation.kernel import Mixed

State = Mapping[str, Any]  # a float or a wide number; its name begins with f or with w


class Carried(Mapping[str, Any]):
    """A kernel's state by its names; a number is made where it is looked at."""

    def __init__(self, at: Mapping[str, int], state: Sequence[Number]) -> None:
        self._at, self.numbers = at, state

    def __getitem__(self, name: str) -> Any:
        return self.numbers[self._at[name]]

    def __iter__(self) -> Iterator[str]:
        return iter(self._at)

    def __len__(self) -> int:
        return len(self._at)


class Stepper:
    """A mixed kernel with all that stays the same from step to step.

    `also`: what must hold of a state in range beside that its float64 numbers are finite.
    """

    def __init__(
        self,
        kernel: Mixed,
        arithmetic: Arithmetic,
        fixed: Sequence[Number],
        also: Callable[[State], bool] = lambda _: True,
    ) -> None:
        self.kernel, self.arithmetic, self.fixed, self.also = kernel, arithmetic, fixed, also
        self._at = {name: k for k, name in enumerate(kernel.state_names)}
        # The sums of logarithms may be undefined while the orbit and the plain way go on.
        self._vital = [n for n in self._at if n[0] == "f" and n not in ("f_sum", "f_rest")]

    def states(self, state: State, every: int, stops: int, beyond: int = 0) -> list[State]:
        """Those at the next stops; fewer where float64 leaves its range on the way.

        `beyond`: so many steps will be asked for after these.
        """
        begun = state.numbers if isinstance(state, Carried) else [state[n] for n in self._at]
        kernel = self.kernel.function
        found = self.arithmetic.states(kernel, every, stops, self.fixed, begun, beyond)
        return list(takewhile(self._finite, (Carried(self._at, x) for x in found)))

    def _finite(self, state: State) -> bool:
        return all(map(math.isfinite, map(state.__getitem__, self._vital))) and self.also(state)

    def last_good(self, state: State, count: int) -> int:
        """The greatest number of steps below `count` that stays in range, by bisection."""
        return bisect_left(range(1, count), True, key=lambda n: not self.states(state, n, 1))
