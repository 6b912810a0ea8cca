"""The modified Hamiltonian of one H: exact terms, the energy that is kept, and planted errors."""

import mpmath
import pytest
import sympy

from tests.helpers.sampled.formulas import P, Q
from verify import schemes
from verify.algebra.symbols import H_STEP
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.plane import modified_for_one_h as module
from verify.proof.plane import modified_terms
from verify.proof.plane.modified_equation import ModifiedEquation, Term, judge_equation
from verify.proof.plane.modified_for_one_h import modified_for_one_h
from verify.proof.plane.modified_terms import Vector
from verify.schemes.maps.parts import parts_of
from verify.schemes.maps.step_map import StepMap
from verify.verdict import Verdict

DUFFING, PENDULUM = "p**2/2 + q**2/2 + q**4/4", "p**2/2 - cos(q)"
MIXED = "p**2/2 + q**2/2 + p*q**2 + q**3/3"
TRUE_FIELD = modified_terms.modified_field


def found(text: str, name: str, order: int = 4) -> ModifiedEquation:
    scheme = schemes.get(name)
    return modified_for_one_h(scheme.step_map(Hamiltonian.parse(text)), scheme, order)


def bracket(f: sympy.Expr, g: sympy.Expr) -> sympy.Expr:
    return f.diff(P) * g.diff(Q) - f.diff(Q) * g.diff(P)


@pytest.mark.parametrize("text", [DUFFING, PENDULUM, "p**4/4 + p**3 + exp(q)"])
def test_the_terms_are_those_of_baker_campbell_and_hausdorff(text: str) -> None:
    exact = Hamiltonian.parse(text).exact
    v = exact.subs(P, 0)
    t = sympy.expand(exact - v)
    v, t = v - v.subs(Q, 0), t + v.subs(Q, 0)
    inner = bracket(v, t)
    # log(e^X e^Y) and log(e^(X/2) e^Y e^(X/2)), X of V and Y of T: kicks first
    euler = (
        exact
        + H_STEP / 2 * inner
        + H_STEP**2 / 12 * (bracket(v, inner) - bracket(t, inner))
        - H_STEP**3 / 24 * bracket(t, bracket(v, inner))
    )
    verlet = exact + H_STEP**2 * (-bracket(v, inner) / 24 - bracket(t, inner) / 12)
    for name, known, order in (("symplectic-euler", euler, 3), ("stormer-verlet", verlet, 3)):
        gap = sympy.expand(found(text, name, order).expression - known)
        assert sympy.simplify(gap.diff(P)) == sympy.simplify(gap.diff(Q)) == 0


KEEPING = ["stormer-verlet", "symplectic-euler", "ruth3", "position-verlet", "yoshida4"]


def stepped(step_map: StepMap, p: mpmath.mpf, q: mpmath.mpf, h: mpmath.mpf) -> list[mpmath.mpf]:
    """One step, part by part."""
    parts = parts_of(step_map) or ()
    for after in [list(map(x.ring.expression, x.elements)) for x in parts] or [step_map.composed]:
        p, q = sympy.lambdify((P, Q, H_STEP), after, "mpmath")(p, q, h)
    return [p, q]


def drift(energy: sympy.Expr, step_map: StepMap, h: mpmath.mpf) -> mpmath.mpf:
    """|H̃(z') − H̃(z)| at a point."""
    z = mpmath.mpf("0.6"), mpmath.mpf("0.7"), h
    kept = sympy.lambdify((P, Q, H_STEP), energy, "mpmath")
    return abs(kept(*stepped(step_map, *z), h) - kept(*z))


def gained(energy: sympy.Expr, step_map: StepMap) -> float:
    """By what power of h a step changes it."""
    with mpmath.workdps(60):
        whole, half = (drift(energy, step_map, mpmath.mpf(1) / n) for n in (400, 800))
        return float(mpmath.log(whole / half, 2))


@pytest.mark.parametrize("name", KEEPING)
def test_a_step_keeps_the_modified_hamiltonian_to_the_next_order(name: str) -> None:
    result = found(DUFFING, name)
    step_map = schemes.get(name).step_map(Hamiltonian.parse(DUFFING))
    next_power = 5 if schemes.get(name).symmetric else 4
    assert result.reach == 4
    assert gained(result.expression, step_map) == pytest.approx(next_power + 2, abs=0.2)
    # A term that is wrong is seen.
    wrong = result.expression + H_STEP**4 * Q**4 / 10
    assert gained(wrong, step_map) == pytest.approx(5, abs=0.2)


@pytest.mark.sample(4)
@pytest.mark.parametrize(
    ("text", "name", "order"),
    [
        (DUFFING, "lie2", 3),
        (PENDULUM, "rk4", 5),
        (MIXED, "explicit-midpoint", 3),
        (MIXED, "lie1", 2),
    ],
)
@pytest.mark.parametrize("planted", [False, True])
def test_the_map_is_the_flow_of_the_field(text: str, name: str, order: int, planted: bool) -> None:
    result = found(text, name, order)
    step_map = schemes.get(name).step_map(Hamiltonian.parse(text))
    names = {"p": P, "q": Q}
    vector = [
        sum(H_STEP**t.power * sympy.sympify(getattr(t, part), names) for t in result.terms)
        for part in ("p", "q")
    ]
    if planted:
        vector[0] += H_STEP**order * Q
    right = sympy.lambdify((P, Q, H_STEP), vector, "mpmath")
    errors = []
    with mpmath.workdps(30):
        z = [mpmath.mpf("0.6"), mpmath.mpf("0.7")]
        for h in (mpmath.mpf(1) / 200, mpmath.mpf(1) / 400):
            there = mpmath.odefun(lambda _, y, h=h: right(*y, h), 0, z, tol=mpmath.mpf(10) ** -25)(
                h
            )
            errors.append(
                max(abs(a - b) for a, b in zip(stepped(step_map, *z, h), there, strict=True))
            )
        gain = mpmath.log(errors[0] / errors[1], 2)
    assert gain == pytest.approx(order + 1 if planted else order + 2, abs=0.25)


