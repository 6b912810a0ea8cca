"""The triangle inequality of real numbers, by the order in which they stand.

In each order of three numbers a, b, c the distances are sums of the two gaps x, y ≥ 0 between
neighbours. An inequality between sums of distances holds where the right side less the left one
has no negative coefficient of x or y; equal numbers are those with x = 0 or y = 0.
"""

from collections.abc import Iterator, Sequence
from itertools import permutations, product

from verify.papers.checks.check import Check

Form = tuple[int, int]  # the coefficients of x and y
_NAMES = "abc"


def triangle(middle: int = 1) -> Check:
    """|a − c| ≤ |a − b| + |b − c|; `middle`: how often the last distance counts."""
    holds = [_less(order, [("ac", 1)], [("ab", 1), ("bc", middle)]) for order in _orders()]
    return _check("|a − c| ≤ |a − b| + |b − c|", holds)


def difference(of: str = "ab") -> Check:
    """| |b − c| − |a − c| | ≤ |a − b|; `of`: the distance on its right."""
    holds = [
        _less(order, [("bc", sign), ("ac", -sign)], [(of, 1)])
        for order, sign in product(_orders(), (1, -1))
    ]
    return _check("| |b − c| − |a − c| | ≤ |a − b|", holds)


def _orders() -> Iterator[str]:
    return map("".join, permutations(_NAMES))


def _less(order: str, left: Sequence[tuple[str, int]], right: Sequence[tuple[str, int]]) -> bool:
    """Whether Σ n·|u − v| over the left is no greater than that over the right, in that order."""
    terms = [*right, *((pair, -n) for pair, n in left)]
    gap = [sum(n * _distance(order, pair)[k] for pair, n in terms) for k in (0, 1)]
    return min(gap) >= 0


def _distance(order: str, pair: str) -> Form:
    first, last = sorted(order.index(name) for name in pair)
    return int(first == 0), int(last == 2)


def _check(what: str, holds: Sequence[bool]) -> Check:
    how = "the difference is a sum of gaps between neighbours, none with a minus"
    return Check(f"{what} in each of the {len([*_orders()])} orders of a, b, c", all(holds), how)
