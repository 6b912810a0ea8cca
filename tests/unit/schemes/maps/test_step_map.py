"""Step maps: ΔJ against det J − 1 by other means, compositions, and users' own maps."""

from dataclasses import replace
from fractions import Fraction

import mpmath
import pytest
import sympy

from tests.helpers.maps import by_expressions, by_formulas
from tests.helpers.sampled.formulas import (
    H,
    P,
    Q,
    close,
    evaluate,
    is_real,
    lie_step,
    outcome,
    plain,
    plain_delta_j,
)
from tests.helpers.sampled.identities.drawn import HIDDEN
from verify import schemes
from verify.algebra.expressions.formula_text import to_text
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_one_h import prove
from verify.proof.proof_for_one_h import Proof
from verify.schemes.maps.step_map import StepMap
from verify.schemes.steps.defect import DefectSeries
from verify.verdict import Verdict

HARMONIC = Hamiltonian.parse("p**2/2 + q**2/2")
PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
POINT = {"p": Fraction(3, 7), "q": Fraction(5, 11), "h": Fraction(1, 9), "a": Fraction(2, 3)}


def determinant(step_map: StepMap) -> sympy.Expr:
    """Of the four entries; sympy's own `det` takes minutes to simplify some of them."""
    j = step_map.jacobian
    return j[0, 0] * j[1, 1] - j[0, 1] * j[1, 0]


def own(p_next: str, q_next: str, hamiltonian: Hamiltonian = HARMONIC) -> StepMap:
    return by_formulas(hamiltonian, p_next, q_next)


def proof_of(p_next: str, q_next: str, hamiltonian: Hamiltonian = HARMONIC) -> Proof:
    return prove(own(p_next, q_next, hamiltonian))


# -- ΔJ ---------------------------------------------------------------------------------------

POLYNOMIAL = [
    "p**2/2 + q**2/2 + delta*q**4/4",
    "p**2*q**3/3 - a*p*q + q",
    "(p**2 + q**2)**2/4",
    "p**3 - 3*p*q**2",
]


@pytest.mark.left_to_ci
@pytest.mark.parametrize("eta", [1, 2, 3, 4])
@pytest.mark.parametrize("text", POLYNOMIAL)
def test_delta_j_is_exactly_the_determinant_minus_one(text: str, eta: int) -> None:
    step_map = schemes.get(f"lie{eta}").step_map(Hamiltonian.parse(text))
    expected = plain_delta_j(*lie_step(plain(text), eta))
    assert sympy.expand(step_map.delta_j - expected) == 0
    assert sympy.expand(determinant(step_map) - 1 - expected) == 0


SMOOTH = [
    "p**2/2 - cos(q)",
    "exp(p) + exp(-a*q)",
    "sin(p*q + 1)",
    "sqrt(1 + p**2) + q**2/2",
    "p**2/(2*(1 + q**2))",
    "tan(p*q)",
    "tanh(q)*p + atan(p)",
    "p*log(q)",
    "p**2/2 + cos(q + pi/3)",
    "p*(1 + q**2)**(1/3)",
    "p/sqrt(q)",
]


@pytest.mark.left_to_ci
@pytest.mark.sample(18)
@pytest.mark.parametrize("eta", [1, 2, 3])
@pytest.mark.parametrize("text", SMOOTH)
def test_delta_j_is_the_determinant_minus_one_to_40_digits(text: str, eta: int) -> None:
    step_map = schemes.get(f"lie{eta}").step_map(Hamiltonian.parse(text))
    expected = evaluate(plain_delta_j(*lie_step(plain(text), eta)), POINT, 80)
    for ours in (step_map.delta_j, determinant(step_map) - 1):
        value = evaluate(ours, POINT, 80)
        with mpmath.workdps(80):
            assert is_real(expected)
            assert close(value, expected, 40)


def test_the_jacobian_is_eq_20_on_duffing() -> None:
    duffing = Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4")
    diagonal = plain("1 - h**2/2 - 3/2*h**2*delta*q**2")
    corner = plain("-h - 3*h*delta*q**2 - 3*h**2*delta*q*p")
    expected = sympy.Matrix([[diagonal, corner], [H, diagonal]])
    assert (schemes.get("lie2").step_map(duffing).jacobian - expected).expand() == sympy.zeros(2)


