"""Between what the largest error over a period lies: of the oscillator, where it is known."""

import math
from fractions import Fraction

import pytest

from tests.helpers.constructed.runs import made_run
from verify.claims.kinds.comparisons.solution_error import _crest, _Error, _format_error, _largest
from verify.hamiltonians.hamiltonian import Hamiltonian

OSCILLATOR = Hamiltonian.parse("p**2/2 + q**2/2")
START = (Fraction(0), Fraction(1))  # p, q; its reach is 1 in both
OFF = (Fraction(3, 100), Fraction(4, 100))  # 0.05, which turns with the solution


def largest(
    time: float, off: tuple[Fraction, Fraction] = OFF
) -> tuple[Fraction, Fraction, Fraction]:
    exact = (Fraction(-math.sin(time)), Fraction(math.cos(time)))
    end = (exact[0] + off[0], exact[1] + off[1])
    bounds = _largest(OSCILLATOR, START, end, Fraction(time), Fraction(0))
    assert bounds is not None
    return bounds


@pytest.mark.parametrize("time", [20000.0, 20001.7, 300.25, 70.5])
def test_the_largest_error_of_the_oscillator_lies_between_them(time: float) -> None:
    low, high, reach = largest(time)
    periods = time / (2 * math.pi)
    assert low <= 0.05 <= high
    assert float(high - low) <= 0.05 * (4.1 / periods + 0.002)
    assert 0.95 < reach <= 1


def test_of_fewer_than_ten_periods_it_is_the_error_at_the_end() -> None:
    low, high, _ = largest(60.0)
    assert low <= 0.04 <= high < 0.05 * 0.9


def test_an_error_at_the_end_that_is_the_largest_is_not_made_less_by_the_drift() -> None:
    low, high, _ = largest(70.5, (Fraction(0), Fraction(1, 20)))
    assert Fraction("0.0498") < low <= Fraction(1, 20) <= high


def test_a_crest_rises_by_a_quarter_of_the_bend_and_a_valley_by_nothing() -> None:
    hill = [Fraction(-k * k) for k in (-3, -2, -1, 0, 1, 2)]
    assert _crest(hill) == Fraction(1, 2)
    assert _crest([-x for x in hill]) == 0
    assert _crest(hill[:2]) == 0
    assert _crest([Fraction(0), Fraction(8), Fraction(0)]) == 4


def test_digits_of_an_error_are_those_that_are_known_or_a_bound() -> None:
    run = made_run("0.01", {})
    assert _format_error(_Error(run, Fraction("0.1234"), Fraction("0.1236"))) == "1.2e-01"
    assert _format_error(_Error(run, Fraction("0.11"), Fraction("0.13"))) == "1e-01"
    assert _format_error(_Error(run, Fraction("0.01"), Fraction("0.13"))) == "1.30e-01"
