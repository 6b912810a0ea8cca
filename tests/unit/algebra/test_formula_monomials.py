"""A sum of monomials, which is read at once, is what it is when read node by node."""

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from verify.algebra.expressions.monomials import Monomials
from verify.algebra.formula import _Reader, parse
from verify.errors import InputError

_numbers = st.sampled_from(
    ["0", "1", "2", "13/4", "(-3/5)", "0.25", "1e-3", "(2/0)", "0x10", "1_0", "(1/3/2)", "007",
     "99999999999999999999999", "(-(-2))", "2**-1", "10**3", "1j"]
)  # fmt: skip
_names = st.sampled_from(["p", "q", "p", "q", "a", "b", "pi", "t", "h", "E", "inf", "sin"])
_powers = st.sampled_from(["0", "1", "2", "6", "40", "70", "-1", "(1/2)", "2.0"])
_factors = st.one_of(
    _numbers,
    _names,
    st.builds("{}**{}".format, _names, _powers),
    st.builds("sin({})".format, _names),
    st.builds("({}-{})".format, _numbers, _names),
)
_products = st.builds(
    "{}{}".format,
    st.sampled_from(["", "-", "+", "--"]),
    st.lists(_factors, min_size=1, max_size=4).map("*".join)
    | st.lists(_factors, min_size=1, max_size=3).map("/".join),
)


@drawn(300)
@given(st.lists(st.tuples(st.sampled_from("+-"), _products), min_size=1, max_size=5))
def test_a_sum_of_monomials_is_what_it_is_when_read_node_by_node(
    terms: list[tuple[str, str]],
) -> None:
    text = "".join(sign + term for sign, term in terms)
    with pytest.MonkeyPatch.context() as ordinary:
        ordinary.setattr(Monomials, "take", lambda *_: False)
        expected = read_or_refused(text)
    found = read_or_refused(text)
    assert found == expected
    assert str(found) == str(expected)  # 2 + 1/2 kept apart would have been equal in value alone


def read_or_refused(text: str) -> sympy.Expr | str:
    try:
        return parse(text)
    except InputError as error:
        return str(error)


@pytest.mark.parametrize("text", ["p + q*2/3", "-p**2/2 - 3*q", "p**3*q**2*4 + 1"])
def test_sums_of_monomials_are_read_at_once(text: str) -> None:
    with pytest.MonkeyPatch.context() as watched:
        watched.setattr(_Reader, "power", None)
        assert parse(text) == parse(text)
