"""Linear limits of printed coefficients: gaps that the digits open are closed, others are not."""

from fractions import Fraction

import pytest

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.studies.stability.equilibrium import linear_at_equilibrium
from verify.studies.stability.scheme_interval import linear_stability
from verify.studies.stability.verdict_results import linear_limit

HALF = ("0.11888010966548", "0.29619504261126", "0.38111989033452", "0.40760991477748")
KINDS = ("kick", "drift") * 3 + ("kick",)
LONGEST = Fraction("4.66185")  # of six parts, by hand: |tr M| touches 2 twice before


def scheme_of(half: tuple[str, ...]) -> str:
    return "; ".join(map(" ".join, zip(KINDS, (*half, *half[-2::-1]), strict=True))) + "; order 2"


def test_a_gap_that_the_last_digits_open_is_closed() -> None:
    found = linear_stability(scheme_of(HALF))
    assert abs(Fraction(found.decimal()) - LONGEST) < Fraction(1, 10**5)
    assert "2.97632464058" in found.note
    assert abs(linear_limit(scheme_of(HALF)) - LONGEST) < Fraction(1, 10**5)


@pytest.mark.parametrize("place", [0, 1])
def test_a_gap_that_a_wrong_digit_opens_is_not(place: int) -> None:
    wrong = HALF[place][:8] + str((int(HALF[place][8]) + 4) % 10) + HALF[place][9:]
    sizes = [*(HALF[:place]), wrong, *HALF[place + 1 :]]
    # With the sums 1 still, so that the order is 2.
    other = place + 2
    total = Fraction(HALF[place]) * 2 + Fraction(HALF[other]) * (2 if place == 0 else 1)
    rest = (total - 2 * Fraction(wrong)) / (2 if place == 0 else 1)
    sizes[other] = f"{float(rest):.14f}"
    found = linear_stability(scheme_of(tuple(sizes)))
    assert Fraction(found.decimal()) < 3
    assert "close" not in found.note


def test_no_digit_is_told_that_the_coefficients_do_not_leave() -> None:
    half = ("0.67560360", "1.35120719", "-0.17560360", "-1.70241438")
    longer = ("0.675603595979", "1.351207191959", "-0.175603595979", "-1.702414383919")
    right = Fraction(linear_stability("yoshida4").decimal(40))
    digits = []
    for sizes in (half, longer):
        shown = linear_stability(scheme_of(sizes).replace("order 2", "order 4")).decimal()
        digits.append(len(shown))
        places = len(shown.partition(".")[2])
        assert abs(Fraction(shown) - right) <= Fraction(1, 10**places)
    assert 6 <= digits[0] < digits[1] <= 13


def test_at_an_equilibrium_the_largest_step_is_that_of_exact_coefficients() -> None:
    oscillators = Hamiltonian.parse("p1**2/2 + p2**2/2 + 2*q1**2 + q2**2/2")
    origin = dict.fromkeys(("p1", "p2", "q1", "q2"), Fraction(0))
    steps = [Fraction("2.3"), Fraction("2.34")]
    found = linear_at_equilibrium(oscillators, scheme_of(HALF), origin, steps)
    assert abs(Fraction(found.step_size) - LONGEST / 2) < Fraction(1, 10**5)
    assert found.decided == {steps[0]: True, steps[1]: False}


def test_a_limit_is_told_of_an_order_beyond_which_no_condition_is_known() -> None:
    verlet = "kick 0.50000000; drift 1.00000000; kick 0.50000000; order 8"
    assert abs(Fraction(linear_stability(verlet).decimal()) - 2) < Fraction(1, 10**6)


# Störmer–Verlet, whose halves differ by what the digits leave.
HALVES = "p_next = p - {a}*h*q - {b}*h*(q + h*p - {c}*h**2*q); q_next = q + h*p - {c}*h**2*q"


@pytest.mark.parametrize(
    ("a", "b", "c"),
    [
        ("0.50000000001", "0.49999999999", "1/2"),
        ("0.49999999999", "0.50000000001", "1/2"),
        ("0.50000000001", "0.49999999999", "0.5000000001"),
    ],
)
def test_a_limit_of_formulas_is_that_of_exact_numbers_near_them(a: str, b: str, c: str) -> None:
    found = linear_stability(HALVES.format(a=a, b=b, c=c))
    assert abs(Fraction(found.decimal(12)) - 2) < Fraction(1, 10**8)
    assert "det M = 1 with exact numbers near the printed ones" in str(found.note)


@pytest.mark.parametrize("a", ["0.50000010001", "0.501"])
def test_a_wrong_digit_of_formulas_leaves_no_stable_step(a: str) -> None:
    assert linear_stability(HALVES.format(a=a, b="0.49999999999", c="1/2")).interval == 0


def test_a_long_quotient_in_formulas_may_stand_for_another_number() -> None:
    """It is the only number that is rounded, and is moved by what it is known to."""
    kick = "p_next = p - (14142135623731/14142135623730)*h*q"
    found = linear_stability(f"{kick}; q_next = q + h*p_next")
    assert abs(Fraction(found.decimal(12)) - 2) < Fraction(1, 10**8)
