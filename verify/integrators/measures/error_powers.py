"""The whole power of h by which an error shrinks, where that has settled above its noise.

Stretches of step sizes of one power are found by the slopes between neighbours. Which of them holds
depends on what a loop that ends at a tolerance leaves at the smallest step sizes.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

_FROM_WHOLE = 0.2  # of a whole power
_FEWEST = 3  # neighbouring slopes that agree
ENOUGH = 4  # slopes of what has not settled, with which it counts
CLEAR_FACTOR = 10  # times its noise an error must be
OF_MANY = 2.0**9  # times what a rounded coefficient does, what many of them may do
_FEWEST_IN_TAIL = 5  # slopes of a lower power that floats alone show
_TOLERANCE = 1e-7  # in units: below it such a power may be what the tolerance of a loop leaves
_FEW_DIGITS = 5e-8, 0.5  # of a step's length: beyond eight digits, and no standstill


@dataclass(frozen=True)
class PowerStretch:
    """A stretch of step sizes on which one power is seen: from `first` down to `last`. `count`: of
    the slopes that agree."""

    power: int
    first: float
    last: float
    count: int


@dataclass(frozen=True)
class Slopes:
    """`runs`: by falling h. `is_seen`: whether any error is beyond its noise. `unsettled`: the
    slopes of the smallest step sizes, where no whole power holds there."""

    runs: tuple[PowerStretch, ...]
    is_seen: bool
    unsettled: tuple[float, ...] = ()


Row = tuple[float, float, float]  # h, the error there, its noise


def slopes_of(rows: Sequence[Row], fewest: int = _FEWEST) -> Slopes:
    """Find the stretches of one power in rows of falling h."""
    pairs = [_slope(one, two) for one, two in pairwise(rows)]
    runs: list[PowerStretch] = []
    begin, power = 0, None
    for k in range(len(pairs) + 1):
        slope = pairs[k] if k < len(pairs) else None
        # A run is a stretch of neighbouring slopes that round to the same whole power.
        whole = None if slope is None or abs(slope - round(slope)) >= _FROM_WHOLE else round(slope)
        if whole != power:
            if power is not None and k - begin >= fewest:
                runs.append(PowerStretch(power, rows[begin][0], rows[k][0], k - begin))
            begin, power = k, whole
    clear = [k for k, slope in enumerate(pairs) if slope is not None]
    last = _end(runs, rows, pairs)
    # Slopes below the last run agree on no power; too few of them tell nothing.
    tail = [pairs[k] for k in clear if k > last]
    loose = tuple(x for x in tail if x is not None) if len(tail) >= fewest - 1 else ()
    return Slopes(tuple(runs), any(_clear(row) for row in rows), loose)


def _end(runs: Sequence[PowerStretch], rows: Sequence[Row], pairs: Sequence[float | None]) -> int:
    """Return the index of the last pair of the last run."""
    if not runs:
        return -1
    return next(k for k, row in enumerate(rows) if row[0] == runs[-1].last) - 1


def _clear(row: Row) -> bool:
    return row[1] > CLEAR_FACTOR * row[2] and row[1] > 0


def _slope(larger: Row, smaller: Row) -> float | None:
    if not (_clear(larger) and _clear(smaller)):
        return None
    return math.log(larger[1] / smaller[1]) / math.log(larger[0] / smaller[0])


def clear_slopes(
    rows: Sequence[Row], negative: Sequence[bool], factor: float
) -> list[tuple[float, float]]:
    """Return log h and the slope, between neighbours that are beyond their noise `factor` times.

    `negative`: whether an error is. Only the step sizes below those are taken at which that last
    changes, since terms cancel at it.
    """
    clear = [(h, e, sign) for (h, e, n), sign in zip(rows, negative, strict=True) if e > factor * n]
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


# -- the power that holds -------------------------------------------------------------------------


@dataclass(frozen=True)
class ErrorTail:
    """A lower power, from `h` down, where the error is `error` in units of the place."""

    power: int | None
    h: float
    error: float


class SettledPower(NamedTuple):
    """`power` by which an error falls, None where none has settled; `run`: the stretch on which it
    is seen; `tail`: what a loop leaves below that."""

    power: int | None = None
    run: PowerStretch | None = None
    tail: ErrorTail | None = None


def settle_power(
    slopes: Slopes, rows: Sequence[Row], counts: Sequence[int],
    ways: Sequence[float], how: str, unit: float,
) -> SettledPower:  # fmt: skip
    """Return the power that holds, its stretch, and what a loop leaves below it.

    Where the number of comparisons changes with h, a loop ends at a tolerance: a lower power below
    is then what it leaves, unless it goes on through such changes as no tolerance does, or is a
    part of the way itself, as of a wrong constant.
    """
    if not slopes.runs:
        return SettledPower()
    best_run, tail = slopes.runs[0], None
    begin = next(k for k, row in enumerate(rows) if row[0] == best_run.first)
    if begin and counts[begin] < counts[begin - 1] and rows[begin][1] > rows[begin - 1][1]:
        # A loop does one turn less: what it leaves is all that has settled.
        return SettledPower(tail=ErrorTail(best_run.power, best_run.first, rows[begin][1] / unit))
    iterates = len(set(counts)) > 1
    for run in slopes.runs[1:]:
        if run.power > best_run.power and tail is None:
            best_run = run  # what is seen of larger steps has not settled
            continue
        if run.power >= best_run.power:
            continue
        indices = [k for k, row in enumerate(rows) if run.last <= row[0] <= run.first]
        error = rows[indices[0]][1] / unit
        if how == "duals" and rows[indices[0]][1] <= OF_MANY * rows[indices[0]][2]:
            break
        if how == "duals":
            real = not iterates or len({counts[k] for k in indices}) > 1
        else:
            smallest, largest = (x * ways[indices[0]] for x in _FEW_DIGITS)
            constant = run.power == 1 and smallest < error < largest  # a loop has gone round once
            real = run.count >= _FEWEST_IN_TAIL and (error > _TOLERANCE or constant)
        if real:
            best_run, tail = run, None
        else:
            tail = tail or ErrorTail(run.power, rows[indices[0]][0], error)
    if slopes.unsettled and best_run is slopes.runs[-1]:
        # Slopes that still rise towards another power are no tail that a loop leaves: nothing has
        # settled.
        if on_their_way(slopes.unsettled, best_run.power):
            return SettledPower()
        end = next(k for k, row in enumerate(rows) if row[0] == best_run.last)
        next_row = rows[min(end + 1, len(rows) - 1)]
        error = next_row[1] / unit
        if how == "duals" and next_row[1] <= OF_MANY * next_row[2]:
            return SettledPower(best_run.power, best_run, tail)
        if (how == "duals" and not iterates) or (how == "floats" and error > _TOLERANCE):
            return SettledPower()
        tail = tail or ErrorTail(None, rows[end][0], error)
    return SettledPower(best_run.power, best_run, tail)
