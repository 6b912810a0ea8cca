"""Maps with 1/h in them: where the pole at h = 0 is removable, their orders are as others are."""

import pytest
import sympy

from verify.errors import LimitError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.expansion import TaylorExpansion
from verify.proof.order_for_one_h import prove
from verify.schemes import get

PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
P, Q, H = sympy.symbols("p q h", real=True)
REMOVABLE = [
    "p_next = p - (cos(q) - cos(q + h**2))/h; q_next = q + h*p_next",
    "p_next = p - 2*(1 - cos(h))/h*sin(q); q_next = q + h*p",
    "p_next = p - sin(h)*sin(q); q_next = q + (exp(h**2) - 1)/h*p",
    "p_next = p - h*sin(q) - (cosh(h*q) - 1 - h**2*q**2/2)/h**2; q_next = q + h*p",
    "p_next = p - (1/(1 - h**2) - 1)/h*sin(q); q_next = q + h*p_next",
]


def leading_by_sympy(scheme: str) -> tuple[int, sympy.Expr]:
    """The first power of h in det J − 1, and its coefficient, by sympy's own series."""
    p_text, q_text = (part.split("=")[1] for part in scheme.split(";"))
    names = {"p": P, "q": Q, "h": H}
    p_next = sympy.sympify(p_text, locals=names)
    q_next = sympy.sympify(q_text, locals={**names, "p_next": p_next})
    det = sympy.Matrix([p_next, q_next]).jacobian([P, Q]).det() - 1
    series = sympy.expand(sympy.series(sympy.simplify(det), H, 0, 6).removeO())
    power = min((sympy.degree(x, H) for x in sympy.Add.make_args(series) if x != 0), default=0)
    return power, series.coeff(H, power)


@pytest.mark.parametrize("scheme", REMOVABLE)
def test_a_removable_pole_hides_no_order(scheme: str) -> None:
    proof = prove(get(scheme).step_map(PENDULUM), get(scheme))
    assert (proof.verdict, proof.convergence_order) == ("PROVED", 1)
    power, coefficient = leading_by_sympy(scheme)
    if proof.area_preserving:
        assert coefficient == 0
    else:
        assert proof.order == power
        assert (
            sympy.simplify(sympy.sympify(str(proof.leading), {"p": P, "q": Q}) - coefficient) == 0
        )
    assert "h != 0" in proof.domain.texts


@pytest.mark.parametrize(
    "scheme",
    [
        "p_next = p - cos(q + h)/h; q_next = q + h*p",
        "p_next = p - (cos(q) - cos(q + h))/h**2; q_next = q + h*p",
        "p_next = p - h*sin(q); q_next = q + (exp(h**2) - 1)/h**3*p",
    ],
)
def test_a_pole_that_stays_is_no_order(scheme: str) -> None:
    with pytest.raises(LimitError, match="is not smooth in h at h = 0"):
        prove(get(scheme).step_map(PENDULUM), get(scheme))


def test_a_wrong_factor_beside_a_removable_pole_is_refuted() -> None:
    scheme = get("p_next = p - (cos(q) - cos(q + 2*h**2))/h; q_next = q + h*p_next")
    proof = prove(scheme.step_map(PENDULUM), scheme)
    assert (proof.verdict, proof.convergence_order) == ("REFUTED", 0)


def test_the_same_in_two_degrees_of_freedom() -> None:
    hamiltonian = Hamiltonian.parse("p1**2/2 + p2**2/2 - cos(q1)*cos(q2)")
    p = [f"p{i}_next = p{i} - (cos(q{i}) - cos(q{i} + h**2))/h*cos(q{3 - i})" for i in (1, 2)]
    q = [f"q{i}_next = q{i} + h*p{i}_next" for i in (1, 2)]
    scheme = get("; ".join(p + q))
    proof = prove(scheme.step_map(hamiltonian), scheme)
    assert (proof.verdict, proof.convergence_order) == ("PROVED", 1)


def test_coefficients_are_those_of_the_quotient() -> None:
    quotient = sympy.sympify("(cos(q + h) - cos(q))/h", {"q": Q, "h": H})
    field, (x,) = canonical_field(PENDULUM, quotient)
    expansion = TaylorExpansion(field.ring, x)
    found = [ring.expression(each) for ring, each in map(expansion.coefficient, range(3))]
    expected = [-sympy.sin(Q), -sympy.cos(Q) / 2, sympy.sin(Q) / 6]
    assert all(sympy.expand(a - b) == 0 for a, b in zip(found, expected, strict=True))
