"""What a user names is read as structures with their orders; what is bad is told in one line."""

from typing import Any

import pytest
import sympy

from tests.helpers.sampled.formulas import plain
from verify.errors import InputError
from verify.hamiltonians.equations import read_system
from verify.proof.structures.structure_order import check_structure
from verify.structures import AREA, SYMPLECTIC
from verify.structures.reading import ClaimedStructure, KeepsRequest, read_structures

PLANE = "p**2/2 + q**4/4"
BODIES = "(p1**2 + p2**2)/2 - 1/sqrt((q1 - q2)**2 + 1)"
SPACE = "(p1**2 + p2**2 + p3**2)/2 - 1/sqrt(q1**2 + q2**2 + q3**2)"
DRIVEN = "p**2/2 - cos(q)*cos(t)"
CIRCLE = "x_dot = y; y_dot = -x"
TOP = "x_dot = y*z; y_dot = -2*x*z; z_dot = x*y"
LOTKA = "u_dot = u*(v - 2); v_dot = v*(1 - u)"
DAMPED = "v_dot = -x - gamma*v; x_dot = v"


def read(system: str, *keeps: str, **refined: Any) -> list[ClaimedStructure]:
    return list(read_structures(KeepsRequest(keeps=keeps, **refined), read_system(system)))


def read_and_check(system: str, *keeps: str, **refined: Any) -> None:
    hamiltonian = read_system(system)
    for claim in read(system, *keeps, **refined):
        check_structure(hamiltonian, claim.structure)


def names(claims: list[ClaimedStructure]) -> list[str]:
    return [x.structure.name for x in claims]


def formulas(*claims: ClaimedStructure) -> list[str]:
    return [str(x) for claim in claims for x in claim.structure.formulas]


# -- what is named --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "name", "order"),
    [("energy", "energy", None), ("energy: 3", "energy", 3), ("volume:12", "volume", 12),
     ("  p - q : 2 ", "p - q", 2), ("p-q", "p-q", None), ("Energy", "energy", None),
     ("ANGULAR_MOMENTUM: 4", "angular-momentum", 4)],
)  # fmt: skip
def test_a_request_is_a_name_or_a_formula_with_an_order(
    text: str, name: str, order: int | None
) -> None:
    system = "(p1**2 + p2**2)/2 + q1*q2" if "ANGULAR" in text else PLANE
    (claim,) = read(system, text)
    assert (claim.structure.name, claim.order) == (name, order)


def test_area_is_the_plane_s_symplectic_form() -> None:
    assert [x.structure for x in read(PLANE, "area", "symplectic")] == [AREA, AREA]
    assert [x.structure for x in read(BODIES, "symplectic")] == [SYMPLECTIC]
    assert [x.structure.defect_formula for x in read(CIRCLE, "area")] == ["ΔJ = det J − 1"]


def test_the_energy_has_the_parameters_values_and_momentum_is_the_sum() -> None:
    system = read_system("a*p**2 + q**2", {"a": "1/2"})
    (energy,) = read_structures(KeepsRequest(("energy",)), system)
    assert formulas(energy) == ["p**2/2 + q**2"]
    assert formulas(*read(BODIES, "momentum")) == ["p1 + p2"]


def test_angular_momentum_has_a_component_in_two_and_three_in_three_degrees_of_freedom() -> None:
    (plane,) = read("(p1**2 + p2**2)/2 + q1**2 + q2**2", "angular-momentum")
    assert formulas(plane) == ["-p1*q2 + p2*q1"]
    space = ["-p2*q3 + p3*q2", "p1*q3 - p3*q1", "-p1*q2 + p2*q1"]
    assert formulas(*read(SPACE, "angular-momentum: 3")) == space


@pytest.mark.parametrize(
    ("refined", "expected"),
    [({"form": "dx^dy"}, ["symplectic"]), ({"density": "2"}, ["volume"]),
     ({"poisson": "0, 1; -1, 0"}, ["poisson"]), ({"reverses": "x, -y"}, ["reversible"]),
     ({"factor": "exp(0*h)", "form": "dx^dy"}, ["conformal"]),
     ({"poisson": "0, 0; 0, 0", "casimirs": ("x**2 + y**2",)}, ["poisson", "casimir"])],
)  # fmt: skip
def test_what_refines_a_structure_implies_it(refined: dict[str, Any], expected: list[str]) -> None:
    assert names(read(CIRCLE, **refined)) == expected
    # Named with an order, it is not implied a second time.
    (claim, *_) = read(CIRCLE, f"{expected[0]}: 5", **refined)
    assert (claim.structure.name, claim.order) == (expected[0], 5)
    assert names(read(CIRCLE, f"{expected[0]}: 5", **refined)) == expected


