"""Claims of comparison, on runs built by hand: true, false, and too uncertain to tell.

Each kind has a true instance, planted falsehoods, and values whose balls straddle what they are
compared with.
"""

from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.constructed.runs import (
    CLAIM,
    FLAT,
    STARTS,
    STEP_SIZES,
    Given,
    Values,
    check,
    one_changed,
)
from verify.claims.kinds.less import LessClaim
from verify.claims.kinds.magnitude import MagnitudeClaim
from verify.claims.kinds.monotone import MonotoneClaim
from verify.claims.kinds.spread import SpreadClaim
from verify.verdict import Verdict

MEASURED, REFUTED, UNDECIDED = Verdict.MEASURED, Verdict.REFUTED, Verdict.UNDECIDED
H = [Fraction(h) for h in STEP_SIZES]
LAST = (H[-1], len(STARTS) - 1)  # where a mistake is put: at the last run of all

# -- spread ---------------------------------------------------------------------------------------

FACTORS = [Fraction(1), Fraction(19, 10), Fraction(3, 2)]  # at the three initial values


def spread(factor: Any = 2, quantity: Any = "mse") -> SpreadClaim:
    return SpreadClaim(**CLAIM, kind="spread", quantity=quantity, factor=factor)


def spreading(h: Fraction, k: int) -> dict[str, Given]:
    return {**FLAT, "mse": h**6 * FACTORS[k], "lambda": -(h**2) / FACTORS[k]}


@pytest.mark.parametrize("quantity", ["mse", "abs_lambda"])
@pytest.mark.parametrize(
    ("factor", "expected"), [("2", MEASURED), ("1.91", MEASURED), ("1.89", REFUTED), ("1", REFUTED)]
)
def test_a_spread_is_held_against_its_factor(quantity: str, factor: str, expected: Verdict) -> None:
    assert check(spread(factor, quantity), spreading).verdict is expected


def test_one_initial_value_that_stands_out_refutes_a_spread() -> None:
    for size in (Fraction(3), Fraction(1, 3)):
        values = one_changed(LAST, "mse", H[-1] ** 6 * size, spreading)
        assert check(spread(), values).verdict is REFUTED


@pytest.mark.parametrize("place", range(3))
def test_a_spread_is_undecided_where_any_of_its_balls_reaches_beyond(place: int) -> None:
    """Also where the ball that reaches beyond has neither the least nor the greatest middle."""
    wide = (H[-1] ** 6 * Fraction(3, 2), H[-1] ** 6 * Fraction(3, 4))
    values = one_changed((H[-1], place), "mse", wide, spreading)
    assert check(spread(), values).verdict is UNDECIDED


@pytest.mark.parametrize(
    ("quantity", "unknown"),
    [("mse", "mse"), ("abs_lambda", "lambda"), ("mse_over_lambda", "mse"),
     ("mse_over_lambda", "lambda")],
)  # fmt: skip
def test_a_spread_with_an_unknown_value_is_undecided(quantity: str, unknown: str) -> None:
    values = one_changed(LAST, unknown, ("0", "1e-3"), spreading)
    # MSE/|Λ| spreads by the product of what its parts do.
    assert check(spread(4, quantity), values).verdict is UNDECIDED


# -- monotone -------------------------------------------------------------------------------------


def monotone(quantity: Any, direction: Any) -> MonotoneClaim:
    return MonotoneClaim(**CLAIM, kind="monotone", quantity=quantity, direction=direction)


def growing(h: Fraction, k: int) -> dict[str, Given]:
    """MSE and |Λ| grow with h, and MSE/|Λ| too."""
    sign = -1 if k % 2 else 1
    return {"mse": (k + 1) * h**6, "lambda": sign * (k + 1) * h**2, "delta_j_max": h**3}


QUANTITIES = ("mse", "abs_lambda", "mse_over_lambda", "delta_j_max")


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_what_grows_is_measured_to_increase_and_refuted_to_decrease(quantity: str) -> None:
    assert check(monotone(quantity, "increases"), growing).verdict is MEASURED
    assert check(monotone(quantity, "decreases"), growing).verdict is REFUTED


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_the_order_of_the_step_sizes_in_the_scene_does_not_matter(quantity: str) -> None:
    mixed = ("0.004", "0.001", "0.01", "0.002", "0.008", "0.006")
    assert check(monotone(quantity, "increases"), growing, step_sizes=mixed).verdict is MEASURED


