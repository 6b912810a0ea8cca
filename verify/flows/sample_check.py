"""A numerical flow of many points in float64, held against a sample solved with more digits.

In the plane and in n degrees of freedom the points follow a numerical flow together and twice, by
extrapolations of two orders. Where the two are apart by more than `TRUSTED` a point is solved by
itself; else by how much they are apart estimates its error.
"""

from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction

from verify.flows.extrapolation import NoFlowError

COLUMNS = 8, 7  # of the two extrapolations
UNIT = 2.0**-53  # the rounding of a result, relative to it
TRUSTED = 1e-8  # the most, of an orbit's scale, that the two may be apart
SAMPLE, DIGITS = 3, 20  # points that are held against a solution with so many digits
METHOD = "numerical flow: Gragg's method, extrapolated, in long double"
_SAFETY = 4  # an error is at most so many times what it is estimated to be by another evaluation
Solved = Callable[[int], tuple[Sequence[float], float]]


def checked_bound(
    found: Callable[[int], Sequence[float]],
    solved: Solved,
    sample: Iterable[int],
    apart: float,
    time: Fraction,
) -> float:
    """A bound of the errors of points that are `apart` at most, by what the sample's are.

    `found(i)` are the coordinates of point i at this time, `solved(i)` the same with more digits,
    and their errors. Raises NoFlowError where an error is larger than was estimated.
    """
    estimated, worst = _SAFETY * apart, 0.0
    for i in sample:
        true, bound = solved(i)
        error = max(abs(float(x) - y) for x, y in zip(found(i), true, strict=True))
        worst = max(worst, error + bound)
        if error > _SAFETY * estimated:
            raise NoFlowError(
                f"point {i} is wrong by `{error:.2g}` at t = `{float(time):.6g}`, where "
                f"`{estimated:.2g}` was estimated"
            )
    return max(estimated, _SAFETY * worst)