@pytest.mark.parametrize(
    ("form", "entry"),
    [("du^dv", "1"), ("dv^du", "-1"), ("du∧dv/(u*v)", "1/(u*v)"), ("2*du/\\dv", "2"),
     ("du^dv + 3*dv^du", "-2"), ("(1 + u)*du ^ dv - u*du^dv", "1"), ("-(du^dv)", "-1"),
     ("u*(v*dv^du + du^dv)", "u - u*v")],
)  # fmt: skip
def test_a_form_is_read_in_either_order_and_repeated(form: str, entry: str) -> None:
    (claim,) = read(LOTKA, form=form)
    ((place, x),) = claim.structure.entries.items()  # type: ignore[attr-defined]
    assert place == (0, 1)
    assert sympy.simplify(plain(str(x)) - plain(entry)) == 0


def test_names_that_look_like_marks_or_differentials_are_the_user_s() -> None:
    system = "d__0_dot = dx; dx_dot = -d__0"
    (claim,) = read(system, form="(d__0**2 + dx**2)*dd__0^ddx")
    assert str(claim.structure.entries[0, 1]) == "d__0**2 + dx**2"  # type: ignore[attr-defined]


# -- what is refused, in one line -----------------------------------------------------------------

BAD: list[tuple[str, tuple[str, ...], dict[str, Any], str]] = [
    # unknown names
    (PLANE, ("energi",), {}, "--keeps=energi: unknown; is energy meant?"),
    (PLANE, ("p*x",), {}, "unknown name 'x'; allowed: p, q"),
    (PLANE, ("p-x",), {}, "--keeps=p-x: unknown;"),
    (CIRCLE, (), {"form": "dx^dz"}, "--form=z: unknown; allowed: x, y"),
    (CIRCLE, (), {"form": "m*dx^dy"}, "--form=m*dx^dy: unknown name 'm'; allowed: x, y"),
    (CIRCLE, (), {"density": "1/r"}, "unknown name 'r'"),
    (CIRCLE, (), {"reverses": "-w, y"}, "unknown name 'w'"),
    (CIRCLE, (), {"poisson": "0, a; -a, 0"}, "unknown name 'a'"),
    (CIRCLE, (), {"poisson": "0, 1; -1, 0", "casimirs": ("r",)}, "unknown name 'r'"),
    (DAMPED, (), {"form": "dv^dx", "factor": "exp(-kappa*h)"}, "unknown name 'kappa'"),
    # orders
    (PLANE, ("energy: x",), {}, "the order behind the colon is a whole number, 1 … 20"),
    (PLANE, ("energy:",), {}, "the order behind the colon"),
    (PLANE, ("energy: 0",), {}, "the order behind the colon"),
    (PLANE, ("energy: -2",), {}, "the order behind the colon"),
    (PLANE, ("energy: 2.5",), {}, "the order behind the colon"),
    (PLANE, ("energy: 21",), {}, "the order behind the colon"),
    (PLANE, (" ",), {}, "is empty; give a name or a formula"),
    (PLANE, ("energy: 3 4",), {}, "a formula has no :"),
    # forms
    (TOP, (), {"form": "dx^dy"}, "is degenerate: 3 coordinates are an odd number"),
    (CIRCLE, (), {"form": "dx^dy + dy^dx"}, "is degenerate"),
    (f"{CIRCLE}; z_dot = 0; w_dot = 0", (), {"form": "dx^dy"}, "is degenerate"),
    (f"{CIRCLE}; z_dot = 0; w_dot = 0", (), {"form": "dx^dy + x*dz^dw"},
     "is not closed: dω has dx∧dz∧dw"),
    (CIRCLE, (), {"form": "x"}, "is no sum of coefficients times dx^dy"),
    (CIRCLE, (), {"form": "dx^dy*dx^dy"}, "is no sum of coefficients"),
    (CIRCLE, (), {"form": "dx^dy + 1"}, "is no sum of coefficients"),
    (CIRCLE, (), {"form": "sin(dx^dy)"}, "is no sum of coefficients"),
    (CIRCLE, (), {"form": "dx^dx"}, "has dx^dx, which is 0"),
    (CIRCLE, (), {"form": "dx^dy^dx"}, "unknown name 'dx'; is x meant?"),
    (CIRCLE, (), {"form": "x*dx^dy"}, "is not kept by the exact flow: its defect begins with h^1"),
    (CIRCLE, ("symplectic",), {}, 'a system without H has no p and q; write --form'),
    (TOP, ("area",), {}, "is of one degree of freedom"),
    (BODIES, ("area",), {}, "is of one degree of freedom"),
    # densities
    (CIRCLE, (), {"density": "0"}, "vanishes everywhere"),
    (CIRCLE, (), {"density": "x - x"}, "vanishes everywhere"),
    (CIRCLE, (), {"density": "(x + y)**2 - x**2 - y**2 - 2*x*y"}, "vanishes everywhere"),
    (CIRCLE, (), {"density": "x"}, "is not kept by the exact flow"),
    # integrals
    (PLANE, ("p*q",), {}, "is not kept by the exact flow"),
    (PLANE, ("momentum",), {}, "is not kept by the exact flow"),
    (PLANE, ("3",), {}, "is a constant, which every step keeps"),
    (PLANE, ("p - p",), {}, "is a constant"),
    (CIRCLE, ("energy",), {}, "a system without H has none"),
    (DRIVEN, ("energy",), {}, "H depends on t, and is no first integral"),
    (PLANE, ("angular-momentum",), {}, "is of two or three degrees of freedom"),
    (CIRCLE, ("angular-momentum",), {}, "a system without H has no p and q"),
    (CIRCLE, ("momentum",), {}, "a system without H has no p and q"),
    # involutions
    (CIRCLE, (), {"reverses": "x + 1, -y"}, "is no involution: done twice it does not lead x back"),
    (CIRCLE, (), {"reverses": "y, -x"}, "is no involution"),
    (CIRCLE, (), {"reverses": "x"}, "has 1 formulas, and there are 2 coordinates"),
    (CIRCLE, (), {"reverses": "x, y"}, "is not kept by the exact flow"),
    (CIRCLE, (), {"reverses": "1/x, -y"}, "is not affine"),
    (CIRCLE, ("reversible",), {}, 'a system without H has no p and q; write --reverses'),
    (DRIVEN, ("reversible",), {}, "is of systems that do not depend on t"),
    # brackets
    (CIRCLE, (), {"poisson": "0, 1; 1, 0"}, "is not antisymmetric: {x, y}"),
    (CIRCLE, (), {"poisson": "1, 0; 0, 0"}, "is not antisymmetric: {x, x}"),
    (CIRCLE, (), {"poisson": "0, 1"}, "is no matrix of 2 rows"),
    (CIRCLE, (), {"poisson": "0, 1; -1"}, "is no matrix of 2 rows"),
    (TOP, (), {"poisson": "0, 1, x; -1, 0, 0; -x, 0, 0"},
     "does not fulfil Jacobi's identity for x, y, z"),
    (CIRCLE, ("poisson",), {}, "--poisson: is missing"),
    (CIRCLE, (), {"casimirs": ("x",)}, "--poisson: is missing"),
    (CIRCLE, (), {"poisson": "0, 1; -1, 0", "casimirs": ("x",)}, "is no Casimir"),
    # factors
    (DAMPED, ("conformal",), {"form": "dv^dx"}, "--factor: is missing"),
    (DAMPED, (), {"form": "dv^dx", "factor": "1 - gamma*h"}, "has a factor that is no exp(κ*h)"),
    (DAMPED, (), {"form": "dv^dx", "factor": "2*exp(-gamma*h)"}, "a factor that is not 1 at h = 0"),
    (DAMPED, (), {"form": "dv^dx", "factor": "exp(-x*h)"}, "has x; allowed: h and parameters"),
    (DAMPED, (), {"form": "dv^dx", "factor": "exp(gamma*h)"}, "is not kept by the exact flow"),
    (DAMPED, (), {"factor": "exp(-gamma*h)"}, "write --form"),
]  # fmt: skip


