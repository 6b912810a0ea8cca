"""Laws of a tangent map's growth: its finite-time exponent, powers of t and exponentials."""

from math import log

import pytest

from verify.runs.tangent_growth import finite_time_lyapunov, is_exponential


def test_the_exponent_is_that_of_the_identity_s_growth() -> None:
    assert finite_time_lyapunov(log(2), 4, 3) == 0
    assert finite_time_lyapunov(log(2) + 1, 4, 2) == pytest.approx(0.5)


def test_powers_of_t_are_told_from_exponentials() -> None:
    times = [float(k) for k in range(101)]
    for power in (0, 1, 2):
        assert is_exponential(times, [power * log(1 + t) for t in times]) is False
    assert is_exponential(times, [t / 10 for t in times]) is True
    assert is_exponential(times, [t / 20 for t in times]) is None
