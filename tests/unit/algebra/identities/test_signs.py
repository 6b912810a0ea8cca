"""Signs of polynomials, against their values."""

from collections.abc import Iterator
from dataclasses import dataclass
from random import Random

import flint
import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from verify.algebra.formula import parse
from verify.algebra.identities import signs
from verify.algebra.identities.signs import definite_sign
from verify.errors import InputError

CONTEXT = flint.fmpq_mpoly_ctx.get(["a", "b", "c"], flint.Ordering.lex)
MONOMIALS = st.tuples(*[st.integers(0, 4)] * 3)


@dataclass(frozen=True)
class Given:
    """a is positive and b between −1 and 1."""

    def is_positive(self, place: int) -> bool:
        return place == 0

    def is_bounded(self, place: int) -> bool:
        return place == 1


def points(seed: int) -> Iterator[tuple[flint.fmpq, flint.fmpq, flint.fmpq]]:
    rng = Random(seed)  # noqa: S311 - no secret
    for _ in range(30):
        a, b, c = rng.randint(1, 30), rng.randint(-9, 9), rng.randint(-30, 30)
        yield flint.fmpq(a, 9), flint.fmpq(b, 9), flint.fmpq(c, 9)


@drawn(100)
@given(
    st.dictionaries(MONOMIALS, st.sampled_from([1, 1, 2, 3, -1, -2]), min_size=1, max_size=4),
    st.sampled_from([0, 1, 1, 7, -7]),
    st.integers(0, 10**6),
)
def test_no_value_has_another_sign_than_the_one_that_is_shown(
    terms: dict[tuple[int, ...], int], number: int, seed: int
) -> None:
    x = CONTEXT.from_dict(dict(terms)) + number
    sign, strictly = definite_sign(x, Given()), definite_sign(x, Given(), strict=True)
    assert strictly in (None, sign)
    for point in points(seed):
        assert sign is None or sign * x(*point) >= 0
        assert strictly is None or x(*point) != 0


def test_a_square_that_is_written_out_has_its_sign() -> None:
    a, b, c = CONTEXT.gens()
    assert definite_sign((b + c) ** 2 + 1, Given(), strict=True) == 1
    assert definite_sign((b + c) ** 2 - 1, Given()) is None
    assert definite_sign(-(c**4) * (a + 1) - a, Given(), strict=True) == -1


def test_that_a_squared_distance_vanishes_somewhere_is_seen_without_a_search(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The search for a proof ends in none, too, after thousands of polynomials in six letters."""
    u, v, x, y, z, w = flint.fmpq_mpoly_ctx.get([*"uvxyzw"], flint.Ordering.lex).gens()
    distance = (u - v) ** 2 + (x - y) ** 2 + (z - w) ** 2
    assert definite_sign(u * (1 + y**2), Given(), strict=True) == 1, "u is positive"
    monkeypatch.setattr(Given, "is_positive", lambda *_: False)
    assert definite_sign(u**2 + 1, Given(), strict=True) == 1
    monkeypatch.setattr(signs, "_definite_sign", lambda *_: pytest.fail("searched"))
    assert definite_sign(distance, Given(), strict=True) is None


@pytest.mark.parametrize(
    ("text", "equal"),
    [
        ("sqrt((q**2-q+1)**2)", "q**2-q+1"),
        ("sqrt((sin(q)-2)**2)", "2-sin(q)"),
        ("sqrt((1+sin(q))**2*(p+1))", "sqrt(p+1)*(1+sin(q))"),
        ("((q**2-q+1)**2)**(1/4)", "sqrt(q**2-q+1)"),
        ("sqrt((p*q+p**2+q**2)**2)", "p**2+p*q+q**2"),
        ("sqrt((-1-q**2)**2)", "1+q**2"),
    ],
)
def test_the_root_of_a_square_of_what_has_one_sign_is_read(text: str, equal: str) -> None:
    assert sympy.expand(parse(text) - parse(equal)) == 0


@pytest.mark.parametrize(
    "text",
    ["sqrt((q-1)**2)", "sqrt((exp(q)-1)**2)", "sqrt((1/2+sin(q))**2)", "sqrt((q**2-3*q+1)**2)",
     "sqrt((p**2+3*p*q+q**2)**2)", "sqrt(((q**2-q+1)*p)**2)", "sqrt((delta+q**2)**2)"],
)  # fmt: skip
def test_of_what_may_have_either_it_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="not smooth"):
        parse(text)
