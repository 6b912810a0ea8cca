"""Whether a defect's leading coefficient is a derivative along the flow: G is derived in sympy."""

from typing import Any

import pytest
import sympy

from tests.helpers.sampled.formulas import plain
from verify.hamiltonians.equations import read_system
from verify.proof.structures.structure_order import StructureProof, prove_structure
from verify.schemes import get
from verify.structures.reading import KeepsRequest, read_structures

PENDULUM = "p**2/2 - cos(q)"
HENON_HEILES = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"
LOTKA = "u_dot = u*(v - 2); v_dot = v*(1 - u)"
DRIVEN = "p**2/2 + q**4/4 + q*t"


def prove(system: str, scheme: str, keeps: str, **refined: Any) -> StructureProof:
    hamiltonian, method = read_system(system), get(scheme)
    (claim,) = read_structures(KeepsRequest((keeps,), **refined), hamiltonian)
    return prove_structure(method.step_map(hamiltonian), claim.structure, method)


def along_flow(system: str, g: Any) -> Any:
    """∂g/∂t + X·g by sympy's derivatives."""
    hamiltonian = read_system(system)
    symbols = {n: sympy.Symbol(n) for n in (*hamiltonian.coordinates, "t")}
    expression = plain(str(hamiltonian.exact if hamiltonian.energy is not None else "0"))
    rename = lambda x: x.xreplace({s: sympy.Symbol(s.name) for s in x.free_symbols})  # noqa: E731
    if hamiltonian.energy is None:
        slopes = [rename(x) for x in hamiltonian.exact]
    else:
        energy, half = rename(expression), len(hamiltonian.coordinates) // 2
        z = [symbols[n] for n in hamiltonian.coordinates]
        slopes = [*(-energy.diff(x) for x in z[half:]), *(energy.diff(x) for x in z[:half])]
    g = rename(g)
    moved = (f * g.diff(symbols[n]) for f, n in zip(slopes, hamiltonian.coordinates, strict=True))
    return g.diff(symbols["t"]) + sum(moved)


@pytest.mark.parametrize(
    ("system", "scheme", "keeps"),
    [(PENDULUM, "lie2", "energy"), (PENDULUM, "lie4", "energy"), (PENDULUM, "lie2", "volume"),
     (PENDULUM, "implicit-midpoint", "energy"), (PENDULUM, "stormer-verlet", "energy"),
     (PENDULUM, "gauss4", "energy"), (HENON_HEILES, "lie2", "energy"),
     (HENON_HEILES, "lie4", "energy"), ("p1**2/2 + p2**2/2 + q1**4/4 + q1*q2**3", "lie2", "volume"),
     (HENON_HEILES, "stormer-verlet", "energy"),
     ("p1**2/2 + p2**2/2 + (q1**2 + q2**2)**2/4", "lie2", "angular-momentum"),
     (DRIVEN, "lie2", "volume"), ("x_dot = y; y_dot = -x**3", "rk4", "2*y**2 + x**4")],
)  # fmt: skip
def test_the_leading_coefficient_is_the_derivative_of_its_potential(
    system: str, scheme: str, keeps: str
) -> None:
    proof = prove(system, scheme, keeps)
    if proof.telescopes is None:  # RK4: no G is found, and none is claimed
        assert scheme == "rk4"
        assert proof.potential is None
        return
    assert proof.telescopes is True
    gap = along_flow(system, plain(proof.potential)) - plain(proof.leading).xreplace(
        {s: sympy.Symbol(s.name) for s in plain(proof.leading).free_symbols}
    )
    assert sympy.simplify(sympy.expand(gap)) == 0
    assert plain(proof.leading) != 0


def test_a_potential_that_is_off_by_a_factor_is_seen() -> None:
    proof = prove(PENDULUM, "lie2", "energy")
    doubled = along_flow(PENDULUM, 2 * plain(proof.potential))
    leading = plain(proof.leading)
    leading = leading.xreplace({s: sympy.Symbol(s.name) for s in leading.free_symbols})
    assert sympy.simplify(doubled - leading) != 0


@pytest.mark.parametrize(
    ("system", "scheme", "keeps"),
    [("x_dot = y; y_dot = -x", "rk4", "volume"), ("p**2/2 + q**2/2", "rk4", "volume"),
     ("p**2/2 + q**4/4", "p_next = -p - h*q**3; q_next = q + h*p", "area"),
     (HENON_HEILES, "lie2", "volume")],
)  # fmt: skip
def test_what_is_not_0_at_an_equilibrium_does_not_telescope(
    system: str, scheme: str, keeps: str
) -> None:
    proof = prove(system, scheme, keeps)
    assert (proof.telescopes, proof.potential) == (False, None)


def test_formulas_that_agree_with_lie2_are_not_taken_for_it() -> None:
    """H(z') − H(z) of lie2 plus h³ (0, q·…): the formula for lieη is not that of this map."""
    scheme = "p_next = p - h*q - h**2*p/2; q_next = q + h*p - h**2*q/2 + h**3*p/6"
    proof = prove("p**2/2 + q**2/2", scheme, "energy")
    assert (proof.order, proof.leading) == (3, "p*q/6")
    assert proof.telescopes is True
    gap = along_flow("p**2/2 + q**2/2", plain(proof.potential)) - sympy.sympify("p*q/6")
    assert sympy.simplify(gap) == 0


@pytest.mark.parametrize("keeps", ["symplectic", "poisson", "symmetric"])
def test_of_other_components_nothing_is_said(keeps: str) -> None:
    refined = {"form": "du^dv/(u*v)"} if keeps == "symplectic" else {}
    if keeps == "poisson":
        refined = {"poisson": "0, u*v; -u*v, 0"}
    proof = prove(LOTKA, "rk4", keeps, **refined)
    assert (proof.telescopes, proof.potential) == (None, None)
