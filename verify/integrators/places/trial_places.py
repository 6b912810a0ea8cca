"""Places at which a user's map is tried: states in natural units, with suitable step sizes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations, product
from random import Random

PATTERN, USER, SIDE = "pattern", "user", "side"
# Factors of the coordinates, so that no two of them are equal.
_COORDINATE_FACTORS = tuple(
    map(Fraction, ("1", "5/6", "7/6", "3/4", "9/8", "4/5", "11/10", "2/3", "6/5", "7/9"))
)
# Amplitudes of q and of p: moderate, small, large in p (as a rotation), large in q, large in both.
_AMPLITUDES = tuple(
    (Fraction(q), Fraction(p))
    for q, p in (("1", "1"), ("2/5", "9/4"), ("9/4", "2/5"), ("1/8", "1/8"), ("2", "2"))
)
_MAX_COORDINATES_FOR_ALL_SIGNS = 4  # with more coordinates, not every pattern of signs is tried


@dataclass(frozen=True)
class TrialPlace:
    """A state z with a time t, and the scales there.

    `units`: of each coordinate; `reach`: the distance that each may be moved before the field
    bends; `step`: the largest step size that is tried, 0 for a map; `source`: PATTERN, USER, or
    SIDE for a place on another side of a comparison in the code.
    """

    z: tuple[Fraction, ...]
    t: Fraction
    units: tuple[Fraction, ...]
    reach: tuple[Fraction, ...]
    step: Fraction = Fraction(0)
    source: str = PATTERN

    def with_rounded_state(self, nearest: Callable[[Fraction], Fraction]) -> "TrialPlace":
        """Return the same place with its state rounded by `nearest`."""
        return replace(self, z=tuple(map(nearest, self.z)))


def signs(count: int) -> list[tuple[int, ...]]:
    """Return patterns of signs: all, or enough that each two coordinates show every pair of signs.

    >>> len(signs(2)), len(signs(4)), len(signs(12)) <= 16
    (4, 16, True)
    """
    if count <= _MAX_COORDINATES_FOR_ALL_SIGNS:
        return list(product((1, -1), repeat=count))
    # Rows are added greedily until each two coordinates show all four pairs of signs. The seed is
    # fixed, so that the places are the same in every run.
    draw, rows = Random(1), [(1,) * count]  # noqa: S311 - any patterns do
    missing = {
        (a, b, x, y)
        for a, b in combinations(range(count), 2)
        for x, y in product((1, -1), repeat=2)
    }
    missing -= _pairs(rows[0])
    while missing:
        trials = [tuple(draw.choice((1, -1)) for _ in range(count)) for _ in range(30)]
        best = max(trials, key=lambda row: len(missing & _pairs(row)))
        rows.append(best)
        missing -= _pairs(best)
    return rows


def _pairs(row: Sequence[int]) -> set[tuple[int, int, int, int]]:
    return {(a, b, row[a], row[b]) for a, b in combinations(range(len(row)), 2)}


def states(units: Sequence[Fraction], variant: int = 0) -> list[tuple[Fraction, ...]]:
    """Build states z = (p, q) in these units: the patterns of signs, at small and large amplitudes.

    In the plane each pattern is taken at three amplitudes, in more degrees of freedom at one.
    `variant`: another number yields the same patterns at other states.
    """
    size, half = len(units), len(units) // 2
    patterns = signs(size)
    turns = 3 if size == 2 else 1
    result = []
    for turn in range(turns):
        for k, pattern in enumerate(patterns):
            of_q, of_p = _AMPLITUDES[(k + k // 4 + turn + variant) % len(_AMPLITUDES)]
            result.append(
                tuple(
                    sign
                    * unit
                    * _COORDINATE_FACTORS[(j + 3 * k + variant) % len(_COORDINATE_FACTORS)]
                    * (of_p if j < half else of_q)
                    for j, (sign, unit) in enumerate(zip(pattern, units, strict=True))
                )
            )
    return result


def select_spread(places: Sequence[TrialPlace], count: int) -> list[TrialPlace]:
    """Select `count` of the places, spread over all patterns and amplitudes."""
    size = len(places)
    # A prime stride that does not divide the number of places visits each of them once, mixed.
    stride = next((k for k in (7, 5, 3, 11) if size % k), 1)
    return [places[k * stride % size] for k in range(min(size, count))]


def round_to_simple(x: float) -> Fraction:
    """Return the nearest of 1, 2 and 5 times a power of ten: a unit that people can read.

    >>> [str(round_to_simple(x)) for x in (0.9, 3.4, 6500.0, 2e-7)]
    ['1', '2', '5000', '1/5000000']
    """
    if not 1e-300 < x < 1e300:
        return Fraction(1)
    scale = Fraction(10) ** int(f"{x:e}".partition("e")[2])
    return min((scale * k for k in (1, 2, 5, 10)), key=lambda u: abs(float(u) / x - 1))