@pytest.mark.parametrize(("system", "keeps", "refined", "problem"), BAD)
def test_what_is_bad_is_told_in_one_line(
    system: str, keeps: tuple[str, ...], refined: dict[str, Any], problem: str
) -> None:
    with pytest.raises(InputError) as caught:
        read_and_check(system, *keeps, **refined)
    line = str(caught.value)
    assert problem in line
    assert "\n" not in line
    assert "d__" not in line


GOOD: list[tuple[str, tuple[str, ...], dict[str, Any]]] = [
    (PLANE, ("energy", "area", "volume", "reversible", "symmetric"), {}),
    (BODIES, ("symplectic", "momentum", "reversible"), {}),
    (SPACE, ("angular-momentum",), {}),
    (DRIVEN, ("area", "volume", "symmetric"), {}),
    (LOTKA, ("u + v - log(u) - 2*log(v)",),
     {"form": "du^dv/(u*v)", "density": "1/(u*v)", "poisson": "0, u*v; -u*v, 0"}),
    (TOP, ("2*x**2 + y**2", "volume"), {"reverses": "-x, -y, -z"}),
    (TOP, (), {"poisson": "0, z, -y; -z, 0, x; y, -x, 0", "casimirs": ("x**2 + y**2 + z**2",)}),
    (DAMPED, (), {"form": "dv^dx", "factor": "exp(-gamma*h)"}),
    (CIRCLE, (), {"reverses": "y, x"}),
    ("x_dot = 1; y_dot = 2*t", ("y - t**2",), {}),
]  # fmt: skip


@pytest.mark.parametrize(("system", "keeps", "refined"), GOOD)
def test_what_the_flow_keeps_is_taken(
    system: str, keeps: tuple[str, ...], refined: dict[str, Any]
) -> None:
    read_and_check(system, *keeps, **refined)


def test_a_request_of_nothing_is_false() -> None:
    assert not KeepsRequest()
    assert KeepsRequest(keeps=("energy",))
    assert KeepsRequest(density="1")
