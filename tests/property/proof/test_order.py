"""Proofs over drawn Hamiltonians and maps: what always holds, and that no error is proved away."""

from dataclasses import dataclass, replace
from fractions import Fraction

import flint
import mpmath
import pytest
import sympy
from hypothesis import assume, example, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.maps import by_formulas
from tests.helpers.sampled.formulas import (
    H,
    P,
    Q,
    close,
    evaluate,
    is_real,
    lie_step,
    plain,
    plain_delta_j,
    points,
    polynomials,
    rationals,
    trigonometric,
)
from verify import schemes
from verify.algebra.expressions.formula_text import to_text
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_one_h import prove
from verify.proof.proof_for_one_h import Proof
from verify.schemes.maps.step_map import StepMap
from verify.verdict import Verdict

hamiltonians = polynomials() | trigonometric()
orders = st.integers(1, 4)
quick = drawn(30)


def proof_of(text: str, name: str) -> Proof:
    scheme = schemes.get(name)
    return prove(scheme.step_map(Hamiltonian.parse(text)), scheme)


# -- the Lie-derivative scheme ----------------------------------------------------------------


@quick
@given(hamiltonians, orders)
@example("p**2/2 + q**2/2", 4)
def test_lie_has_its_order_and_a_delta_j_of_one_more(text: str, eta: int) -> None:
    proof = proof_of(text, f"lie{eta}")
    assert proof.verdict is Verdict.PROVED
    assert proof.convergence_order is None or proof.convergence_order >= eta
    if proof.area_preserving:
        assert (proof.order, proof.leading) == (None, 0)
    else:
        assert proof.order is not None
        assert proof.order >= eta + 1


@quick
@given(polynomials(most_terms=3), orders)
def test_the_closed_form_is_exactly_det_j_minus_one(text: str, eta: int) -> None:
    proof = proof_of(text, f"lie{eta}")
    expected = sympy.expand(plain_delta_j(*lie_step(plain(text), eta)))
    assert sympy.expand(proof.delta_j - expected) == 0
    lowest = min((int(m[0]) for m in sympy.Poly(expected, H).monoms()), default=0)
    if expected == 0:
        assert proof.area_preserving is True
    else:
        assert proof.order == lowest
        assert sympy.expand(proof.leading - expected.coeff(H, lowest)) == 0


@quick
@given(trigonometric(most_terms=1), st.integers(1, 3), points("p", "q", "h"))
def test_the_closed_form_is_det_j_minus_one_to_40_digits(
    text: str, eta: int, point: dict[str, Fraction]
) -> None:
    ours = evaluate(proof_of(text, f"lie{eta}").delta_j, point, 100)
    expected = evaluate(plain_delta_j(*lie_step(plain(text), eta)), point, 100)
    assume(is_real(expected))
    with mpmath.workdps(100):
        assert close(ours, expected, 40)


@pytest.mark.left_to_ci
@quick
@given(trigonometric(most_terms=1), st.integers(1, 3), points("p", "q"))
def test_the_leading_coefficient_is_the_limit_of_delta_j(
    text: str, eta: int, point: dict[str, Fraction]
) -> None:
    proof = proof_of(text, f"lie{eta}")
    assume(proof.order is not None)
    h = Fraction(1, 10**30)
    delta_j = plain_delta_j(*lie_step(plain(text), eta))
    with mpmath.workdps(300):
        ratio = evaluate(delta_j, {**point, "h": h}, 300) * mpmath.mpf(10) ** (30 * proof.order)
        assert close(ratio, evaluate(proof.leading, point, 300), 12)


@quick
@given(hamiltonians, orders)
def test_a_witness_is_a_point_where_the_leading_coefficient_is_not_zero(
    text: str, eta: int
) -> None:
    proof = proof_of(text, f"lie{eta}")
    assume(proof.order is not None)
    value = evaluate(proof.leading, proof.witness or {"q": Fraction(1)})
    shown = mpmath.mpf(proof.enclosure.strip("[] ").split(" ")[0])
    assert value != 0
    assert abs(value - shown) <= abs(value) / 10**9


@given(hamiltonians)
@drawn(10)
def test_a_proof_leaves_every_global_precision_as_it_was(text: str) -> None:
    before = flint.ctx.prec, mpmath.mp.prec
    proof_of(text, "lie2")
    assert (flint.ctx.prec, mpmath.mp.prec) == before


# -- symplectic Euler -------------------------------------------------------------------------


@quick
@given(
    polynomials("p") | trigonometric("p"),
    polynomials("q") | trigonometric("q"),
    points("p", "q", "h"),
)
def test_symplectic_euler_preserves_area_for_every_separable_hamiltonian(
    kinetic: str, potential: str, point: dict[str, Fraction]
) -> None:
    proof = proof_of(f"{kinetic} + {potential}", "symplectic-euler")
    assert (proof.verdict, proof.area_preserving) == (Verdict.PROVED, True)
    assert proof.delta_j == 0
    p_next = P - H * plain(potential).diff(Q)
    q_next = Q + H * plain(kinetic).diff(P).xreplace({P: p_next})
    ours = evaluate(proof.step_map.p_next, point), evaluate(proof.step_map.q_next, point)
    assert close(ours[0], evaluate(p_next, point), 30)
    assert close(ours[1], evaluate(q_next, point), 30)


