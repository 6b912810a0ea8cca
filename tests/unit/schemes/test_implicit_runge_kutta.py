"""Implicit schemes for one H: closed forms where there are, equations elsewhere, and proofs."""

from dataclasses import replace
from fractions import Fraction

import mpmath
import pytest
import sympy

from tests.helpers.sampled.formulas import P, Q, plain
from tests.helpers.stepping.implicit_steps import NONLINEAR, RADAU, TABLEAUS, places, planted
from verify import schemes
from verify.errors import InputError
from verify.execution.execute import compute_task
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_one_h import prove
from verify.proof.proof_for_one_h import Proof
from verify.runs.requested_run import run
from verify.schemes.conditions.condition import Condition
from verify.schemes.maps.kinds.implicit_runge_kutta import implicit_map
from verify.schemes.maps.step_map import StepMap
from verify.schemes.scheme import Scheme
from verify.studies.stability.linear_stability import stability_of_map
from verify.studies.stability.scheme_interval import linear_stability
from verify.verdict import Verdict

IMPLICIT = ("implicit-midpoint", "implicit-symplectic-euler", "gauss4", "gauss6")
QUADRATIC = ["p**2/2 + a*p*q + q**2", "p*q", "(p - 2*q)**2 + p"]
each_scheme = pytest.mark.parametrize("name", IMPLICIT)


def proof_of(name: str, text: str) -> Proof:
    scheme = schemes.get(name)
    return prove(scheme.step_map(Hamiltonian.parse(text)), scheme)


# -- closed forms ---------------------------------------------------------------------------------


@pytest.mark.parametrize("text", QUADRATIC)
def test_the_implicit_midpoint_rule_satisfies_its_equation(text: str) -> None:
    step_map = schemes.get("implicit-midpoint").step_map(Hamiltonian.parse(text))
    half = {P: (P + step_map.p_next) / 2, Q: (Q + step_map.q_next) / 2}
    h, expression = plain("h"), plain(text)
    p_gap = step_map.p_next - P + h * expression.diff(Q).xreplace(half)
    q_gap = step_map.q_next - Q - h * expression.diff(P).xreplace(half)
    assert sympy.simplify(p_gap) == sympy.simplify(q_gap) == 0
    assert sympy.simplify(step_map.p_next - P + h * expression.diff(Q)) != 0


@pytest.mark.parametrize("text", ["p**2/2 + 2*q**2", "p*q + q**2/3", "p**2/2 - q**2/2 + p + 3*q"])
@pytest.mark.parametrize("name", [*TABLEAUS, "radau"])
def test_the_closed_form_of_a_quadratic_h_satisfies_the_equations_of_the_stages(
    name: str, text: str
) -> None:
    """With f(z) = M z + c they are linear, and sympy solves them for the slopes at z = (3, 5)."""
    tableau = RADAU if name == "radau" else TABLEAUS[name]
    count, h = tableau.stages, sympy.Rational(1, 7)
    at = {P: sympy.Integer(3), Q: sympy.Integer(5)}
    force = [-plain(text).diff(Q), plain(text).diff(P)]
    slopes = sympy.symbols(f"k:{2 * count}")

    def moved(row: tuple[sympy.Expr, ...]) -> dict[sympy.Symbol, sympy.Expr]:
        return {z: at[z] + h * sum(a * slopes[2 * j + part] for j, a in enumerate(row))
                for part, z in enumerate((P, Q))}  # fmt: skip

    equations = [
        slopes[2 * i + part] - force[part].xreplace(moved(row))
        for i, row in enumerate(tableau.rows)
        for part in (0, 1)
    ]
    solved = sympy.solve(equations, slopes, dict=True)[0]
    true = [x.subs(solved) for x in moved(tableau.weights).values()]
    step_map = implicit_map(Hamiltonian.parse(text), tableau)
    found = [x.subs({**at, plain("h"): h}) for x in (step_map.p_next, step_map.q_next)]
    assert [sympy.simplify(x - y) for x, y in zip(found, true, strict=True)] == [0, 0]


