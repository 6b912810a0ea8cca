"""The rate at which neighbours of an orbit part: finite-time Lyapunov exponents, and chaos.

Both are computed from `ln ‖M‖` at several times, with M the tangent map from the orbit's start, or
its action on one direction: where neighbours part like a power of t, as on an orbit that is not
chaotic, the second half of a time adds a few times ln 2 to it, however long that is; where they
part exponentially it adds half of all (Benettin, Galgani, Giorgilli, Strelcyn, Meccanica 15, 1980).
"""

from collections.abc import Sequence
from math import log

_POWER = 2.6 * log(2)  # at most, of neighbours that part like t^2.6
_EXPONENTIAL = 4.0  # at least, of those that part exponentially: a power of t beyond 5


def finite_time_lyapunov(log_norm: float, size: int, time: float) -> float:
    """Return λ = ln(‖M‖/√m)/T in units of 1/time, the mean rate at which neighbouring orbits part.

    `log_norm`: ln ‖M‖ of Frobenius after the time T > 0, of a tangent map with m = `size` rows that
    began as 1, where it is ln √m; or m = 1 and its action on a direction of length 1. It is of
    this orbit and this T: it tends to 0 like ln(T)/T where motion is quasi-periodic, and to the
    greatest Lyapunov exponent in chaos, as T grows.

    >>> finite_time_lyapunov(log(2) / 2 + 3, 2, 6)
    0.5
    """
    return (log_norm - log(size) / 2) / time


def is_exponential(times: Sequence[float], logs: Sequence[float]) -> bool | None:
    """Return True if neighbours part exponentially; None if the time is too short to decide."""
    # Where neighbours part like t^a, the second half of the time adds a ln 2 at most, however long
    # it is; where they part exponentially it adds as much as the first half.
    middle = times[-1] / 2
    first = max((y for t, y in zip(times, logs, strict=True) if t <= middle), default=0.0)
    second = max((y for t, y in zip(times, logs, strict=True) if t > middle), default=0.0)
    gain = second - max(first, 0.0)
    if gain >= _EXPONENTIAL:
        return True
    return False if gain <= _POWER else None
