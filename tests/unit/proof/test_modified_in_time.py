"""The modified Hamiltonian of H(p, q, t): the step is the flow of the field with t' = 1."""

import mpmath
import pytest
import sympy

import verify
from tests.helpers.sampled.formulas import P, Q
from verify import schemes
from verify.algebra.symbols import H_STEP
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.plane.modified_equation import ModifiedEquation
from verify.proof.plane.modified_for_one_h import modified_for_one_h
from verify.runs.run_errors import energy_drifts
from verify.schemes.maps.parts import parts_of
from verify.verdict import Verdict

T = sympy.Symbol("t", real=True)
DUFFING = "p**2/2 + q**2/2 + q**4/4 - q*cos(7*t/5)/2"
PENDULUM = "p**2/2 - (1 + cos(2*t)/2)*cos(q)"
HEAVIER = "p**2*(1 + t**2)/2 + q**2/2"
MIXED = "p**2/2 + p*q**2*sin(t) + q**2/2"


def found(text: str, name: str, order: int = 4) -> ModifiedEquation:
    scheme = schemes.get(name)
    return modified_for_one_h(scheme.step_map(Hamiltonian.parse(text)), scheme, order)


def stepped(text: str, name: str, z: list[mpmath.mpf], h: mpmath.mpf) -> list[mpmath.mpf]:
    p, q, t = z
    step_map = schemes.get(name).step_map(Hamiltonian.parse(text))
    parts = parts_of(step_map) or ()
    for after in [list(map(x.ring.expression, x.elements)) for x in parts] or [step_map.composed]:
        p, q = sympy.lambdify((P, Q, T, H_STEP), after, "mpmath")(p, q, t, h)
    return [p, q]


def miss(text: str, name: str, vector: list[sympy.Expr]) -> float:
    """By what power of h the step and the flow of the field part."""
    right = sympy.lambdify((P, Q, T, H_STEP), vector, "mpmath")
    errors = []
    with mpmath.workdps(30):
        z = [mpmath.mpf("0.6"), mpmath.mpf("0.7"), mpmath.mpf("0.3")]
        for h in (mpmath.mpf(1) / 200, mpmath.mpf(1) / 400):

            def slope(_: mpmath.mpf, y: list[mpmath.mpf], h: mpmath.mpf = h) -> list[mpmath.mpf]:
                return [*right(*y, h), mpmath.mpf(1)]

            there = mpmath.odefun(slope, 0, z, tol=mpmath.mpf(10) ** -25)(h)
            here = stepped(text, name, z, h)
            errors.append(max(abs(a - b) for a, b in zip(here, there[:2], strict=True)))
        return float(mpmath.log(errors[0] / errors[1], 2))


CASES = [
    (DUFFING, "stormer-verlet", 3),
    (PENDULUM, "lie2", 3),
    (PENDULUM, "symplectic-euler", 2),
    (HEAVIER, "stormer-verlet", 3),
    (MIXED, "explicit-midpoint", 3),
    (DUFFING, "stormer-verlet, clock frozen", 2),
]


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize(("text", "name", "order"), CASES)
@pytest.mark.parametrize("planted", [False, True])
def test_the_map_is_the_flow_of_the_field(text: str, name: str, order: int, planted: bool) -> None:
    result = found(text, name, order)
    names = {"p": P, "q": Q, "t": T}
    vector = [
        sum(H_STEP**x.power * sympy.sympify(getattr(x, part), names) for x in result.terms)
        for part in ("p", "q")
    ]
    if planted:
        vector[0] += H_STEP**order * sympy.cos(T)
    expected = order + 1 if planted else order + 2
    assert result.area is True
    assert miss(text, name, vector) == pytest.approx(expected, abs=0.25)


@pytest.mark.sample(3)
@pytest.mark.parametrize("text", [DUFFING, PENDULUM, HEAVIER])
@pytest.mark.parametrize("name", ["stormer-verlet", "symplectic-euler", "implicit-midpoint"])
def test_what_is_symplectic_has_a_function_in_each_term(text: str, name: str) -> None:
    result = found(text, name)
    assert (result.verdict, result.reach) == (Verdict.PROVED, 4)
    energy = result.expression
    for x in result.terms:
        part = energy.expand().coeff(H_STEP, x.power)
        names = {"p": P, "q": Q, "t": T}
        assert sympy.simplify(part.diff(P) - sympy.sympify(x.q, names)) == 0
        assert sympy.simplify(part.diff(Q) + sympy.sympify(x.p, names)) == 0


def test_a_force_alone_by_hand() -> None:
    """Of H = p²/2 − q f(t), symplectic Euler: p' = p + h f(t), q' = q + h p', f = t²."""
    result = found("p**2/2 - q*t**2", "symplectic-euler", 2)
    # p' = f + h a + h² b with ∫₀ʰ p' dt = h f(t): a = −f'/2, b = f''/12.
    assert sympy.expand(-result.expression.diff(Q)) == T**2 - H_STEP * T + H_STEP**2 / 6


def test_a_clock_that_stands_still_has_a_term_of_h() -> None:
    result = found(DUFFING, "stormer-verlet, clock frozen", 2)
    assert result.verdict is Verdict.REFUTED
    assert "the term of h^1 is not 0" in str(result.reason)
    assert found(DUFFING, "stormer-verlet", 2).verdict is Verdict.PROVED


def test_no_drift_is_measured_of_an_energy_that_is_not_kept() -> None:
    run = verify.run(DUFFING, "stormer-verlet", q=1, p=0, step_size="0.1", steps=10, points=5)
    with pytest.raises(InputError, match="depends on t: no energy is kept"):
        energy_drifts(run)
