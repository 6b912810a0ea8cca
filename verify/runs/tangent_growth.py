"""How fast a tangent map has grown, over the finite time of one run."""

import math
from fractions import Fraction


def finite_time_lyapunov(norm: float, size: int, time: Fraction) -> float:
    """λ = ln(‖M‖/√m)/T in units of 1/time: the mean rate at which neighbouring orbits part.

    `norm`: ‖M‖ of Frobenius after the time T > 0, of a tangent map with m = `size` rows that began
    as 1, where it is √m. It is of this orbit and this T: it tends to 0 like ln(T)/T where motion is
    quasi-periodic, and to the greatest Lyapunov exponent in chaos, as T grows. ValueError for
    norm ≤ 0.

    >>> finite_time_lyapunov(math.sqrt(2) * math.e**3, 2, Fraction(6))
    0.5
    """
    return math.log(norm / math.sqrt(size)) / float(time)
