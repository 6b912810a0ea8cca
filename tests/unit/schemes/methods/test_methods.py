"""The schemes: found by themselves, and every claim they make held against a proof."""

from fractions import Fraction

import pytest
import sympy

from tests.helpers.sampled.formulas import P, Q, lie_step, plain
from tests.helpers.symmetry import palindromic, prove_symmetry
from verify import schemes
from verify.errors import InputError
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.map_symmetry import judge_symmetry
from verify.proof.order_for_one_h import prove
from verify.proof.proof_for_one_h import Proof
from verify.schemes.conditions.every_hamiltonian import Stage, StageEquations
from verify.verdict import Verdict

FILES = schemes._FILES
NAMES = schemes.names()
SYSTEMS = sorted(systems.all_systems())
NONLINEAR = "p**2/2 - cos(q)"  # a linear problem may flatter an order
USERS_OWN = (
    "p_next = p - h*q; q_next = q + h*p_next",
    "kick 1/2; drift 1; kick 1/2",
    "verlet, clock frozen",
    "A 1/2; B 1; A 1/2 with A: x_dot = y; B: y_dot = -x",
    "0 |; 1/2 | 1/2; | 0 1; order 2",
)


def proof_of(scheme_name: str, hamiltonian: Hamiltonian) -> Proof:
    scheme = schemes.get(scheme_name)
    return prove(scheme.step_map(hamiltonian), scheme)


# -- discovery --------------------------------------------------------------------------------


@pytest.mark.parametrize("file", FILES.names)
def test_each_file_answers_to_its_names_and_to_no_other(file: str) -> None:
    answered = [
        name for name in (*NAMES, *USERS_OWN) if schemes._scheme_from_file(file, name) is not None
    ]
    assert answered, "an orphan: no name reaches this file"
    told = getattr(FILES.module(file), "EXAMPLES", [file])
    assert [name for name in answered if name not in USERS_OWN] == list(told)


@pytest.mark.parametrize("name", NAMES)
def test_a_scheme_has_the_name_it_answers_to(name: str) -> None:
    scheme = schemes.get(name)
    assert scheme.name == name
    assert scheme.source
    assert scheme.order >= 1


def test_no_name_is_listed_twice_and_the_paper_schemes_are_there() -> None:
    assert len(set(NAMES)) == len(NAMES)
    assert {"lie1", "lie2", "lie4", "symplectic-euler"} <= set(NAMES)


UNKNOWN = ["", "lie", "lie-2", "lie2.0", "eulers", "rk5", "lie\u0662"]


@pytest.mark.parametrize("name", UNKNOWN)
def test_an_unknown_name_is_refused_with_the_known_ones(name: str) -> None:
    with pytest.raises(InputError, match=r"^scheme=.*lie1.*symplectic-euler"):
        schemes.get(name)


@pytest.mark.parametrize("name", ["lie0", "lie101", "lie999999999999", "lie00", "lie" + "9" * 5000])
def test_an_order_outside_1_to_100_is_refused(name: str) -> None:
    with pytest.raises(InputError, match=r"^scheme=.*1 … 100"):
        schemes.get(name)


@pytest.mark.parametrize("eta", [1, 7, 100])
def test_every_order_from_1_to_100_is_a_scheme(eta: int) -> None:
    scheme = schemes.get(f"lie{eta}")
    assert (scheme.name, scheme.order) == (f"lie{eta}", eta)


# -- claims -----------------------------------------------------------------------------------


@pytest.mark.left_to_ci
@pytest.mark.sample(90)
@pytest.mark.parametrize("system", SYSTEMS)
@pytest.mark.parametrize("name", NAMES)
def test_the_claims_of_a_scheme_are_proved_for_every_system_it_takes(
    name: str, system: str
) -> None:
    scheme = schemes.get(name)
    try:
        step_map = scheme.step_map(systems.get(system).hamiltonian())
    except InputError:
        pytest.skip(f"{name} does not take {system}")
    proof = prove(step_map, scheme)
    assert proof.verdict is Verdict.PROVED
    assert proof.convergence_order is None or proof.convergence_order >= scheme.order
    assert proof.area_preserving is True or not scheme.area_preserving


