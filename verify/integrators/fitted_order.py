"""By which whole power of h an error shrinks, read off above the noise; or that it is not seen."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

_WITHIN = 0.2  # of a whole power
_FEWEST = 3  # neighbouring slopes that must agree
_FEWEST_IN_TAIL = 5  # where a lower power takes over: what a tolerance leaves may seem one
_ABOVE = 10  # times its noise an error must be
_TOLERANCE, _LIKELY_TOLERANCE = 1e-7, 1e-9
_FLOOR = 1e-4  # below it an error that does not shrink at all is one of few digits
_SMALL, _PART = 1e-9, 1e-2
_ROUNDING = 2.0**-43  # what rounded coefficients leave, in parts of the step


@dataclass(frozen=True)
class Tail:
    """A lower power, from `h` down, where the error is `error`, that a tolerance may leave."""

    power: int
    h: float
    error: float

    @property
    def small(self) -> bool:
        """Whether a tolerance is the likely reason."""
        return self.error <= _LIKELY_TOLERANCE


@dataclass(frozen=True)
class Fitted:
    """`power`: None where no power is seen. `first`, `last`: between which step sizes it is."""

    power: int | None
    first: float = 0.0
    last: float = 0.0
    tail: Tail | None = None


def fitted(
    rows: Sequence[tuple[float, float, float]], opaque: bool = False, fewest: int = _FEWEST
) -> Fitted:
    """From rows (h, error, its noise), h falling.

    A lower power at smaller steps counts too, and is what holds for h → 0; but not where it is what
    the rounding of coefficients leaves: an error below 2⁻⁴³ at steps of size 1. `opaque`: the step
    may solve equations up to a tolerance, and then such a power below 10⁻⁷ is only told. `fewest`:
    neighbouring slopes that must agree.
    """
    largest = max((error for _, error, _ in rows), default=0.0)
    least = min(_SMALL, _PART * largest)  # below it a power is seen in what a tolerance leaves
    runs = _runs(rows, fewest)
    while runs and rows[runs[0][1]][1] < least:
        runs.pop(0)
    if not runs:
        return Fitted(None)
    chosen, tail = runs[0], None
    for run in runs[1:]:
        h, error = rows[run[1]][:2]
        if run[2] - run[1] < _FEWEST_IN_TAIL or error <= _ROUNDING * h:
            continue
        if opaque and error <= (_TOLERANCE if run[0] > 0 else _FLOOR):
            tail = Tail(run[0], h, error) if run[0] < chosen[0] else tail
        else:
            chosen, tail = run, None
    power, begin, end = chosen
    return Fitted(power, rows[begin][0], rows[end][0], tail)


def _runs(rows: Sequence[tuple[float, float, float]], fewest: int) -> list[tuple[int, int, int]]:
    """(power, first row, last row) of the longest stretches on which one power is seen."""
    found: list[tuple[int, int, int]] = []
    power, begin = None, 0
    for k in range(len(rows)):
        slope = _slope(rows[k], rows[k + 1]) if k + 1 < len(rows) else None
        whole = None if slope is None or abs(slope - round(slope)) >= _WITHIN else round(slope)
        if whole != power:
            if power is not None and k - begin >= fewest:
                found.append((power, begin, k))
            power, begin = whole, k
    return found


def _slope(one: tuple[float, float, float], two: tuple[float, float, float]) -> float | None:
    if any(error <= _ABOVE * noise or error <= 0 for _, error, noise in (one, two)):
        return None
    return math.log(one[1] / two[1]) / math.log(one[0] / two[0])
