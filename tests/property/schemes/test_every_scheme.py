"""Every scheme that has a name: what it claims is what is proved for every H."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.formulas import H, P, Q, plain, polynomials, zero_there
from tests.helpers.symmetry import prove_symmetry
from verify import schemes
from verify.errors import InputError, LimitError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_every_h import prove_for_every_h
from verify.proof.order_for_one_h import prove
from verify.schemes import get, names
from verify.schemes.conditions.every_hamiltonian import TaylorSeries
from verify.schemes.methods.taylor.lie import eta_of
from verify.verdict import Verdict

SEPARABLE = "p**2/2 + p**3/3 + q**2/2 + q**4/4 + q**3/3"
MIXED = "p**2/2 + q**2/2 + p*q**2 + q**3/3"
few = drawn(12)


@pytest.mark.parametrize("separable", [False, True])
@pytest.mark.parametrize("name", [n for n in names() if n != "lie6"])
def test_a_scheme_has_for_every_h_what_it_claims_and_no_more(name: str, separable: bool) -> None:
    scheme = get(name)
    assert scheme.name == name
    proof = prove_for_every_h(name, separable)
    assert (proof.verdict, proof.convergence_order) == (Verdict.PROVED, scheme.order)
    assert proof.scheme == name
    assert proof.area_preserving == scheme.area_preserving
    assert proof.separable == (separable or scheme.needs_separable)
    assert ("T(p) + V(q)" in proof.quantifier) == proof.separable
    assert bool(proof.argument) == (eta_of(name) is not None or name == "euler")
    if scheme.area_preserving:
        assert (proof.order, proof.leading, proof.telescopes) == (None, "0", None)
    else:
        assert proof.order is not None
        assert proof.order > scheme.order
        assert f"below h^{proof.order} vanish" in proof.reason
        assert (proof.potential is not None) == proof.telescopes
        assert f"h¹ … h^{proof.order - 1} in det J" in proof.checked[0]
    if isinstance(scheme.every_h, TaylorSeries):
        eta = scheme.order
        assert proof.formula == f"-div(X^{eta} f)/{eta + 1}!, f = (-H_q, H_p)"
        assert proof.telescopes == (eta % 2 == 0)
        assert any(f"−div(X^{eta} f)/{eta + 1}!" in x for x in proof.checked)
        assert ("X·G is that coefficient" in proof.checked) == proof.telescopes
    else:
        assert proof.formula == ""


@pytest.mark.parametrize("name", names())
def test_a_schemes_symmetry_and_explicitness_are_those_of_its_steps(name: str) -> None:
    scheme = get(name)
    found = prove_symmetry(scheme)
    wanted = Verdict.PROVED if scheme.symmetric else Verdict.REFUTED
    assert found.verdict is wanted, found.reason
    bent = SEPARABLE if scheme.needs_separable else f"{MIXED} + p**3*q"
    step_map = scheme.step_map(Hamiltonian.parse(bent))
    assert step_map.implicit == (not scheme.explicit)
    if step_map.implicit:
        assert (step_map.closed, step_map.formulas, step_map.has_closed_form) == (
            None, None, scheme.area_preserving,
        )  # fmt: skip
        with pytest.raises(LimitError, match="is given by equations"):
            assert step_map.flat
    if scheme.needs_separable:
        with pytest.raises(InputError, match=r"T\(p\) \+ V\(q\)"):
            scheme.step_map(Hamiltonian.parse(MIXED))
    assert scheme.source


@pytest.mark.parametrize("name", [n for n in names() if n not in ("lie5", "lie6", "triple-jump6")])
def test_for_one_h_a_scheme_has_the_orders_that_it_has_for_every(name: str) -> None:
    scheme = get(name)
    text = SEPARABLE if scheme.needs_separable else MIXED
    proof, of_every = (
        prove(scheme.step_map(Hamiltonian.parse(text)), scheme),
        prove_for_every_h(name),
    )
    assert proof.verdict is Verdict.PROVED
    assert proof.convergence_order == scheme.order
    assert (proof.order, proof.area_preserving) == (of_every.order, of_every.area_preserving)


@few
@given(polynomials("p", 3, 1), polynomials("q", 2, 1), polynomials("q", 3, 2), st.booleans())
def test_implicit_symplectic_euler_solves_its_equations(
    kinetic: str, mixed: str, potential: str, linear: bool
) -> None:
    """Where they are solved in closed form: H_q is linear in p."""
    inner = f"p*({mixed})" if linear else "0"
    text = f"{kinetic} + {inner} + {potential}"
    step_map = get("implicit-symplectic-euler").step_map(Hamiltonian.parse(f"p**2/2 + {text}"))
    whole = plain(f"p**2/2 + {text}")
    p_next, q_next = step_map.p_next, step_map.q_next
    assert zero_there(p_next - P + H * whole.diff(Q).subs(P, p_next))
    assert zero_there(q_next - Q - H * whole.diff(P).subs(P, p_next))


@pytest.mark.parametrize("name", names())
def test_a_scheme_has_one_name_and_no_other(name: str) -> None:
    for file in schemes._FILES.names:
        made = schemes._scheme_from_file(file, name)
        assert made is None or made.name == name
    for said in (f" {name} ", name.upper(), name.capitalize()):
        assert get(said).name == name
    for wrong in (f"{name}x", f"x{name}", f"{name}\n{name}"):
        with pytest.raises(InputError, match=r"unknown|order"):
            get(wrong)


@few
@given(st.integers(-2, 1200))
def test_the_truncated_flow_is_there_for_1_to_100(eta: int) -> None:
    if 1 <= eta <= 100:
        assert eta_of(f"lie{eta}") == get(f"lie{eta}").order == eta
        assert get(f"lie{eta:03}").name == f"lie{eta}"
    else:
        with pytest.raises(InputError, match=r"1 … 100|unknown"):
            get(f"lie{eta}")
    if eta > 14:
        with pytest.raises(InputError, match="of order 14 at most"):
            prove_for_every_h(f"lie{min(eta, 100)}")
    assert eta_of(f"li{eta}") is eta_of(f"lie{eta}x") is None


ROOT19, ROOT471, R = 19**0.5, 471**0.5, 2 ** (1 / 3)
KNOWN = {
    "blanes-moan4": [0.0792036964311957, 0.209515106613362, 0.353172906049774, -0.143851773179818],
    "ruth3": [7 / 24, 2 / 3, 3 / 4, -2 / 3, -1 / 24, 1.0],
    "suzuki4": [0.5 / (4 - 4 ** (1 / 3)), 1 / (4 - 4 ** (1 / 3))],
    "yoshida4": [0.5 / (2 - R), 1 / (2 - R), (1 - R) / (2 - R) / 2, -R / (2 - R)],
    "forest-ruth": [0.5 / (2 - R), 1 / (2 - R), (1 - R) / (2 - R) / 2, -R / (2 - R)],
    "triple-jump6": [0.5 / (2 - R) / (2 - 2**0.2), 1 / (2 - R) / (2 - 2**0.2)],
    "mclachlan4": [(14 - ROOT19) / 108, 0.4, (20 - 7 * ROOT19) / 108, -0.1, (5 + 2 * ROOT19) / 27],
    "mclachlan4-s4": [(642 + ROOT471) / 3924, 6 / 11, 121 * (12 - ROOT471) / 3924, -1 / 22],
}


@pytest.mark.parametrize("name", KNOWN)
def test_coefficients_are_those_of_the_source(name: str) -> None:
    """Another solution of the same conditions would be a scheme as good, and not this one."""
    own = [float(size) for _, size in getattr(get(name).every_h, "parts", ())]
    for x, y in zip(own, KNOWN[name], strict=False):
        assert math.isclose(x, y, rel_tol=1e-13)