@pytest.mark.parametrize("text", ["p**4/4 + p*sin(q) + q**2", "exp(p) + p*q", "p**2/2 - cos(q)"])
def test_the_implicit_symplectic_euler_satisfies_its_equation(text: str) -> None:
    step_map = schemes.get("implicit-symplectic-euler").step_map(Hamiltonian.parse(text))
    h, expression, put = plain("h"), plain(text), {P: step_map.p_next}
    assert sympy.simplify(step_map.p_next - P + h * expression.diff(Q).xreplace(put)) == 0
    assert sympy.simplify(step_map.q_next - Q - h * expression.diff(P).xreplace(put)) == 0
    proof = prove(step_map, schemes.get("implicit-symplectic-euler"))
    assert (proof.verdict, proof.area_preserving) == (Verdict.PROVED, True)
    assert proof.convergence_order == 1


@pytest.mark.parametrize("text", ["p**2/2 + p*q*t + q**2", "p**2*q**2 + p**2/2 + cos(q*t)"])
def test_the_implicit_symplectic_euler_takes_h_at_the_time_of_the_step(text: str) -> None:
    """One time for both derivatives, so that det J ≡ 1; solved here with mpmath alone."""
    name, exact, t = "implicit-symplectic-euler", Hamiltonian.parse(text), plain("t")
    start, at, size = (Fraction(1, 3), Fraction(-1, 2)), Fraction(3, 7), Fraction(1, 10)
    found = run(exact, name, p=start[0], q=start[1], t0=at, step_size=size, steps=1,
                arithmetic="mpfr", digits=25, observables=("lambda_plain",))  # fmt: skip
    with mpmath.workdps(40):
        p, q, time, h = (mpmath.mpf(x.numerator) / x.denominator for x in (*start, at, size))
        by_p, by_q = (sympy.lambdify((P, Q, t), exact.exact.diff(x), "mpmath") for x in (P, Q))
        p_next = mpmath.findroot(lambda y: y - p + h * by_q(y, q, time), p)
        wanted = {"p": p_next, "q": q + h * by_p(p_next, q, time), "lambda_plain": mpmath.mpf(0)}
        for quantity, true in wanted.items():
            assert abs(mpmath.mpf(found.values[quantity].value) - true) < mpmath.mpf(10) ** -24
    proof = prove(schemes.get(name).step_map(exact), schemes.get(name))
    assert (proof.verdict, proof.area_preserving) == (Verdict.PROVED, True)
    assert proof.convergence_order == 1


def test_an_equation_is_solved_only_where_it_has_to_be() -> None:
    taken = {"implicit-symplectic-euler": ("p**2/2 - cos(q)", "exp(p) + p*q"), "gauss6": QUADRATIC}
    for name, texts in taken.items():
        for text in texts:
            assert not schemes.get(name).step_map(Hamiltonian.parse(text)).implicit
    for name in IMPLICIT:
        assert schemes.get(name).step_map(Hamiltonian.parse("p**2*q**2 + p**3")).implicit


# -- proofs ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text", [*NONLINEAR.values(), "p**2/2 + q**2/2 + delta*q**4/4", "p**2*q**3 + q"]
)
@each_scheme
def test_order_and_area_are_proved_for_one_h(name: str, text: str) -> None:
    proof = proof_of(name, text)
    assert proof.verdict is Verdict.PROVED
    assert proof.convergence_order == schemes.get(name).order
    assert (proof.area_preserving, proof.order) == (True, None)
    assert proof.step_map.delta_j_text == "0"
    if proof.step_map.implicit:
        assert "exactly" in proof.reason


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("error", [sympy.Rational(1, 10**11), -sympy.Rational(1, 10**6)])
@pytest.mark.parametrize("name", TABLEAUS)
def test_an_error_in_any_coefficient_is_refuted_for_one_h(name: str, error: sympy.Rational) -> None:
    scheme, hamiltonian = schemes.get(name), Hamiltonian.parse("p**2/2 + p*q**2 + q**3/3")
    for place in places(TABLEAUS[name]):
        step_map = implicit_map(hamiltonian, planted(TABLEAUS[name], *place, error))
        proof = prove(step_map, scheme)
        assert proof.verdict is Verdict.REFUTED, place
        assert proof.area_preserving is False
        assert proof.step_map.preserves_area is False


