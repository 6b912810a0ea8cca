"""The whole power of h by which an error shrinks, if one settles above the noise of the error.

The slopes of log(error) over log(h) between neighbouring step sizes show stretches of one power.
Several stretches may differ: larger steps have not settled, and at the smallest ones a loop of the
code that ends at a tolerance may leave an error of its own. `settle_power` selects the stretch that
holds.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

_WHOLE_TOLERANCE = 0.2  # the largest distance of a slope from a whole power that passes for it
_MIN_SLOPES = 3  # neighbouring slopes that have to agree
ENOUGH_SLOPES = 4  # with fewer slopes an error that has not settled tells nothing of its power
CLEAR_FACTOR = 10  # an error is clear if it is larger than its noise by this factor
# The rounding of many coefficients may have this multiple of the effect of one.
MANY_COEFFICIENTS_FACTOR = 2.0**9
_MIN_TAIL_SLOPES = 5  # the slopes of a lower power that have to agree, with floats
# In units of the place: an error below it may be what a loop leaves that ends at a tolerance.
_MAX_LOOP_TOLERANCE = 1e-7
# Relative to the distance that a step moves: an error of the power 1 in this range comes from a
# wrong constant. A smaller one may be rounding after eight digits, a larger one is a standstill.
_CONSTANT_ERROR_RANGE = 5e-8, 0.5


@dataclass(frozen=True)
class PowerStretch:
    """A stretch of step sizes on which one power is seen, from `first` down to `last`.

    `count`: the number of slopes that agree.
    """

    power: int
    first: float
    last: float
    count: int


@dataclass(frozen=True)
class PowerStretches:
    """The stretches of the errors of one component at one place.

    `runs`: the stretches, by falling h. `is_seen`: True if any error is clear of its noise.
    `unsettled`: the slopes of the smallest step sizes if they agree on no whole power; else ().
    """

    runs: tuple[PowerStretch, ...]
    is_seen: bool
    unsettled: tuple[float, ...] = ()


Row = tuple[float, float, float]  # h, the error at that step size, the noise of the error


def find_stretches(rows: Sequence[Row], min_slopes: int = _MIN_SLOPES) -> PowerStretches:
    """Find the stretches of one power in rows of falling h; `min_slopes` have to agree."""
    slopes = [_slope(one, two) for one, two in pairwise(rows)]
    runs: list[PowerStretch] = []
    begin, power = 0, None
    for k in range(len(slopes) + 1):
        slope = slopes[k] if k < len(slopes) else None
        # A run is a stretch of neighbouring slopes that round to the same whole power.
        whole = (
            None if slope is None or abs(slope - round(slope)) >= _WHOLE_TOLERANCE else round(slope)
        )
        if whole != power:
            if power is not None and k - begin >= min_slopes:
                runs.append(PowerStretch(power, rows[begin][0], rows[k][0], k - begin))
            begin, power = k, whole
    clear = [k for k, slope in enumerate(slopes) if slope is not None]
    last = _last_index(runs, rows)
    # Slopes below the last run agree on no power; too few of them tell nothing.
    tail = [slopes[k] for k in clear if k > last]
    unsettled = tuple(x for x in tail if x is not None) if len(tail) >= min_slopes - 1 else ()
    return PowerStretches(tuple(runs), any(_is_clear(row) for row in rows), unsettled)


def _last_index(runs: Sequence[PowerStretch], rows: Sequence[Row]) -> int:
    """Return the index of the last slope of the last run; −1 if there is no run."""
    if not runs:
        return -1
    return next(k for k, row in enumerate(rows) if row[0] == runs[-1].last) - 1


def _is_clear(row: Row) -> bool:
    return row[1] > CLEAR_FACTOR * row[2] and row[1] > 0


def _slope(larger: Row, smaller: Row) -> float | None:
    if not (_is_clear(larger) and _is_clear(smaller)):
        return None
    return math.log(larger[1] / smaller[1]) / math.log(larger[0] / smaller[0])


def clear_slopes(
    rows: Sequence[Row], negative: Sequence[bool], factor: float
) -> list[tuple[float, float]]:
    """Return log h and the slope, between neighbouring errors that exceed `factor` times the noise.

    `negative`: True for each error that is negative. Where the sign changes, terms of the error
    cancel: only the step sizes below the last change are taken.
    """
    clear = [(h, e, sign) for (h, e, n), sign in zip(rows, negative, strict=True) if e > factor * n]
    turns = [k for k, (one, two) in enumerate(pairwise(clear), start=1) if one[2] != two[2]]
    return [
        (math.log(h * g) / 2, math.log(a / b) / math.log(h / g))
        for (h, a, _), (g, b, _) in pairwise(clear[turns[-1] if turns else 0 :])
    ]


def estimate_limit(slopes: Sequence[tuple[float, float]]) -> float:
    """Estimate the limit of the slopes as h falls.

    If the error is a hʳ (1 − x) with x = h/c, the slope is r − x/(1 − x), and its derivative by
    −log h is d = x/(1 − x)², which falls to 0 with h. The limit is r = slope + x/(1 − x), where
    x/(1 − x) = (√(1 + 4 d) − 1)/2.
    """
    if len(slopes) < ENOUGH_SLOPES:
        return slopes[-1][1] if slopes else 0.0
    rises = [(b - a) / (x - y) for (x, a), (y, b) in pairwise(slopes[-_MIN_SLOPES:])]
    steady = 0 < rises[1] <= rises[0]
    return slopes[-1][1] + ((math.sqrt(1 + 4 * rises[1]) - 1) / 2 if steady else 0.0)


def rises_to_power(slopes: Sequence[float], power: int) -> bool:
    """Return True if the slopes rise steadily towards that power, or beyond it.

    The slopes of an error that a loop leaves do not.
    """
    last = slopes[-_MIN_SLOPES:]
    steady = len(last) == _MIN_SLOPES and all(a < b for a, b in pairwise(last))
    return steady and last[-1] > power - 1


# -- the power that holds -------------------------------------------------------------------------


@dataclass(frozen=True)
class ErrorTail:
    """The part of smaller step sizes with a lower power, from `h` down.

    `power`: None if it follows none. `error`: that at `h`, in units of the place.
    """

    power: int | None
    h: float
    error: float


class SettledPower(NamedTuple):
    """The power by which an error falls, None if none has settled.

    `run`: the stretch on which it is seen; `tail`: the error that a loop leaves below it.
    """

    power: int | None = None
    run: PowerStretch | None = None
    tail: ErrorTail | None = None


def settle_power(
    slopes: PowerStretches, rows: Sequence[Row], counts: Sequence[int],
    distances_moved: Sequence[float], how: str, unit: float,
) -> SettledPower:  # fmt: skip
    """Return the power that holds, its stretch, and the error that a loop leaves below it.

    `counts`: the comparisons of the code at each step size. If they change with h, a loop ends at a
    tolerance, and a lower power at smaller step sizes is the loop's, not the scheme's. It is the
    scheme's if it goes on through changes of the count. With floats, comparisons are not counted:
    there a lower power is the scheme's if it has many slopes and its error is larger than a
    tolerance, or is a part of the distance moved (`distances_moved`), as with a wrong constant.
    """
    if not slopes.runs:
        return SettledPower()
    best_run, tail = slopes.runs[0], None
    begin = next(k for k, row in enumerate(rows) if row[0] == best_run.first)
    if begin and counts[begin] < counts[begin - 1] and rows[begin][1] > rows[begin - 1][1]:
        # A loop does one iteration less: the error that it leaves is all that has settled.
        return SettledPower(tail=ErrorTail(best_run.power, best_run.first, rows[begin][1] / unit))
    iterates = len(set(counts)) > 1
    for run in slopes.runs[1:]:
        if run.power > best_run.power and tail is None:
            best_run = run  # the power of the larger steps had not settled
            continue
        if run.power >= best_run.power:
            continue
        indices = [k for k, row in enumerate(rows) if run.last <= row[0] <= run.first]
        error = rows[indices[0]][1] / unit
        if how == "duals" and rows[indices[0]][1] <= MANY_COEFFICIENTS_FACTOR * rows[indices[0]][2]:
            break
        if how == "duals":
            is_of_scheme = not iterates or len({counts[k] for k in indices}) > 1
        else:
            smallest, largest = (x * distances_moved[indices[0]] for x in _CONSTANT_ERROR_RANGE)
            is_constant = run.power == 1 and smallest < error < largest
            is_long = run.count >= _MIN_TAIL_SLOPES
            is_of_scheme = is_long and (error > _MAX_LOOP_TOLERANCE or is_constant)
        if is_of_scheme:
            best_run, tail = run, None
        else:
            tail = tail or ErrorTail(run.power, rows[indices[0]][0], error)
    if slopes.unsettled and best_run is slopes.runs[-1]:
        # If the slopes still rise to that power, no loop leaves them, and nothing has settled.
        if rises_to_power(slopes.unsettled, best_run.power):
            return SettledPower()
        end = next(k for k, row in enumerate(rows) if row[0] == best_run.last)
        next_row = rows[min(end + 1, len(rows) - 1)]
        error = next_row[1] / unit
        if how == "duals" and next_row[1] <= MANY_COEFFICIENTS_FACTOR * next_row[2]:
            return SettledPower(best_run.power, best_run, tail)
        if (how == "duals" and not iterates) or (how == "floats" and error > _MAX_LOOP_TOLERANCE):
            return SettledPower()
        tail = tail or ErrorTail(None, rows[end][0], error)
    return SettledPower(best_run.power, best_run, tail)
