"""Numbers and sentences as the pages set them."""

import pytest

from verify.pages.text import typography
from verify.scenes.results.bounded_value import Value


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("-1.230e-05", "−1.230 × 10⁻⁵"),
        ("1e+22", "1 × 10²²"),
        ("-0.25", "−0.25"),
        ("7/3", "7/3"),
        ("5.0e+00", "5.0"),
    ],
)
def test_a_number_keeps_its_digits(text: str, shown: str) -> None:
    assert typography.number(text).replace("\xa0", " ") == shown


def test_a_value_without_a_known_digit_is_shown_as_a_bound() -> None:
    assert "≤\xa03.00\xa0×\xa010⁻⁹" in typography.value(Value(value="0", bound="3.00e-09"))
    assert typography.value(Value(value="0", bound="0")) == "0"


@pytest.mark.parametrize(
    ("text", "markup"),
    [
        ("ΔJ_k = O(h^4)", "ΔJ<sub>k</sub> = O(h⁴)"),
        ("H_qq and z̄_(k+1)", "H<sub>qq</sub> and z̄<sub>k+1</sub>"),
        ("x_k², e_n", "x<sub>k</sub>², e<sub>n</sub>"),
        ("h^η X^(η−k)", "h<sup>η</sup> X<sup>η−k</sup>"),
        ("(−D)^((η+1)/2)", "(−D)<sup>(η+1)/2</sup>"),
        ("(1 + hL_p)", "(1 + hL<sub>p</sub>)"),
        ("p_next stays", "p_next stays"),
        ("from -21.95 to 2.6e+05", "from −21.95 to 2.6\xa0×\xa010⁵"),
        ("at p = 7/17 it is [0.5 +/- 2e-13]", "0.5\xa0±\xa02\xa0×\xa010⁻¹³"),
        ("the difference is h**2*q", "the difference is <math>"),
        ("a <b> & 2 * 3 of them", "a &lt;b&gt; &amp; <math>"),
        ("symplectic-euler and x-1 stay", "symplectic-euler and x-1 stay"),
    ],
)
def test_a_sentence_is_set_with_its_formulas_and_numbers(text: str, markup: str) -> None:
    assert markup in typography.prose(text)
