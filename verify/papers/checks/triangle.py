"""The triangle inequality of real numbers, checked in each order of the numbers.

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
    """Check |a − c| ≤ |a − b| + |b − c|; `middle`: the factor of the last distance."""
    holds = [_less(order, [("ac", 1)], [("ab", 1), ("bc", middle)]) for order in _orders()]
    return _check("|a − c| ≤ |a − b| + |b − c|", holds)


def difference(distance: str = "ab") -> Check:
    """Check | |b − c| − |a − c| | ≤ |a − b|; `distance`: the one on its right."""
    holds = [
        _less(order, [("bc", sign), ("ac", -sign)], [(distance, 1)])
        for order, sign in product(_orders(), (1, -1))
    ]
    return _check("| |b − c| − |a − c| | ≤ |a − b|", holds)


def _orders() -> Iterator[str]:
    return map("".join, permutations(_NAMES))


def _less(order: str, left: Sequence[tuple[str, int]], right: Sequence[tuple[str, int]]) -> bool:
    """Return True if Σ n·|u − v| over the left is at most that over the right, in that order."""
    terms = [*right, *((pair, -n) for pair, n in left)]
    gap = [sum(n * _distance(order, pair)[k] for pair, n in terms) for k in (0, 1)]
    # A linear form in x, y ≥ 0 without negative coefficients is never negative.
    return min(gap) >= 0


def _distance(order: str, pair: str) -> Form:
    # Neighbours in the order are x or y apart; the outer two are x + y apart.
    first, last = sorted(order.index(name) for name in pair)
    return int(first == 0), int(last == 2)


def _check(what: str, holds: Sequence[bool]) -> Check:
    how = "the difference is a sum of gaps between neighbours, none with a minus"
    return Check(f"{what} in each of the {len([*_orders()])} orders of a, b, c", all(holds), how)
