"""The modified Hamiltonian for every H: known terms, two ways that share no code, one H."""

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.formulas import P, Q
from verify import schemes
from verify.algebra.jets import Jets
from verify.algebra.symbols import H_STEP
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.plane import modified_terms
from verify.proof.plane.modified_for_every_h import (
    Logarithm,
    modified_for_every_h,
    terms_of_splitting,
)
from verify.proof.plane.modified_for_one_h import modified_for_one_h
from verify.proof.plane.modified_terms import field_of, modified_field
from verify.schemes.conditions.splitting_conditions import Splitting
from verify.verdict import Verdict

# Hairer, Lubich, Wanner, IX.3 and IX.4, in our signs: by the exponentials, worked out by hand
KNOWN = {
    "symplectic-euler": {1: "-1/2*H_p*H_q", 2: "1/12*H_q**2*H_pp + 1/12*H_p**2*H_qq"},
    "stormer-verlet": {1: "0", 2: "-1/24*H_q**2*H_pp + 1/12*H_p**2*H_qq", 3: "0"},
    "position-verlet": {1: "0", 2: "1/12*H_q**2*H_pp - 1/24*H_p**2*H_qq", 3: "0"},
    "implicit-midpoint": {
        1: "0",
        2: "-1/24*H_q**2*H_pp + 1/12*H_p*H_q*H_pq - 1/24*H_p**2*H_qq",
        3: "0",
    },
    "implicit-symplectic-euler": {1: "-1/2*H_p*H_q"},
    "gauss4": {1: "0", 2: "0", 3: "0"},
}


@pytest.mark.parametrize("name", KNOWN)
def test_known_terms(name: str) -> None:
    result = modified_for_every_h(name, 4)
    assert (result.verdict, result.reach, result.area) == (Verdict.PROVED, 4, True)
    assert {n: result.terms[n].hamiltonian for n in KNOWN[name]} == KNOWN[name]


parts = st.lists(
    st.tuples(st.sampled_from(["kick", "drift"]), st.fractions(-2, 2, max_denominator=5)),
    min_size=2,
    max_size=5,
)


@drawn(12)
@given(parts)
def test_the_logarithm_of_the_exponentials_gives_the_same_terms(chosen) -> None:
    sizes = tuple((kind, sympy.Rational(x.numerator, x.denominator)) for kind, x in chosen)
    own = Splitting(sizes)
    jets, logarithm = Jets(7, separable=True), Logarithm(own, 5)
    assert own.stages is not None
    series = own.stages.taylor(jets, 5)
    vectors = modified_field(jets, *series)
    for n in range(2, 6):
        numbers = {m: x.leading_coefficient() for m, x in logarithm.energy(jets, n).items()}
        energy = jets.context.from_dict(numbers)
        assert vectors[n - 1] == field_of(jets, energy)


@pytest.mark.parametrize("name", ["yoshida4", "blanes-moan4", "mclachlan-atela2"])
def test_irrational_coefficients_for_every_h_agree_with_one_h(name: str) -> None:
    hamiltonian = Hamiltonian.parse("p**2/2 + p**3/3 + q**2/2 + q**4/4")
    scheme = schemes.get(name)
    one = modified_for_one_h(scheme.step_map(hamiltonian), scheme, 4)
    every = modified_for_every_h(name, 4)
    put = {
        "H_" + "p" * i + "q" * j: sympy.diff(hamiltonian.exact, P, i, Q, j)
        for i in range(6) for j in range(6) if i + j
    }  # fmt: skip
    at = {P: sympy.Rational(1, 3), Q: sympy.Rational(2, 5)}
    values = {key: x.subs(at) for key, x in put.items()}
    for mine, theirs in zip(one.terms[1:], every.terms[1:], strict=True):
        a = sympy.N(sympy.sympify(mine.hamiltonian, {"p": P, "q": Q}).subs(at), 30)
        b = sympy.N(sympy.sympify(theirs.hamiltonian, values), 30)
        start = sympy.sympify(mine.hamiltonian, {"p": P, "q": Q}).subs({P: 0, Q: 0})
        assert abs(a - b - start) < 1e-25
        assert theirs.is_hamiltonian


@pytest.mark.parametrize("name", ["lie1", "lie2", "lie3", "explicit-midpoint", "rk4"])
@pytest.mark.parametrize("separable", [False, True])
def test_the_first_divergence_is_the_leading_coefficient_of_delta_j(
    name: str, separable: bool
) -> None:
    result = modified_for_every_h(name, 5, separable)
    first = result.first_not_hamiltonian
    assert first is not None
    assert (result.verdict, result.area, first.power) == (
        Verdict.PROVED,
        True,
        schemes.get(name).order,
    )
    assert (result.reach, result.text) == (first.power - 1, "H")


def test_a_planted_term_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    own = modified_terms.modified_field

    def planted(jets, *series):
        terms = own(jets, *series)
        terms[2] = terms[2][0] + jets.h(0, 1) * jets.h(2, 0) ** 2 * jets.h(0, 2), terms[2][1]
        return terms

    monkeypatch.setattr(modified_terms, "modified_field", planted)
    for name in ("stormer-verlet", "lie2"):
        result = modified_for_every_h(name, 2)
        assert (result.area, result.verdict) == (False, Verdict.UNDECIDED)


def test_a_splitting_that_is_no_scheme_has_its_own_first_term() -> None:
    result = modified_for_every_h("kick 1/3; drift 1; kick 1/3; order 1", 2)
    assert result.verdict is Verdict.REFUTED
    first = terms_of_splitting(Splitting((("kick", sympy.sqrt(2)), ("drift", sympy.S.One))), 1)[0]
    assert (first.hamiltonian, first.p, first.q) == ("T + (sqrt(2))*V", "(-sqrt(2))*H_q", "H_p")


def test_a_scheme_of_one_h_is_refused() -> None:
    with pytest.raises(InputError, match="given for one H"):
        modified_for_every_h("p_next = p - h*q; q_next = q + h*p", 2)


def test_the_text_is_a_formula() -> None:
    text = modified_for_every_h("symplectic-euler", 1).text
    assert text == "H + h*(-1/2*H_p*H_q)"
    assert Jets(1).text(Jets(1).h(1, 0)) == "H_p"
    assert H_STEP in sympy.sympify(text, {"h": H_STEP}).free_symbols