@quick
@given(
    polynomials("p"),
    polynomials("q") | trigonometric("q"),
    rationals(),
    st.sampled_from(["p*q", "p**2*q", "p*q**3", "sin(p + q)", "exp(p*q)", "p*cos(q)"]),
)
def test_symplectic_euler_refuses_every_hamiltonian_that_is_not_separable(
    kinetic: str, potential: str, coefficient: Fraction, mixed: str
) -> None:
    hamiltonian = Hamiltonian.parse(f"{kinetic} + {potential} + ({coefficient})*{mixed}")
    with pytest.raises(InputError, match="symplectic-euler"):
        schemes.get("symplectic-euler").step_map(hamiltonian)


# -- planted errors ---------------------------------------------------------------------------


@dataclass(frozen=True)
class Term:
    """`sign` h^`power` · (`factor`) in a map's text."""

    power: int
    factor: str
    sign: int = 1

    def __str__(self) -> str:
        return f"({self.sign})*h**{self.power}*({self.factor})"


Map = tuple[tuple[Term, ...], tuple[Term, ...]]


def lie2_terms(text: str) -> Map:
    """p' and q' of lie2 by plain sympy: their terms in h⁰, h¹ and h², those of h² in two parts."""
    expression = plain(text)
    h_p, h_q = expression.diff(P), expression.diff(Q)

    def terms(start: sympy.Expr, first: sympy.Expr) -> tuple[Term, ...]:
        second = (h_p * first.diff(Q) / 2, -h_q * first.diff(P) / 2)
        parts = [(0, start), (1, first), *((2, part) for part in second)]
        return tuple(Term(n, to_text(part)) for n, part in parts if sympy.expand(part) != 0)

    return terms(P, -h_q), terms(Q, h_p)


def step_map_of(text: str, terms: Map) -> StepMap:
    p_next, q_next = (" + ".join(map(str, side)) for side in terms)
    return by_formulas(Hamiltonian.parse(text), p_next, q_next)


SLIPS = {
    "sign": lambda term: replace(term, sign=-term.sign),
    "coefficient": lambda term: replace(term, factor=f"({term.factor})*(1 + 1/10**20)"),
    "exponent of q": lambda term: replace(term, factor=f"({term.factor})*q"),
    "exponent of p": lambda term: replace(term, factor=f"({term.factor})*p"),
    "exponent of h": lambda term: replace(term, power=term.power + 1),
    "term lost": lambda term: replace(term, factor="0"),
}


@drawn(40)
@given(hamiltonians, st.sampled_from(sorted(SLIPS)), st.data())
def test_a_planted_error_is_found_at_the_very_power_of_h_where_it_was_planted(
    text: str, slip: str, data: st.DataObject
) -> None:
    terms = lie2_terms(text)
    side = data.draw(st.integers(0, 1))
    place = data.draw(st.integers(0, len(terms[side]) - 1))
    term = terms[side][place]
    wrong = [list(part) for part in terms]
    wrong[side][place] = SLIPS[slip](term)
    proof = prove(step_map_of(text, (tuple(wrong[0]), tuple(wrong[1]))), schemes.get("lie2"))
    assert proof.verdict is Verdict.REFUTED
    assert proof.convergence_order == term.power - 1


@drawn(20)
@given(hamiltonians)
def test_without_a_planted_error_the_same_text_is_proved(text: str) -> None:
    proof = prove(step_map_of(text, lie2_terms(text)), schemes.get("lie2"))
    assert proof.verdict is Verdict.PROVED
    same_as(proof, proof_of(text, "lie2"))


@quick
@given(hamiltonians)
def test_the_frozen_map_is_refuted_for_every_hamiltonian_that_is_not_constant(text: str) -> None:
    frozen = by_formulas(Hamiltonian.parse(text), "p", "q")
    proof = prove(frozen)
    assert proof.verdict is Verdict.REFUTED
    assert (proof.area_preserving, proof.convergence_order) == (True, 0)


@quick
@given(rationals())
def test_the_frozen_map_is_exact_for_a_constant_hamiltonian(value: Fraction) -> None:
    frozen = by_formulas(Hamiltonian.parse(f"{value} + 0*p"), "p", "q")
    assert prove(frozen).verdict is Verdict.PROVED


# -- equal maps -------------------------------------------------------------------------------


def same_as(one: Proof, other: Proof) -> None:
    """The same in all that is proved; expressions by their values, not by how they are written."""
    assert one.verdict is other.verdict
    assert (one.order, one.convergence_order) == (other.order, other.convergence_order)
    assert one.area_preserving is other.area_preserving
    point = {"p": Fraction(3, 7), "q": Fraction(-5, 11), "h": Fraction(2, 13)}
    for x, y in ((one.leading, other.leading), (one.delta_j, other.delta_j)):
        assert close(evaluate(x, point), evaluate(y, point), 30)


REWRITTEN = [
    "({}) + q - q",
    "2*({})/2",
    "({0})*(sin(p)**2 + cos(p)**2)",
    "({0})*exp(h)*exp(-h)",
    "1/(1/({}))",
    "(({0})*(1 + q**2) + p)/(1 + q**2) - p/(q**2 + 1)",
]


@drawn(40)
@given(hamiltonians, st.sampled_from(REWRITTEN), st.sampled_from(REWRITTEN))
def test_equal_maps_written_differently_have_equal_proofs(text: str, f: str, g: str) -> None:
    p_next, q_next = (" + ".join(map(str, side)) for side in lie2_terms(text))
    hamiltonian = Hamiltonian.parse(text)
    rewritten = by_formulas(hamiltonian, f.format(p_next), g.format(q_next))
    same_as(prove(by_formulas(hamiltonian, p_next, q_next)), prove(rewritten))
