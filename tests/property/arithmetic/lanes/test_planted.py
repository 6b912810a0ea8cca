"""What is planted in lanes is caught, and what they allow for is more than is lost."""

from fractions import Fraction
from typing import Any

import pytest
from llvmlite import ir

from tests.helpers.lanes import IN_LANES, Both, number
from tests.property.arithmetic.lanes.cases import (
    FUNCTIONS,
    LONG_SUM,
    OPERATIONS,
    Draws,
    at_a_half,
    both,
    differing,
    first_differing,
    operands,
    small_squares,
)
from verify.arithmetic.lanes import multiply_add, transcendentals
from verify.arithmetic.lanes.functions import LaneFunctions
from verify.arithmetic.lanes.numbers import FunctionValues, Numbers
from verify.arithmetic.lanes.vectors import CONDITIONS, LANES


@pytest.mark.left_to_ci
@pytest.mark.parametrize(("width", "count"), [(128, 20_000), (156, 200_000)])
def test_lanes_that_never_ask_for_the_last_bit_are_caught(
    width: int, count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where all are taken to be sure, one in a thousand arguments or so is rounded otherwise; at
    156 bits one in some tens of thousands."""
    monkeypatch.setattr(transcendentals, "error_of_one_orbit", lambda fraction: 0)
    monkeypatch.setattr(transcendentals, "_circle_error", lambda count: 0)
    pair = Both(FUNCTIONS["circle"], width, IN_LANES[0])
    draws = Draws(5)
    rows = [(number(draws.bits(width - 12), width),) for _ in range(count)]
    assert first_differing(pair, rows)


def test_what_one_orbit_loses_is_less_than_lanes_allow_for() -> None:
    """By values to twice the digits: the nearest number, and how far it is from another one."""
    draws, width = Draws(11), 128
    pair = both(FUNCTIONS["circle"], width, IN_LANES[0])
    finer = both(FUNCTIONS["circle"], 2 * width, IN_LANES[0])
    most = Fraction(0)
    for _ in range(3000):
        raw = draws.bits(width - 2) - (1 << (width - 3))
        found = pair.of_one((number(raw, width),))
        true = finer.of_one((number(raw << width, 2 * width),))
        for x, y in zip(found, true, strict=True):
            exact = Fraction(y.raw, 2 ** (2 * width - 16)) * 2 ** (width - 16)
            most = max(most, abs(x.raw - exact) - Fraction(1, 2))
    # An ulp is 2^14 of the units in which it is counted.
    assert most * 2**14 <= transcendentals.error_of_one_orbit(width - 16)


def test_what_one_orbits_exp_loses_is_less_than_lanes_allow_for() -> None:
    """It cuts what is below a unit, and what it loses before is a part of a unit for e^x < 2^14."""
    draws, width = Draws(13), 128
    pair = both(FUNCTIONS["exp"], width, IN_LANES[0])
    finer = both(FUNCTIONS["exp"], 2 * width, IN_LANES[0])
    for _ in range(3000):
        raw = draws.bits(width - 12) - (1 << (width - 13))  # |x| < 8
        x = pair.of_one((number(raw, width),))
        y = finer.of_one((number(raw << width, 2 * width),))
        exact = Fraction(y.raw, 2 ** (2 * width - 16)) * 2 ** (width - 16)
        lost = Fraction(transcendentals.error_of_one_orbit(width - 16), 2**14) * max(
            1, exact / 2 ** (width - 16)
        )
        assert exact - 1 - lost <= x.raw <= exact + lost


def test_exp_that_never_asks_for_the_last_bit_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(transcendentals, "error_of_one_orbit", lambda fraction: 0)
    monkeypatch.setattr(transcendentals, "_exponential_error", lambda count: 0)
    pair = Both(FUNCTIONS["exp"], 128, IN_LANES[0])
    draws = Draws(7)
    assert first_differing(pair, [(number(draws.bits(116), 128),) for _ in range(20_000)])


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("name", ["circle", "exp", "sinh", "sqrt", "inverse"])
def test_most_lanes_do_not_ask_one_orbit(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where what one orbit's function gives is thrown away, few values are wrong, or none."""

    def zeros(self: LaneFunctions, b: ir.IRBuilder, *_: Any) -> FunctionValues:
        nothing = self.numbers.constant(0, self.numbers.size)
        valid = ir.Constant(CONDITIONS, [1] * LANES)
        return FunctionValues([nothing] * (2 if name == "circle" else 1), valid)

    monkeypatch.setattr(LaneFunctions, "_one_by_one", zeros)
    pair = Both(FUNCTIONS[name], 128, IN_LANES[0])
    draws = Draws(17)
    rows = [(number(draws.bits(111) + (1 << 111), 128),) for _ in range(2000)]  # ½ … 1
    wrong = len(list(differing(pair, rows)))
    assert wrong <= (0 if name in ("sqrt", "inverse") else 100)


@pytest.mark.parametrize("planted", ["_take_signs", "carry", "from_words"])
def test_a_step_left_out_of_a_product_is_caught(
    monkeypatch: pytest.MonkeyPatch, planted: str
) -> None:
    wrong: dict[str, Any] = {
        "_take_signs": lambda self, b, columns, x, y: None,
        "carry": lambda self, b, x: x.limbs,
        "from_words": lambda self, b, words, width: self.from_settled([words[0], *words], width),
    }
    monkeypatch.setattr(Numbers, planted, wrong[planted])
    way = "portable" if planted == "_take_signs" else IN_LANES[0]
    pair = Both(OPERATIONS, 128, way, {"limit": number(3 << 109, 128)})
    assert first_differing(pair, operands(128, seed=1, count=40))


@pytest.mark.parametrize("way", IN_LANES)
def test_sums_whose_carries_are_never_moved_are_caught(
    way: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Numbers, "light", lambda self, b, x: x)
    assert first_differing(Both(LONG_SUM, 192, way), small_squares(192))


AVX2 = pytest.mark.skipif("avx2" not in IN_LANES, reason="this processor has no AVX2")


@AVX2
def test_a_product_that_never_asks_for_all_columns_is_caught(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(Numbers, "_omission_bound", staticmethod(lambda first: 0))
    pair = Both(OPERATIONS, 192, "avx2", {"limit": number(3 << 173, 192)})
    assert first_differing(pair, at_a_half(192, seed=1))


@AVX2
@pytest.mark.parametrize("planted", ["_ABOUT_0", "_HIGH", "_HIGH_ABOUT_0"])
def test_a_product_that_is_split_elsewhere_is_caught(
    planted: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A constant next to the right one splits it into other parts than are added up."""
    right = getattr(multiply_add, planted)
    monkeypatch.setattr(multiply_add, planted, right * 2)
    pair = Both(OPERATIONS, 128, "avx2", {"limit": number(3 << 109, 128)})
    assert first_differing(pair, operands(128, seed=1, count=40))