def test_a_parameter_value_goes_into_the_map() -> None:
    half = Hamiltonian.parse("p**2/2 + a*q**2/2", {"a": "1/2"})
    step_map = schemes.get("lie1").step_map(half)
    assert step_map.delta_j == H**2 / 2


# -- compositions -----------------------------------------------------------------------------


def test_a_composition_applies_its_parts_in_their_order() -> None:
    euler = schemes.get("symplectic-euler").step_map(PENDULUM)
    other = schemes.get("drift 1; kick 1").step_map(PENDULUM)
    kicked = P - H * sympy.sin(Q)
    assert sympy.expand(euler.p_next - kicked) == 0
    assert sympy.expand(euler.q_next - Q - H * kicked) == 0
    assert sympy.expand(other.q_next - Q - H * P) == 0
    assert sympy.expand(other.p_next - P + H * sympy.sin(Q + H * P)) == 0


def twice(step_map: StepMap) -> StepMap:
    put = {P: step_map.p_next, Q: step_map.q_next}
    pair = [x.xreplace(put) for x in (step_map.p_next, step_map.q_next)]
    return by_expressions(step_map.hamiltonian, *pair)


def test_a_composition_has_the_product_of_the_determinants() -> None:
    lie = schemes.get("lie1").step_map(Hamiltonian.parse("p**3/3 + p*q**2"))
    first = {P: lie.p_next, Q: lie.q_next}
    expected = (1 + lie.delta_j) * (1 + lie.delta_j).xreplace(first) - 1
    assert sympy.expand(twice(lie).delta_j - expected) == 0


def test_a_composition_of_shears_preserves_area_and_of_one_other_does_not() -> None:
    euler = schemes.get("symplectic-euler").step_map(PENDULUM)
    assert twice(euler).delta_j == 0
    assert twice(schemes.get("lie1").step_map(PENDULUM)).delta_j != 0


@pytest.mark.parametrize("scheme", ["rk4", "explicit-midpoint"])
def test_stages_preserve_area_where_h_is_one_of_p_alone_or_a_shear(scheme: str) -> None:
    made = schemes.get(scheme)
    for text in ("p**4/4 + sin(p)", "q**3", "(p + 2*q)**3", "cos(p - q)"):
        assert made.step_map(Hamiltonian.parse(text)).preserves_area, text
    for text in ("p**2/2 + q**2/2", "p*q", "p**2/2 - cos(q)"):
        assert not made.step_map(Hamiltonian.parse(text)).preserves_area, text


def test_two_losses_that_cancel_are_seen_to_preserve_area() -> None:
    assert prove(own("2*p", "q/2")).area_preserving is True
    assert prove(own("2*p", "q/3")).area_preserving is False


# -- maps from formulas -----------------------------------------------------------------------


def test_p_next_in_q_next_stands_for_the_new_p() -> None:
    ours = own("p - h*sin(q)", "q + h*p_next", PENDULUM)
    spelled = own("p - h*sin(q)", "q + h*(p - h*sin(q))", PENDULUM)
    assert sympy.expand(ours.q_next - spelled.q_next) == 0
    assert prove(ours).area_preserving is prove(spelled).area_preserving is True


def test_p_next_may_not_also_be_a_parameter() -> None:
    with pytest.raises(InputError, match="p_next"):
        own("p - h*p_next*q", "q + h*p_next", Hamiltonian.parse("p**2/2 + p_next*q**2/2"))


def test_parameters_of_h_have_their_values_in_the_map_too() -> None:
    hamiltonian = Hamiltonian.parse("p**2/2 + a*q**2/2", {"a": "0.1"})
    ours = own("p - h*a*q", "q + h*p", hamiltonian)
    assert ours.p_next == P - H * Q / 10
    assert prove(ours).convergence_order == 1


