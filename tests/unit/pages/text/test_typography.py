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
