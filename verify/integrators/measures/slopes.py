"""The whole power of h by which an error shrinks, where that has settled above its noise."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

_WITHIN = 0.2  # of a whole power
_FEWEST = 3  # neighbouring slopes that agree
ENOUGH = 4  # slopes of what has not settled, with which it counts
ABOVE = 10  # times its noise an error must be


@dataclass(frozen=True)
class Run:
    """A stretch of step sizes on which one power is seen: from `first` down to `last`. `count`: of
    the slopes that agree."""

    power: int
    first: float
    last: float
    count: int


@dataclass(frozen=True)
class Slopes:
    """`runs`: by falling h. `seen`: whether any error is beyond its noise. `unsettled`: the slopes
    of the smallest step sizes, where no whole power holds there."""

    runs: tuple[Run, ...]
    seen: bool
    unsettled: tuple[float, ...] = ()


Row = tuple[float, float, float]  # h, the error there, its noise


def slopes_of(rows: Sequence[Row], fewest: int = _FEWEST) -> Slopes:
    """Find the stretches of one power in rows of falling h."""
    pairs = [_slope(one, two) for one, two in pairwise(rows)]
    runs: list[Run] = []
    begin, power = 0, None
    for k in range(len(pairs) + 1):
        slope = pairs[k] if k < len(pairs) else None
        # A run is a stretch of neighbouring slopes that round to the same whole power.
        whole = None if slope is None or abs(slope - round(slope)) >= _WITHIN else round(slope)
        if whole != power:
            if power is not None and k - begin >= fewest:
                runs.append(Run(power, rows[begin][0], rows[k][0], k - begin))
            begin, power = k, whole
    clear = [k for k, slope in enumerate(pairs) if slope is not None]
    last = _end(runs, rows, pairs)
    # Slopes below the last run agree on no power; too few of them tell nothing.
    rest = [pairs[k] for k in clear if k > last]
    loose = tuple(x for x in rest if x is not None) if len(rest) >= fewest - 1 else ()
    return Slopes(tuple(runs), any(_clear(row) for row in rows), loose)


def _end(runs: Sequence[Run], rows: Sequence[Row], pairs: Sequence[float | None]) -> int:
    """Return the index of the last pair of the last run."""
    if not runs:
        return -1
    return next(k for k, row in enumerate(rows) if row[0] == runs[-1].last) - 1


def _clear(row: Row) -> bool:
    return row[1] > ABOVE * row[2] and row[1] > 0


def _slope(one: Row, two: Row) -> float | None:
    if not (_clear(one) and _clear(two)):
        return None
    return math.log(one[1] / two[1]) / math.log(one[0] / two[0])


def clear_slopes(
    rows: Sequence[Row], below: Sequence[bool], most: float
) -> list[tuple[float, float]]:
    """Return log h and the slope, between neighbours that are beyond their noise `most` times.

    `below`: whether an error is negative. Only the step sizes below those are taken at which that
    last changes, since terms cancel at it.
    """
    clear = [(h, e, sign) for (h, e, n), sign in zip(rows, below, strict=True) if e > most * n]
    turns = [k for k, (one, two) in enumerate(pairwise(clear), start=1) if one[2] != two[2]]
    return [
        (math.log(h * g) / 2, math.log(a / b) / math.log(h / g))
        for (h, a, _), (g, b, _) in pairwise(clear[turns[-1] if turns else 0 :])
    ]


def limit_of(slopes: Sequence[tuple[float, float]]) -> float:
    """Estimate the limit of the slopes as h falls.

    Of a hʳ (1 − x), x = h/c, the slope is r − x/(1 − x), and rises by x/(1 − x)² as log h falls:
    more and more slowly.
    """
    if len(slopes) < ENOUGH:
        return slopes[-1][1] if slopes else 0.0
    rises = [(b - a) / (x - y) for (x, a), (y, b) in pairwise(slopes[-_FEWEST:])]
    steady = 0 < rises[1] <= rises[0]
    return slopes[-1][1] + ((math.sqrt(1 + 4 * rises[1]) - 1) / 2 if steady else 0.0)


def on_their_way(slopes: Sequence[float], power: int) -> bool:
    """Return True if the slopes rise steadily to another power, as those of what a loop leaves do
    not."""
    last = slopes[-_FEWEST:]
    steady = len(last) == _FEWEST and all(a < b for a, b in pairwise(last))
    return steady and last[-1] > power - 1