def test_a_claim_of_preserved_area_without_its_conditions_is_not_believed() -> None:
    """What a map says of itself counts only with conditions that hold, exactly."""
    right = implicit_map(Hamiltonian.parse("p**2/2 - cos(q)"), TABLEAUS["gauss4"])
    open_ = Condition("a = b", 0, "0", None)
    off = Condition("a = b", 0, "1.0e-30", False)
    for conditions in ((), (*right.conditions, open_), (off, *right.conditions)):
        assert replace(right, conditions=conditions).preserves_area is False
    assert right.preserves_area is True


def test_a_scheme_that_loses_area_has_its_order_of_delta_j() -> None:
    scheme = Scheme("radau", 3, False, False, False, "this test", lambda h: implicit_map(h, RADAU))
    proof = prove(scheme.step_map(Hamiltonian.parse("p**2/2 - cos(q)")), scheme)
    assert (proof.verdict, proof.order, proof.convergence_order) == (Verdict.PROVED, 4, 3)
    assert proof.delta_j is None


# -- what has no closed form ----------------------------------------------------------------------


@pytest.mark.parametrize("what", ["flat", "p_next", "q_next", "composed", "jacobian"])
def test_what_needs_a_closed_form_is_refused_in_one_line(what: str) -> None:
    step_map = schemes.get("gauss4").step_map(Hamiltonian.parse("p**2/2 - cos(q)"))
    with pytest.raises(InputError, match=r"^map=.*given by equations, and has no closed form$"):
        getattr(step_map, what)
    assert step_map.closed is None
    assert step_map.delta_j == 0


def test_a_proof_task_has_no_closed_form_and_is_done() -> None:
    from verify.studies.kinds.proofs import ProofTask

    for name in IMPLICIT:
        task = ProofTask(hamiltonian="p**2*q**2/2 + p**3", parameters={}, scheme=name)
        found = compute_task(task)
        assert found.verdict is Verdict.PROVED  # type: ignore[union-attr]
        assert (found.p_next, found.delta_j) == (None, "0")  # type: ignore[union-attr]


# -- linear stability -----------------------------------------------------------------------------


@pytest.mark.parametrize("name", TABLEAUS)
def test_gauss_methods_are_stable_for_every_step_size(name: str) -> None:
    found = linear_stability(name)
    assert found.interval is sympy.oo
    assert found.delta_j == 0


def test_radau_is_stable_everywhere_and_loses_area() -> None:
    harmonic = systems.get("harmonic").hamiltonian({"omega": 1})
    found = stability_of_map("radau", implicit_map(harmonic, RADAU))
    assert found.interval is sympy.oo
    assert found.delta_j != 0
    y = sympy.Symbol("y", positive=True)
    root = 1 - 2 * sympy.I * y / 3 - y**2 / 6  # R(iy) = (1 + iy/3)/(1 − 2iy/3 + (iy)²/6)
    size = sympy.simplify((1 + y**2 / 9) / sympy.expand(root * sympy.conjugate(root)))
    assert sympy.simplify(found.delta_j + 1 - size) == 0


def test_an_error_in_a_coefficient_makes_the_oscillator_gain_or_lose_area() -> None:
    harmonic = systems.get("harmonic").hamiltonian({"omega": 1})
    wrong = planted(TABLEAUS["gauss4"], 0, 1, sympy.Rational(1, 10**11))
    found = stability_of_map("gauss4", implicit_map(harmonic, wrong))
    assert found.delta_j != 0
    at_one = Fraction(str(sympy.N(found.delta_j.subs(sympy.Symbol("y", positive=True), 1), 30)))
    assert Fraction(1, 10**14) < abs(at_one) < Fraction(1, 10**10)


def test_step_maps_are_made_once() -> None:
    texts = ["p**2/2 - cos(q)"] * 2
    one, other = (schemes.get("gauss6").step_map(Hamiltonian.parse(text)) for text in texts)
    assert isinstance(one, StepMap)
    assert one is other