OTHERS = [s for s in schemes.names() if not schemes.get(s).area_preserving]


@pytest.mark.sample(7)
@pytest.mark.parametrize("name", OTHERS)
@pytest.mark.parametrize("text", [DUFFING, PENDULUM])
def test_what_is_not_symplectic_has_no_modified_hamiltonian_further(text: str, name: str) -> None:
    result = found(text, name, 6)
    first = result.first_not_hamiltonian
    if first is None:  # lie6, of order 6
        assert schemes.get(name).order >= 6
        return
    assert result.verdict is Verdict.PROVED
    assert result.area is True
    # Of some H one term more is Hamiltonian than for every H: that of h⁴ of rk4, of these two.
    assert first.power == schemes.get(name).order + (name == "rk4")
    assert (first.hamiltonian, result.reach) == (None, first.power - 1)
    assert sympy.degree(result.expression, H_STEP) < first.power
    assert first.witness


def test_a_wrong_term_is_seen_by_the_leading_term_of_delta_j(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert found(DUFFING, "lie2").area is True

    def planted(ring, *series) -> list[Vector]:
        p = ring.variable("p")
        return [(a + p * (k == 2), b) for k, (a, b) in enumerate(TRUE_FIELD(ring, *series))]

    monkeypatch.setattr(modified_terms, "modified_field", planted)
    for name in ("lie2", "stormer-verlet", "lie1"):
        result = found(DUFFING, name)
        assert result.area is (name == "lie1"), "of lie1 an earlier term decides"
        assert (result.verdict is Verdict.UNDECIDED) == (name != "lie1")


def test_a_wrong_hamiltonian_is_not_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    right = found(DUFFING, "stormer-verlet").text
    way = module._by_integration

    def wrong(field, vector, factors):
        own = way(field, vector, factors)
        return own + field.ring.variable("q")

    monkeypatch.setattr(module, "_by_integration", wrong)
    assert found(DUFFING, "stormer-verlet").text == right, "found in another way"
    monkeypatch.setattr(module, "_among_products", wrong)
    monkeypatch.setattr(module, "_among_all", wrong)
    result = found(DUFFING, "stormer-verlet")
    assert (result.reach, result.terms[2].hamiltonian, result.text) == (-1, None, "0")
    assert result.terms[2].is_hamiltonian is True, "its divergence is 0 all the same"
    assert "no function is found" in str(result.reason)


def test_what_a_scheme_claims_is_held_against_the_terms() -> None:
    result = found(PENDULUM, "kick 1/6; drift 1/2; kick 2/3; drift 1/2; kick 1/6; order 3")
    assert (result.verdict, result.reach) == (Verdict.REFUTED, 4)
    assert "claims order 3; the term of h^2 is not 0" in str(result.reason)
    result = found(PENDULUM, "p_next = p - 2*h*sin(q); q_next = q + h*p")
    assert (result.verdict, result.terms[0].hamiltonian) == (Verdict.REFUTED, "p**2/2 - 2*cos(q)")
    with pytest.raises(InputError, match=r"not \(p, q\) at h = 0"):
        found(PENDULUM, "p_next = 2*p; q_next = q + h*p")


def test_a_map_that_is_no_polynomial_in_h() -> None:
    euler = "p_next = p - h*q/(1 + h**2); q_next = q + h*p_next"
    result = found("p**2/2 + q**2/2", euler, 3)
    assert (result.verdict, result.reach, result.area) == (Verdict.PROVED, 3, True)
    result = found("p**2/2 + q**2/2", "p_next = (p - h*q)/(1 + h**3); q_next = q + h*p_next", 3)
    assert result.first_not_hamiltonian is not None
    assert (result.first_not_hamiltonian.power, result.area) == (2, True)


def test_the_divergence_holds_for_the_parameters_that_are_told() -> None:
    result = found("p**2/2 + q**2/2 + delta*q**4/4", "lie2")
    assert result.domain.texts == ("delta != 0",)
    assert found("p**2/2 + q**2/2 + delta*q**4/4", "stormer-verlet").domain.texts == ()


def test_what_is_not_decided_is_said() -> None:
    result = found(DUFFING, "stormer-verlet")
    open_term = Term(1, "p", "q", None, None, None, "p", divergence_element=None)
    terms = (result.terms[0], open_term, *result.terms[2:])
    left = judge_equation(ModifiedEquation("s", DUFFING, 4, terms, True, None, result.where), None)
    assert (left.verdict, left.reach) == (Verdict.UNDECIDED, 0)
    assert "not decided" in str(left.reason)
    judged_as = schemes.get("stormer-verlet")
    assert judge_equation(left, judged_as).verdict is Verdict.UNDECIDED, (
        "whether its order is missed"
    )
