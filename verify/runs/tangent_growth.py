"""The rate at which neighbours of an orbit part: finite-time Lyapunov exponents, and chaos.

Both are computed from `ln ‖M‖` at several times, with M the tangent map from the orbit's start, or
its action on one direction. Where neighbours part like t^a, as on an orbit that is not chaotic, the
second half of a time adds a ln 2 to it, however long the time is. If they part exponentially, the
second half adds as much as the first (Benettin, Galgani, Giorgilli, Strelcyn, Meccanica 15, 1980).
"""

from collections.abc import Sequence
from math import log

# The gain of ln ‖M‖ in the second half of a time, where neighbours part like t^2.6 at most.
_LARGEST_POWER_GAIN = 2.6 * log(2)
_LEAST_EXPONENTIAL_GAIN = 4.0  # a power of t with this gain would be t^5.8


def finite_time_lyapunov(log_norm: float, size: int, time: float) -> float:
    """Return λ = ln(‖M‖/√m)/T in units of 1/time, the mean rate at which neighbouring orbits part.

    `log_norm`: ln of the Frobenius norm ‖M‖ after the time T > 0, for a tangent map of m = `size`
    rows that began as the identity, whose norm is √m. Or m = 1, and ‖M‖ is the length of the image
    of a direction of length 1. λ belongs to this orbit and this T: as T grows, it tends to 0 like
    ln(T)/T in quasi-periodic motion, and to the largest Lyapunov exponent in chaos.

    >>> finite_time_lyapunov(log(2) / 2 + 3, 2, 6)
    0.5
    """
    return (log_norm - log(size) / 2) / time


def is_exponential(times: Sequence[float], logs: Sequence[float]) -> bool | None:
    """Return True if neighbours part exponentially; None if the time is too short to decide."""
    # The largest value of each half is compared, as ln ‖M‖ oscillates.
    middle = times[-1] / 2
    first = max((y for t, y in zip(times, logs, strict=True) if t <= middle), default=0.0)
    second = max((y for t, y in zip(times, logs, strict=True) if t > middle), default=0.0)
    gain = second - max(first, 0.0)
    if gain >= _LEAST_EXPONENTIAL_GAIN:
        return True
    return False if gain <= _LARGEST_POWER_GAIN else None
