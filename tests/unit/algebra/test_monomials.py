"""A sum of monomials whose text need not be read again would be read as it is."""

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from verify.algebra import formula
from verify.algebra.expressions.formula_text import to_text
from verify.algebra.expressions.monomials import reads_back
from verify.algebra.formula import MAX_LENGTH, parse, symbol
from verify.errors import InputError
from verify.hamiltonians import hamiltonian
from verify.hamiltonians.hamiltonian import Hamiltonian

_numbers = st.fractions(max_denominator=10**20).filter(bool) | st.sampled_from([1, -1, 7])
_powers = st.sampled_from([0, 0, 1, 2, 5, 64, 65, -1])
_terms = st.tuples(_numbers, *[_powers] * 3)
_others = st.sampled_from(["", "", "", " + sin(q)", " + 2*(p + q)", " - pi*p", " + sqrt(q)"])


@given(terms=st.lists(_terms, min_size=1, max_size=6), other=_others)
@drawn(300)
def test_what_surely_reads_back_does(
    terms: list[tuple[sympy.Rational, int, int, int]], other: str
) -> None:
    written = " + ".join(f"({c})*p**({i})*q**({j})*E**({k})" for c, i, j, k in terms)
    try:
        found = parse(written + other)
    except InputError:
        return
    text = to_text(found)
    if reads_back(found, MAX_LENGTH):
        again = parse(text)
        assert again == found
        assert (again.args, str(again)) == (found.args, str(found))
        assert len(text) <= MAX_LENGTH
        assert not reads_back(found, len(text) - 1)


@pytest.mark.parametrize("text", ["p + q", "p**2/2 - 3*q**64*delta/7 + 1", "-p - 10**17*q"])
def test_a_polynomial_surely_reads_back(text: str) -> None:
    assert reads_back(parse(text), MAX_LENGTH)


P, Q = symbol("p"), symbol("q")
OTHERS = {
    "a function": P + sympy.sin(Q),
    "a root": P + sympy.sqrt(Q),
    "an inverse": P + 1 / Q,
    "a product of sums": P + 2 * (P + Q) * Q,
    "pi": P + sympy.pi * Q,
    "a long number": P + 10**18 * Q,
    "a large power": P + Q**65,
    "two numbers": sympy.Add(P, sympy.Mul(6, -1, Q, evaluate=False), evaluate=False),
    "no sum": P * Q,
}


@pytest.mark.parametrize("what", OTHERS)
def test_what_is_no_plain_sum_of_monomials_is_read_again(what: str) -> None:
    assert not reads_back(OTHERS[what], MAX_LENGTH)


def test_a_polynomial_beyond_the_longest_text_is_refused_as_before() -> None:
    """Its text is longer than the formula was, and is not read."""
    powers = [(i, j) for i in range(10, 40) for j in range(10, 24)]
    short = "+".join(f"p^{i}*q^{j}" for i, j in powers)[:MAX_LENGTH].rpartition("+")[0]
    assert not reads_back(parse(short), MAX_LENGTH)
    with pytest.raises(InputError, match="written out"):
        Hamiltonian.parse(short)


def test_a_polynomial_hamiltonian_is_read_once(monkeypatch: pytest.MonkeyPatch) -> None:
    hamiltonian._parse_formula.cache_clear()
    monkeypatch.setattr(hamiltonian, "parse", None)
    found = Hamiltonian.parse("p**2/2 + 123*q**4/456 - p*q")
    monkeypatch.undo()
    assert found.expression == formula.parse(found.formula)
