"""Powers read off errors: whole ones, above the noise, and none where there is none."""

import pytest

from verify.integrators.fitted_order import fitted

STEPS = [2.0**-k for k in range(2, 25)]


@pytest.mark.parametrize("power", [1, 2, 3, 6])
def test_a_power_is_read_above_the_noise(power: int) -> None:
    rows = [(h, 3 * h**power * (1 + h) + 1e-15, 1e-15) for h in STEPS]
    assert fitted(rows).power == power


def test_noise_alone_is_no_power() -> None:
    assert fitted([(h, 1e-15 * (1 + k % 3), 1e-15) for k, h in enumerate(STEPS)]).power is None


def test_a_tail_at_small_steps_is_what_holds() -> None:
    assert fitted([(h, h**4 + 1e-5 * h**2, 0.0) for h in STEPS]).power == 2


def test_but_not_where_it_is_the_rounding_of_coefficients() -> None:
    assert fitted([(h, h**5 + 1e-16 * h, 0.0) for h in STEPS]).power == 5


def test_what_a_tolerance_leaves_is_no_power() -> None:
    rows = [(h, 1e-14 * (k % 2 + 1) if k < 6 else 1e-19 * h**3, 0.0) for k, h in enumerate(STEPS)]
    assert fitted(rows).power is None


def test_errors_that_do_not_shrink_are_those_of_few_digits() -> None:
    rows = [(h, h**2 + 5e-7, 0.0) for h in STEPS]
    assert fitted(rows).power == 0
    found = fitted(rows, opaque=True)
    assert found.power == 2
    assert found.tail is not None
    assert not found.tail.small


def test_a_half_power_is_none() -> None:
    assert fitted([(h, h**2.5, 0.0) for h in STEPS]).power is None


def test_a_tail_that_a_tolerance_may_leave_is_told_and_does_not_count() -> None:
    rows = [(h, h**3 + 1e-8 * h, 0.0) for h in STEPS]
    assert fitted(rows).power == 1
    found = fitted(rows, opaque=True)
    assert found.power == 3
    assert found.tail is not None
    assert (found.tail.power, found.tail.small) == (1, True)


def test_a_tail_that_is_too_large_for_a_tolerance_counts() -> None:
    assert fitted([(h, h**3 + 1e-3 * h, 0.0) for h in STEPS], opaque=True).power == 1
