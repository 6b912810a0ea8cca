"""Implicit schemes on random Hamiltonians: equations, determinants, proofs."""

from fractions import Fraction

import pytest
import sympy
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.formulas import P, Q, plain, polynomials, trigonometric
from tests.helpers.stepping.implicit_steps import (
    RADAU,
    TABLEAUS,
    by_hand,
    places,
    plain_determinant,
    planted,
    steps,
)
from verify import schemes
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_one_h import prove
from verify.schemes.maps.kinds.implicit_runge_kutta import implicit_map
from verify.verdict import Verdict

HAMILTONIANS = st.one_of(polynomials(degree=4, most_terms=3), trigonometric(most_terms=1))
STATES = st.tuples(*(st.builds(Fraction, st.integers(-8, 8), st.just(11)) for _ in "pq"))
STEP = Fraction(1, 400)
DIGITS, MORE = 40, 6


@drawn(15)
@given(text=HAMILTONIANS, z=STATES, name=st.sampled_from(sorted(TABLEAUS)))
def test_a_step_is_that_of_the_equations_solved_by_hand(
    text: str, z: tuple[Fraction, Fraction], name: str
) -> None:
    made = schemes.get(name).step_map(Hamiltonian.parse(text))
    assume(_tame(text, z))
    # A closed form moves by the distance to where the motion rests, which may be far, and loses
    # some digits by that.
    found = steps(made, "mpfr", DIGITS + MORE, z, STEP)
    true = by_hand(text, TABLEAUS[name], z, STEP, DIGITS + MORE)
    assert max(abs(x - y) for x, y in zip(found, true, strict=True)) < Fraction(50, 10**DIGITS)
    gap = abs(plain_determinant(made, "mpfr", DIGITS, z, STEP) - 1)
    assert gap < Fraction(1000, 10**DIGITS)


def _tame(text: str, z: tuple[Fraction, Fraction]) -> bool:
    """Whether fixed-point iteration converges fast."""
    at = dict(zip((P, Q), map(float, z), strict=True))
    second = [plain(text).diff(a, b).subs(at) for a in (P, Q) for b in (P, Q)]
    return all(abs(x) < 60 for x in second)


@drawn(15)
@given(
    text=polynomials(degree=4, most_terms=3), name=st.sampled_from(["implicit-midpoint", "gauss4"])
)
def test_order_and_area_are_proved(text: str, name: str) -> None:
    scheme = schemes.get(name)
    proof = prove(scheme.step_map(Hamiltonian.parse(text)), scheme)
    assert proof.verdict is Verdict.PROVED
    assert proof.area_preserving is True
    assert proof.convergence_order is None or proof.convergence_order >= scheme.order


@drawn(25)
@given(
    text=polynomials(degree=4, most_terms=3),
    at=st.sampled_from(places(TABLEAUS["gauss4"])),
    size=st.integers(6, 30),
)
def test_a_planted_error_is_never_proved_where_the_flow_is_not_trivial(
    text: str, at: tuple[int, int], size: int
) -> None:
    wrong = planted(TABLEAUS["gauss4"], *at, sympy.Rational(1, 10**size))
    proof = prove(implicit_map(Hamiltonian.parse(text), wrong), schemes.get("gauss4"))
    right = prove(implicit_map(Hamiltonian.parse(text), TABLEAUS["gauss4"]), schemes.get("gauss4"))
    # H = p, or p**2: all the methods that are consistent make the exact flow's step.
    assume(right.convergence_order is not None)
    assert proof.verdict is Verdict.REFUTED or proof.convergence_order == right.convergence_order


@pytest.mark.parametrize("text", ["p**2/2 + q**3/3", "p**2*q + q**2"])
def test_a_planted_error_is_refuted(text: str) -> None:
    for at in places(TABLEAUS["gauss4"]):
        wrong = planted(TABLEAUS["gauss4"], *at, sympy.Rational(1, 10**11))
        proof = prove(implicit_map(Hamiltonian.parse(text), wrong), schemes.get("gauss4"))
        assert proof.verdict is Verdict.REFUTED


@drawn(15)
@given(text=polynomials(degree=4, most_terms=3), z=STATES)
def test_a_method_that_loses_area_has_the_determinant_that_its_proof_foretells(
    text: str, z: tuple[Fraction, Fraction]
) -> None:
    """ΔJ of the kernel over the leading term of the proof goes to 1."""
    made = implicit_map(Hamiltonian.parse(text), RADAU)
    proof = prove(made)
    assume(made.implicit and proof.order is not None)
    h = Fraction(1, 10**8)
    put = {sympy.Symbol(n, real=True): sympy.Rational(str(x)) for n, x in zip("pq", z, strict=True)}
    leading = sympy.Rational(proof.leading.subs(put))
    assume(leading != 0)
    found = plain_determinant(made, "mpfr", 120, z, h) - 1
    ratio = found / (Fraction(int(leading.p), int(leading.q)) * h**proof.order)
    assert abs(ratio - 1) < Fraction(1, 1000)
