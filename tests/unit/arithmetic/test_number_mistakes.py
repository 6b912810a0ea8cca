"""What a text that is no number is told to be: the number that is meant, or why there is none."""

from fractions import Fraction

import pytest

from verify.arithmetic.exact import rational
from verify.errors import InputError

MEANT = {
    "0,5": "0.5", "-0,5": "-0.5", "1.000,5": "1000.5", "1,000.5": "1000.5", "1,234,567": "1234567",
    "1,000": "1000 or 1.000", "1d-3": "1e-3", "2.5D+2": "2.5e+2", "0.5f": "0.5", "1_000": "1000",
    "1 / 2": "1/2", "- 1.5": "-1.5", "−1.5": "-1.5", "–1": "-1", "½": "1/2", "１．５": "1.5",
    "'1.5'": "1.5", "“0.1”": "0.1", "[1.5]": "1.5", "(1.5)": "1.5", "=1.5": "1.5", "50%": "50/100",
    "0x10": "16", "1.5/2.5": "3/5", "1/3.0": "1/3", "1.5*10^-3": "1.5e-3", "2*10**3": "2e3",
}  # fmt: skip
WHY = {
    "pi/2": "numbers are rational; write as many digits", "π": "numbers are rational",
    "sqrt(2)": "numbers are rational", "e": "numbers are rational", "30°": "no unit",
    "1.5 rad": "no unit", "inf": "every number is finite", "-Infinity": "every number is finite",
    "nan": "every number is finite", "∞": "every number is finite", "2j": "numbers are real",
    "1+1": "nothing is calculated here; write the result", "2**3": "write the result",
    "1/2/3": "write the result", "1.5 0": "", "1,5,7": "", "one": "", "q": "", "": "", "1/0.0": "",
    "١": "", "1e": "", "0xZZ": "", "1" * 80 + ",5": "",
}  # fmt: skip


@pytest.mark.parametrize(("text", "meant"), MEANT.items(), ids=ascii)
def test_the_number_that_is_meant_is_written(text: str, meant: str) -> None:
    with pytest.raises(InputError) as info:
        rational(text, "q")
    assert info.value.problem == f"is no number as it is written; write {meant}"
    for each in meant.split(" or "):
        assert isinstance(rational(each), Fraction)


@pytest.mark.parametrize(("text", "why"), WHY.items(), ids=ascii)
def test_where_none_is_meant_the_reason_and_what_is_allowed_are_told(text: str, why: str) -> None:
    with pytest.raises(InputError) as info:
        rational(text, "q")
    assert info.value.problem.startswith("not a finite number")
    assert why in info.value.problem
    assert info.value.problem.endswith("; allowed: 0.001, 1e-3, 7/3")