UNREADABLE = {
    "unknown name": ("p - h*x", "q", "p_next="),
    "unknown name in q_next": ("p", "q + dt*p", "q_next="),
    "p_next in itself": ("p_next", "q", "p_next="),
    "q_next in itself": ("p", "q_next", "q_next="),
    "not smooth": ("p - h*abs(q)", "q", "not smooth"),
    "hidden modulus": ("q**2", "q + h*sqrt(p_next)", ""),
    "division by zero": ("p - h/(q - q)", "q", "zero"),
    "division by a zero p_next": ("0", "q/p_next", ""),
    "logarithm of a negative p_next": ("-1", "q + log(p_next)", ""),
    "empty": ("", "q", "empty"),
    "not a formula": ("p", "q +", "not a formula"),
    "code": ("p", "__import__('os')", "unknown function"),
}


@pytest.mark.parametrize(
    ("p_next", "q_next", "fragment"), UNREADABLE.values(), ids=UNREADABLE.keys()
)
def test_a_map_that_cannot_be_read_is_refused(p_next: str, q_next: str, fragment: str) -> None:
    with pytest.raises(InputError) as info:
        own(p_next, q_next)
    assert fragment in str(info.value)
    assert str(info.value).isprintable()


SINGULAR = {
    "pole": "p + 1/h",
    "pole times q": "p - h*q + q/h",
    "logarithm": "p + log(h)",
    "essential singularity": "p - h*q + exp(-1/h)",
    "flat essential singularity": "p - h*q + exp(-1/h**2)",
    "square root": "p - q*sqrt(h)",
    "oscillation": "p - h*q*sin(1/h)",
    "jump": "p - h*q*atan(1/h)",
    "tanh jump": "p - h*q*tanh(1/h)",
}


@pytest.mark.parametrize("p_next", SINGULAR.values(), ids=SINGULAR.keys())
def test_a_map_singular_at_step_zero_is_refused(p_next: str) -> None:
    with pytest.raises(InputError) as info:
        prove(own(p_next, "q + h*p"))
    assert "smooth" in str(info.value)


# -- what is proved of users' maps ------------------------------------------------------------


def test_the_exact_rotation_preserves_area_and_agrees_with_the_flow() -> None:
    proof = proof_of("p*cos(h) - q*sin(h)", "q*cos(h) + p*sin(h)")
    assert (proof.verdict, proof.area_preserving) == (Verdict.PROVED, True)
    assert proof.convergence_order is None
    assert proof.delta_j == 0


def test_the_exact_rotation_the_wrong_way_round_is_refuted() -> None:
    proof = proof_of("p*cos(h) + q*sin(h)", "q*cos(h) - p*sin(h)")
    assert (proof.verdict, proof.area_preserving) == (Verdict.REFUTED, True)
    assert proof.convergence_order == 0


RATIONAL = "({}*(1 - h**2/4) {} h*{})/(1 + h**2/4)"


def test_the_implicit_midpoint_rule_of_the_oscillator_is_proved_of_order_two() -> None:
    proof = proof_of(RATIONAL.format("p", "-", "q"), RATIONAL.format("q", "+", "p"))
    assert (proof.verdict, proof.area_preserving) == (Verdict.PROVED, True)
    assert proof.convergence_order == 2


OWN = {
    "explicit Euler": ("p - h*q", "q + h*p", Verdict.PROVED, 2, "1", 1),
    "frozen": ("p", "q", Verdict.REFUTED, None, "0", 0),
    "half a step": ("p - h*q/2", "q + h*p/2", Verdict.REFUTED, 2, "1/4", 0),
    "shrinking": ("p*exp(-h)", "q", Verdict.REFUTED, 1, "-1", 0),
    "identity off at step zero": ("2*p", "q", Verdict.REFUTED, 0, "1", -1),
    "swap": ("q", "p", Verdict.REFUTED, 0, "-2", -1),
    "tangent shears": ("p - q*tan(h)", "q + p_next*tan(h)", Verdict.PROVED, None, "0", 1),
    "denominator": ("(p - h*q)/(1 + h**2)", "q + h*p_next", Verdict.PROVED, 2, "-1", 1),
    "loss of high order": ("p - h*q", "q + h*p_next + h**7*q", Verdict.PROVED, 7, "1", 1),
    "flat in h beyond order one": ("p - q*sin(h)", "q + p*sin(h)", Verdict.PROVED, 2, "1", 1),
}