@pytest.mark.parametrize("index", range(1, len(H)))
def test_one_step_the_other_way_refutes_and_is_named(index: int) -> None:
    smaller = H[index - 1] ** 6 * Fraction(99, 100) * len(STARTS)
    values = one_changed((H[index], len(STARTS) - 1), "mse", smaller, growing)
    found = check(monotone("mse", "increases"), values)
    assert found.verdict is REFUTED
    assert "MSE decreases in 1 of " in found.evidence
    assert f" at h = {STEP_SIZES[index - 1]} to " in found.evidence
    assert f" at h = {STEP_SIZES[index]} with q₀ = " in found.evidence


@pytest.mark.parametrize("bound", [Fraction(1), Fraction(1, 2)])
def test_neighbours_whose_balls_touch_leave_it_undecided(bound: Fraction) -> None:
    values = one_changed(LAST, "mse", (3 * H[-1] ** 6, 3 * H[-1] ** 6 * 2 * bound), growing)
    assert check(monotone("mse", "increases"), values).verdict is UNDECIDED
    assert check(monotone("mse", "decreases"), values).verdict is REFUTED


def test_equal_values_are_not_measured_to_increase() -> None:
    found = check(monotone("mse", "increases"), lambda h, k: FLAT)
    assert found.verdict in (REFUTED, UNDECIDED)


def test_nothing_is_said_of_a_single_step_size() -> None:
    found = check(monotone("mse", "increases"), growing, step_sizes=("0.01",))
    assert found.verdict is UNDECIDED, found.evidence


# -- less -----------------------------------------------------------------------------------------


def less(quantity: Any = "mse", than: Any = "abs_lambda") -> LessClaim:
    return LessClaim(**CLAIM, kind="less", quantity=quantity, than=than)


def test_the_smaller_is_measured_to_be_less_and_the_greater_refuted() -> None:
    assert check(less(), growing).verdict is MEASURED
    assert check(less("abs_lambda", "mse"), growing).verdict is REFUTED


@pytest.mark.parametrize(
    ("mse", "lam", "expected"),
    [
        ("2e-2", "1e-2", REFUTED),
        ("2e-2", "-1e-2", REFUTED),
        ("1e-12", ("2e-4", "1e-3"), UNDECIDED),
        ("1e-12", ("0", "1e-3"), UNDECIDED),
        (("9e-3", "2e-3"), "1e-2", UNDECIDED),
        (("9e-3", "5e-4"), "-1e-2", MEASURED),
    ],
)
def test_one_run_decides_against_less(mse: Given, lam: Given, expected: Verdict) -> None:
    values = one_changed(LAST, "mse", mse, one_changed(LAST, "lambda", lam, growing))
    assert check(less(), values).verdict is expected


# -- magnitude ------------------------------------------------------------------------------------


def magnitude(quantifier: Any, **exponents: int) -> MagnitudeClaim:
    return MagnitudeClaim(**CLAIM, kind="magnitude", step_size=H[0], exponents=exponents,
                          quantifier=quantifier)  # fmt: skip


def about(*sizes: Given) -> Values:
    return lambda h, k: {**FLAT, "lambda": sizes[k] if h == H[0] else "1"}


@pytest.mark.parametrize(
    ("sizes", "some", "every"),
    [
        (("1e-5", "-3.1e-5", "3.2e-6"), MEASURED, MEASURED),
        (("1e-5", "3.2e-5", "1e-7"), MEASURED, REFUTED),
        (("3.1e-5", "3.1e-6", "-1"), MEASURED, REFUTED),
        (("3.2e-5", "3.2e-5", "3.16e-6"), REFUTED, REFUTED),
        (("1e-5", "1e-5", ("3.16e-5", "1e-6")), MEASURED, UNDECIDED),
        (("1", "1", ("3.16e-5", "1e-6")), UNDECIDED, REFUTED),
        (("1e-5", "1e-5", ("0", "1e-5")), MEASURED, UNDECIDED),
    ],
)
def test_about_a_power_of_ten_is_within_half_a_power(
    sizes: tuple[Given, ...], some: Verdict, every: Verdict
) -> None:
    claims = {"some": magnitude("some", abs_lambda=-5), "every": magnitude("every", abs_lambda=-5)}
    assert check(claims["some"], about(*sizes)).verdict is some
    assert check(claims["every"], about(*sizes)).verdict is every


def test_all_the_quantities_named_must_have_their_magnitudes_at_one_initial_value() -> None:
    def values(_: Fraction, k: int) -> dict[str, Given]:
        return {**FLAT, "lambda": "1e-5" if k else "1", "delta_j_max": "1" if k else "1e-9"}

    both = magnitude("some", abs_lambda=-5, delta_j_max=-9)
    assert check(both, values).verdict is REFUTED
    assert check(magnitude("some", abs_lambda=-5), values).verdict is MEASURED
