"""By which whole power of h an error shrinks: where that has settled, above its noise."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

_WITHIN = 0.2  # of a whole power
_FEWEST = 3  # neighbouring slopes that agree
_ABOVE = 10  # times its noise an error must be


@dataclass(frozen=True)
class Run:
    """A stretch of step sizes on which one power is seen: from `first` down to `last`, where the
    error is `error`. `count`: of the slopes that agree."""

    power: int
    first: float
    last: float
    error: float
    count: int


@dataclass(frozen=True)
class Slopes:
    """`runs`: by falling h. `seen`: whether any error is beyond its noise. `unsettled`: the slopes
    of the smallest step sizes, where no whole power holds there."""

    runs: tuple[Run, ...]
    seen: bool
    unsettled: tuple[float, ...] = ()

    @property
    def power(self) -> int | None:
        """That of the smallest step sizes; None where none has settled."""
        return self.runs[-1].power if self.runs and not self.unsettled else None


Row = tuple[float, float, float]  # h, the error there, its noise


def slopes_of(rows: Sequence[Row], fewest: int = _FEWEST) -> Slopes:
    """Of rows by falling h."""
    pairs = [_slope(one, two) for one, two in pairwise(rows)]
    runs: list[Run] = []
    begin, power = 0, None
    for k in range(len(pairs) + 1):
        slope = pairs[k] if k < len(pairs) else None
        whole = None if slope is None or abs(slope - round(slope)) >= _WITHIN else round(slope)
        if whole != power:
            if power is not None and k - begin >= fewest:
                h, error, _ = rows[k]
                runs.append(Run(power, rows[begin][0], h, error, k - begin))
            begin, power = k, whole
    clear = [k for k, slope in enumerate(pairs) if slope is not None]
    last = _end(runs, rows, pairs)
    rest = [pairs[k] for k in clear if k > last]
    loose = tuple(x for x in rest if x is not None) if len(rest) >= fewest - 1 else ()
    return Slopes(tuple(runs), any(_clear(row) for row in rows), loose)


def _end(runs: Sequence[Run], rows: Sequence[Row], pairs: Sequence[float | None]) -> int:
    """The last pair of the last run."""
    if not runs:
        return -1
    return next(k for k, row in enumerate(rows) if row[0] == runs[-1].last) - 1


def _clear(row: Row) -> bool:
    return row[1] > _ABOVE * row[2] and row[1] > 0


def _slope(one: Row, two: Row) -> float | None:
    if not (_clear(one) and _clear(two)):
        return None
    return math.log(one[1] / two[1]) / math.log(one[0] / two[0])