@pytest.mark.parametrize(
    ("p_next", "q_next", "verdict", "order", "leading", "convergence"), OWN.values(), ids=OWN.keys()
)
def test_the_proof_of_a_users_map_is_the_one_by_hand(
    p_next: str, q_next: str, verdict: Verdict, order: int | None, leading: str, convergence: int
) -> None:
    proof = proof_of(p_next, q_next)
    assert (proof.verdict, proof.order, proof.convergence_order) == (verdict, order, convergence)
    assert sympy.simplify(proof.leading - plain(leading)) == 0


def test_a_loss_that_cannot_be_decided_is_undecided_and_not_proved() -> None:
    hidden = f"(1 + h**3*({HIDDEN}))"
    proof = proof_of(f"(p - h*q)*{hidden}", "q + h*p_next")
    assert (proof.verdict, proof.area_preserving) == (Verdict.UNDECIDED, None)
    assert (proof.order, proof.convergence_order) == (None, 1)


def test_an_error_that_hides_beyond_every_looked_at_order_is_not_proved_away() -> None:
    proof = proof_of("p*cos(h) - q*sin(h)", "q*cos(h) + p*sin(h) + h**40*q")
    assert proof.area_preserving is not True
    assert proof.order in (None, 40)


@pytest.mark.parametrize("eta", [20, 100])
def test_a_high_order_on_the_oscillator_is_proved_in_bounded_time(eta: int) -> None:
    def work() -> None:
        scheme = schemes.get(f"lie{eta}")
        assert prove(scheme.step_map(HARMONIC), scheme).order == eta + 2

    assert outcome(work) == "done"


@pytest.mark.parametrize(
    "text",
    ["atan(p + q + cos(q))*(atan(q) - tan(p))/atan(q)", "atan(p**4*(p + q)*atan(p)/atan(q))"],
)
def test_the_proof_for_an_involved_hamiltonian_ends(text: str) -> None:
    def work() -> None:
        scheme = schemes.get("lie2")
        assert prove(scheme.step_map(Hamiltonian.parse(text)), scheme).convergence_order == 2

    assert outcome(work) in ("done", "InputError", "LimitError")


# -- what a field has made of the flow --------------------------------------------------------


@pytest.mark.parametrize("text", [*POLYNOMIAL, "p**2/2 - cos(q)", "exp(p) + exp(-a*q)"])
def test_the_flows_own_terms_are_seen_and_only_these(text: str) -> None:
    for eta in (1, 2, 3, 4):
        step = schemes.get(f"lie{eta}").step_map(Hamiltonian.parse(text)).flat
        assert step.flow_up_to == eta
        h, p = step.ring.variable("h"), step.ring.variable("p")
        for n in range(eta + 1):
            slip = h**n * p / 10**20
            assert (
                replace(step, elements=(step.elements[0] + slip, step.elements[1])).flow_up_to < n
            )
        known = step.field, step.series(2 * eta)
        series = DefectSeries(lambda _, known=known: known, 2 * eta)
        # The flow is symplectic, so that these are left out.
        assert not any(series.form(n).entries for n in range(eta + 1))


@pytest.mark.parametrize("eta", [1, 2, 3, 4])
def test_an_error_planted_in_a_lie_map_is_refuted_whatever_its_field_has_made(eta: int) -> None:
    scheme, h = schemes.get(f"lie{eta}"), Hamiltonian.parse("p**2/2 + q**4/4")
    right = scheme.step_map(h)
    assert prove(right, scheme).verdict is Verdict.PROVED
    p, q = right.formulas
    slip = right.ring.variable("h") ** eta * right.ring.variable("p") / 10**20
    less = (
        schemes.get(f"lie{eta - 1}").step_map(h).formulas[0]
        if eta > 1
        else right.ring.variable("p")
    )
    for wrong in ((p + slip, q), (p, q - slip), (less, q)):
        proof = prove(replace(right, formulas=wrong), scheme)
        assert (proof.verdict, proof.convergence_order) == (Verdict.REFUTED, eta - 1)


def test_delta_j_of_two_degrees_is_the_determinants_however_many_terms_it_has(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("verify.schemes.maps.step_map._MOST_FACTORED_TERMS", -1)
    text = "p1**2/2 + p2**2/2 + q1**4/4 + q1**2*q2 + q2**2/2"
    step_map = schemes.get("lie2").step_map(Hamiltonian.parse(text))
    assert step_map.delta_j_text == to_text(step_map.delta_j) != "0"