def hardest_taken(name: str) -> Hamiltonian:
    """A nonlinear problem, but for a scheme that can be solved for linear ones only."""
    nonlinear = Hamiltonian.parse(NONLINEAR)
    try:
        schemes.get(name).step_map(nonlinear)
    except InputError:
        assert not schemes.get(name).explicit
        return Hamiltonian.parse("p**2/2 + a*p*q + q**2")
    return nonlinear


@pytest.mark.parametrize("name", NAMES)
def test_a_scheme_claims_no_less_than_it_has_on_a_nonlinear_problem(name: str) -> None:
    scheme, proof = schemes.get(name), proof_of(name, hardest_taken(name))
    assert proof.convergence_order == scheme.order
    assert proof.area_preserving is scheme.area_preserving


@pytest.mark.parametrize("name", NAMES)
def test_a_scheme_is_symmetric_exactly_where_it_claims_to_be(name: str) -> None:
    """By its coefficients for every H; or, for one H, the step of −h undoes that of h not quite."""
    scheme = schemes.get(name)
    found = prove_symmetry(scheme)
    assert found.verdict is (Verdict.PROVED if scheme.symmetric else Verdict.REFUTED), found.reason
    if scheme.symmetric and scheme.explicit:
        series = judge_symmetry(
            scheme.step_map(Hamiltonian.parse("p**3/3 + p**2/2 + q**3 - q**2")), 5
        )
        assert (series.verdict, series.power) == (Verdict.UNDECIDED, None)
    if not scheme.symmetric:
        assert found.power is not None
        assert found.power > scheme.order


def test_a_stage_in_the_middle_is_undone_by_itself_and_others_are_not() -> None:
    one, third = Fraction(1), Fraction(1, 3)
    assert palindromic(StageEquations((Stage(one, one, one / 2, one / 2),)))
    assert palindromic(StageEquations((Stage(one, one, third), Stage(one, one, 1 - third, one))))
    assert not palindromic(StageEquations((Stage(one, one, one / 2, third),)))
    assert not palindromic(StageEquations((Stage(one, one, third), Stage(one, one, third, one))))


@pytest.mark.parametrize("name", NAMES)
def test_a_map_without_any_step_is_refuted_whatever_the_scheme_claims(name: str) -> None:
    hamiltonian = Hamiltonian.parse(NONLINEAR)
    frozen = schemes.get("p_next = p; q_next = q").step_map(hamiltonian)
    proof = prove(frozen, schemes.get(name))
    assert proof.verdict is Verdict.REFUTED
    assert proof.area_preserving is True


def test_a_scheme_of_lower_order_does_not_pass_for_a_higher_one() -> None:
    step_map = schemes.get("lie1").step_map(Hamiltonian.parse(NONLINEAR))
    proof = prove(step_map, schemes.get("lie2"))
    assert proof.verdict is Verdict.REFUTED
    assert "lie2 claims order 2" in proof.reason


def test_a_scheme_that_loses_area_does_not_pass_for_one_that_keeps_it() -> None:
    step_map = schemes.get("lie1").step_map(Hamiltonian.parse(NONLINEAR))
    proof = prove(step_map, schemes.get("symplectic-euler"))
    assert proof.verdict is Verdict.REFUTED
    assert "det J ≡ 1" in proof.reason


# -- symplectic Euler -------------------------------------------------------------------------


@pytest.mark.parametrize("text", ["p*q", "p**2*(1 + q**2)/2", "cos(p + q)", "p**2 + q**2 + p*q/9"])
def test_symplectic_euler_refuses_what_is_not_separable(text: str) -> None:
    with pytest.raises(InputError, match=r"^hamiltonian=.*T\(p\) \+ V\(q\)"):
        schemes.get("symplectic-euler").step_map(Hamiltonian.parse(text))


def test_symplectic_euler_refuses_in_one_line_however_large_the_numbers_are() -> None:
    with pytest.raises(InputError) as info:
        schemes.get("symplectic-euler").step_map(Hamiltonian.parse("p*(1e999*q)**5"))
    assert len(str(info.value)) < 300


