"""Gragg's method, extrapolated, for any number of coordinates; see `verify.flows.extrapolation`."""

from collections.abc import Sequence

from verify.flows.extrapolation import STILL, Flow, NoFlowError, Number, State
from verify.hamiltonians.canonical_field import CanonicalField


class FlowInDegrees(Flow):
    """The exact flow of a field without symbols; a state has all its coordinates, and t where H
    depends on it."""

    def __init__(self, field: CanonicalField, digits: int) -> None:
        self._write([(field.ring, x) for x in field.slopes], field.names, field.timed, digits)

    def slope(self, z: State) -> State:
        """f(z). Raises NoFlowError where it is not defined."""
        try:
            with self.arithmetic.context():
                return self._slopes(*z)
        except (ArithmeticError, ValueError):
            raise NoFlowError("the orbit leaves where H is defined") from None

    def _first_step(self, z: State, goal: Number) -> Number:
        slopes = self.slope(z)
        with self.arithmetic.context():
            speed = sum(map(abs, slopes))
            size = sum(map(abs, z[: len(slopes)]))
            return min(goal, (1 + size) / speed) if speed else goal

    def _extrapolated(self, z: State, time: Number) -> State | None:
        above: list[Sequence[Number]] = []
        for j in range(1, self._columns + 1):
            row: list[Sequence[Number]] = [self._rule(*z, time, 2 * j)]
            for k, before in enumerate(above, start=1):
                up, down = (j - k) ** 2, j**2 - (j - k) ** 2
                pairs = zip(row[-1], before, strict=True)
                row.append([last + (last - x) * up / down for last, x in pairs])
            if j > 2:
                moved = sum(abs(x - x0) for x, x0 in zip(row[-1], z, strict=False))
                size = moved + sum(map(abs, row[-1])) / STILL
                apart = sum(abs(x - y) for x, y in zip(row[-1], row[-2], strict=True))
                if apart <= self._tolerance * size:
                    return (*row[-1], z[-1] + time) if self.timed else tuple(row[-1])
            above = row
        return None