def test_symplectic_euler_is_eq_24_on_duffing() -> None:
    step_map = schemes.get("symplectic-euler").step_map(systems.get("duffing").hamiltonian())
    p_next = plain("p - h*(q + delta*q**3)")
    assert sympy.expand(step_map.p_next - p_next) == 0
    assert sympy.expand(step_map.q_next - Q - plain("h") * p_next) == 0


# -- the Lie-derivative scheme ----------------------------------------------------------------


def test_euler_is_lie1() -> None:
    duffing = systems.get("duffing").hamiltonian()
    one, other = (schemes.get(name).step_map(duffing) for name in ("euler", "lie1"))
    assert (one.p_next, one.q_next) == (other.p_next, other.q_next)


POLYNOMIAL = {
    "duffing": "p**2/2 + q**2/2 + delta*q**4/4",
    "harmonic": "p**2/2 + omega**2*q**2/2",
    "not separable": "p**2*q**3/3 - a*p*q + q",
    "symmetric": "(p**2 + q**2)**2/4",
}
SMOOTH = {
    "pendulum": "p**2/2 - cos(q)",
    "exponentials": "exp(p) + exp(-a*q)",
    "one sine": "sin(p*q + 1)",
    "relativistic": "sqrt(1 + p**2) + q**2/2",
    "quotient": "p**2/(2*(1 + q**2))",
    "logarithm": "p**2/2 + log(cosh(q))",
    "quarter root": "(1 + p**2 + q**2)**(1/4)",
    "root of a hyperbolic tangent": "p*sqrt(tanh(q))",
}


@pytest.mark.parametrize("eta", [1, 2, 3, 4])
@pytest.mark.parametrize("text", POLYNOMIAL.values(), ids=POLYNOMIAL.keys())
def test_lie_is_eq_2_to_5_to_the_letter_for_a_polynomial(text: str, eta: int) -> None:
    step_map = schemes.get(f"lie{eta}").step_map(Hamiltonian.parse(text))
    p_next, q_next = lie_step(plain(text), eta)
    assert sympy.expand(step_map.p_next - p_next) == 0
    assert sympy.expand(step_map.q_next - q_next) == 0


@pytest.mark.parametrize("eta", [1, 2, 3])
@pytest.mark.parametrize("text", SMOOTH.values(), ids=SMOOTH.keys())
def test_lie_is_eq_2_to_5_to_the_letter_for_a_smooth_function(text: str, eta: int) -> None:
    step_map = schemes.get(f"lie{eta}").step_map(Hamiltonian.parse(text))
    at = {P: sympy.Rational(3, 7), Q: sympy.Rational(5, 11), plain("h"): sympy.Rational(1, 9)}
    at[plain("a")] = sympy.Rational(2, 3)
    for ours, theirs in zip(
        (step_map.p_next, step_map.q_next), lie_step(plain(text), eta), strict=True
    ):
        assert abs((ours - theirs).subs(at).evalf(60, chop=False)) < sympy.Rational(1, 10**45)


@pytest.mark.parametrize("text", SMOOTH.values(), ids=SMOOTH.keys())
def test_lie2_has_order_2_and_a_known_order_of_delta_j_for_a_smooth_function(text: str) -> None:
    proof = proof_of("lie2", Hamiltonian.parse(text))
    assert proof.verdict is Verdict.PROVED
    assert proof.convergence_order == 2
    assert proof.order is not None
    assert proof.order >= 3


def test_lie2_is_eq_19_on_duffing() -> None:
    step_map = schemes.get("lie2").step_map(systems.get("duffing").hamiltonian())
    p_next = plain("p - h*(q + delta*q**3) - h**2/2*p*(1 + 3*delta*q**2)")
    q_next = plain("q + h*p - h**2/2*(q + delta*q**3)")
    assert sympy.expand(step_map.p_next - p_next) == 0
    assert sympy.expand(step_map.q_next - q_next) == 0


def test_lie2_loses_area_as_eq_21_says_on_duffing() -> None:
    proof = proof_of("lie2", systems.get("duffing").hamiltonian())
    assert proof.order == 3
    assert sympy.expand(proof.leading - plain("3*delta*p*q")) == 0
