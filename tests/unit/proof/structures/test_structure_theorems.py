"""What follows from a scheme's coefficients: each theorem where it holds, and where one of its
conditions fails. Where the toolkit is asked for no theorem, series say the same."""

from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
import sympy

from verify.hamiltonians.equations import read_system
from verify.proof.structures.structure_leading import leading_of_structure
from verify.proof.structures.structure_theorems import (
    commutes,
    flow_defect,
    is_kept_by_coefficients,
)
from verify.schemes import get
from verify.schemes.conditions.every_hamiltonian import Stage, StageEquations
from verify.schemes.scheme import Scheme
from verify.structures import Structure
from verify.structures.reading import KeepsRequest, read_structures
from verify.structures.reversible import Reversible
from verify.structures.symmetric import Symmetric

QUARTIC = "p1**2/2 + p2**2/2 + (q1**2 + q2**2)**2/4"
SLIDING = "p1**2/2 + p2**2/2 + cos(q1 - q2)"
TANGLED = "p1**2/2 + p2**2/2 + (q1*p2 - q2*p1)**2"
TOP = "x_dot = y*z; y_dot = -2*x*z; z_dot = x*y"
CROSS = "x_dot = y**3; y_dot = -x**3"


def structure_of(system: str, keeps: str, **refined: Any) -> Structure:
    (claim,) = read_structures(KeepsRequest((keeps,), **refined), read_system(system))
    return claim.structure


def shown(system: str, scheme: str | Scheme, keeps: str, **refined: Any) -> bool:
    method = get(scheme) if isinstance(scheme, str) else scheme
    step_map = method.step_map(read_system(system))
    return is_kept_by_coefficients(step_map, structure_of(system, keeps, **refined), method)


def staged(*stages: tuple[Any, Any, Any, Any]) -> Scheme:
    rows = tuple(Stage(*map(Fraction, row)) for row in stages)
    return Scheme("staged", order=1, area_preserving=False, explicit=False, symmetric=False,
                  source="", every_h=StageEquations(rows))  # fmt: skip


HALF = Fraction(1, 2)
CASES: list[tuple[str, str | Scheme, str, dict[str, Any], bool]] = [
    # linear integrals by all that treats coordinates alike, quadratic ones where M = 0
    (SLIDING, "rk4", "momentum", {}, True), (SLIDING, "lie3", "momentum", {}, True),
    (SLIDING, "gauss4", "momentum", {}, True), (QUARTIC, "rk4", "angular-momentum", {}, False),
    (QUARTIC, "lie3", "angular-momentum", {}, False),
    (QUARTIC, "gauss4", "angular-momentum", {}, True),
    (TOP, "gauss6", "2*x**2 + y**2", {}, True),
    (TOP, "gauss6", "(2*x**2 + y**2)**2", {}, False),
    (CROSS, "gauss4", "symplectic", {"form": "dx^dy"}, True),
    (CROSS, "rk4", "symplectic", {"form": "dx^dy"}, False),
    (CROSS, "gauss4", "volume", {}, True),
    ("u_dot = u*v; v_dot = -v**2", "gauss4", "symplectic", {"form": "v*du^dv"}, False),
    (TOP, "gauss4", "volume", {}, False),
    # stages one after the other
    (TANGLED, "implicit-symplectic-euler", "angular-momentum", {}, True),
    (TANGLED, staged((1, 1, HALF, HALF)), "angular-momentum", {}, True),
    (TANGLED, staged((1, 1, HALF, 0)), "angular-momentum", {}, False),
    (TANGLED, staged((HALF, HALF, 1, 0), (HALF, HALF, 0, 1)), "angular-momentum", {}, True),
    (TANGLED, staged((HALF, HALF, 1, 0), (HALF, 1, 0, 1)), "angular-momentum", {}, False),
    (SLIDING, staged((1, 1, HALF, 0)), "momentum", {}, True),
    ("(p + q)**4/4", staged((1, 1, HALF, 0)), "p + q", {}, True),
    ("(p + q)**4/4", staged((1, HALF, HALF, 0)), "p + q", {}, False),
    # splittings keep what both of their parts keep
    (QUARTIC, "yoshida4", "angular-momentum", {}, True), (SLIDING, "ruth3", "momentum", {}, True),
    (QUARTIC, "stormer-verlet", "energy", {}, False),
    ("p1**2/2 + p2**2/2 + q1**2/2 + q2**2/2", "stormer-verlet", "p1*p2 + q1*q2", {}, False),
    ("p1**2/2 + p2**2/2 + (q1**2 + q2**2)**2*t", "ruth3", "angular-momentum", {}, True),
    ("p**2/2 + q**4/4", "stormer-verlet", "symplectic", {"form": "3*dq^dp"}, True),
    ("p**2/2 + q**4/4", "stormer-verlet", "volume", {}, True),
    # symmetry
    (QUARTIC, "stormer-verlet", "symmetric", {}, True), (TOP, "gauss4", "symmetric", {}, True),
    (QUARTIC, "symplectic-euler", "symmetric", {}, False), (TOP, "rk4", "symmetric", {}, False),
]  # fmt: skip


@pytest.mark.parametrize(("system", "scheme", "keeps", "refined", "holds"), CASES)
def test_a_theorem_says_what_is_kept(
    system: str, scheme: str | Scheme, keeps: str, refined: dict[str, Any], holds: bool
) -> None:
    assert shown(system, scheme, keeps, **refined) is holds


@pytest.mark.sample(8)
@pytest.mark.parametrize(
    ("system", "scheme", "keeps", "refined"), [case[:4] for case in CASES if case[4]]
)
def test_series_say_nothing_against_a_theorem(
    system: str, scheme: str | Scheme, keeps: str, refined: dict[str, Any]
) -> None:
    method = get(scheme) if isinstance(scheme, str) else scheme
    structure = structure_of(system, keeps, **refined)
    # Without the scheme there are no coefficients, and series alone are asked.
    _, leading = leading_of_structure(
        method.step_map(read_system(system)), structure, None, of_flow=False
    )
    assert leading.decision.zero is not False


@pytest.mark.sample(8)
@pytest.mark.parametrize(
    ("system", "scheme", "keeps", "refined"),
    [case[:4] for case in CASES if not case[4] and "(2*x**2" not in case[2]],
)
def test_what_no_theorem_says_is_not_kept(
    system: str, scheme: str | Scheme, keeps: str, refined: dict[str, Any]
) -> None:
    method = get(scheme) if isinstance(scheme, str) else scheme
    structure = structure_of(system, keeps, **refined)
    _, leading = leading_of_structure(
        method.step_map(read_system(system)), structure, method, of_flow=True
    )
    assert leading.decision.zero is False


def test_a_theorem_is_not_asked_where_the_flow_is_not_shown_to_keep_the_structure() -> None:
    method = get("rk4")
    step_map = method.step_map(read_system("p**2/2 + q**4/4"))
    linear = structure_of("p**2/2 + q**4/4", "p - q")  # no integral, but linear
    assert is_kept_by_coefficients(step_map, linear, method)
    _, leading = leading_of_structure(step_map, linear, method, of_flow=False)
    assert (leading.power, leading.decision.zero) == (1, False)


# -- reversibility is symmetry --------------------------------------------------------------------


def reflection(*formulas: str) -> Reversible:
    symbols = (sympy.sympify(x, {n: sympy.Symbol(n, real=True) for n in "pqxyz"}) for x in formulas)
    return Reversible("reversible", "", tuple(symbols))


@pytest.mark.parametrize(
    ("system", "scheme", "formulas", "holds"),
    [("p**2/2 + q**4/4", "rk4", ("-p", "q"), True), ("p**2/2 + q**4/4", "rk4", ("q", "p"), True),
     ("p**2/2 + q**4/4", "rk4", ("1/p", "q"), False),
     ("p**2/2 + q**4/4", "rk4", ("p**3", "q"), False),
     ("p**2/2 + q**4/4", "ruth3", ("-p", "q"), True),
     ("p**2/2 + q**4/4", "ruth3", ("-p", "1 - q"), True),
     ("p**2/2 + q**4/4", "ruth3", ("q", "p"), False),
     ("p**2/2 + q**4/4", "implicit-symplectic-euler", ("q", "p"), False),
     ("p**2/2 + q**4/4", "implicit-midpoint", ("q", "p"), True),
     ("p**2/2 + q**4/4", "gauss4", ("q", "p"), True),
     ("p**2/2 + q**4/4", "p_next = p - h*q**3; q_next = q + h*p", ("-p", "q"), False)],
)  # fmt: skip
def test_schemes_commute_with_maps_that_leave_apart_what_they_treat_apart(
    system: str, scheme: str, formulas: tuple[str, ...], holds: bool
) -> None:
    assert commutes(get(scheme), reflection(*formulas), read_system(system).coordinates) is holds
    assert not commutes(None, reflection(*formulas), read_system(system).coordinates)


@pytest.mark.parametrize(
    ("system", "formulas", "schemes"),
    [("p**2/2 + q**4/4", ("-p", "q"), ("rk4", "lie2", "lie3", "ruth3", "symplectic-euler")),
     (CROSS, ("y", "x"), ("rk4", "lie2", "explicit-midpoint")),
     ("x_dot = y*z; y_dot = z*x; z_dot = x*y", ("-x", "-y", "-z"), ("rk4", "lie2", "euler"))],
)  # fmt: skip
def test_where_they_commute_the_way_back_by_rho_is_that_of_minus_h(
    system: str, formulas: tuple[str, ...], schemes: tuple[str, ...]
) -> None:
    reversible, symmetric = reflection(*formulas), Symmetric("symmetric", "")
    for name in schemes:
        method = get(name)
        step_map = method.step_map(read_system(system))
        # Once by ρ itself, as without a scheme, and once by −h.
        _, by_rho = leading_of_structure(step_map, reversible, None, of_flow=False)
        _, by_h = leading_of_structure(step_map, symmetric, None, of_flow=False)
        assert (by_rho.power, by_rho.text) == (by_h.power, by_h.text)


# -- the flow -------------------------------------------------------------------------------------


def test_the_slope_of_a_defect_is_that_of_the_field_s_parts() -> None:
    system = read_system("p**2/2 + q**4/4")
    energy = structure_of("p**2/2 + q**4/4", "energy")

    def slope(*places: int) -> str:
        (series,) = flow_defect(system, energy, places).values()
        return str(series.ring.expression(series.coefficients[1]))

    assert (slope(0), slope(1), slope(0, 1)) == ("-p*q**3", "p*q**3", "0")
    (whole,) = flow_defect(system, energy).values()
    assert whole.coefficients[1].is_zero()


def test_a_scheme_with_rounded_weights_is_not_taken_for_exact() -> None:
    gauss = get("gauss4")
    tableau = gauss.every_h.tableau  # type: ignore[union-attr]
    rows = [[x + sympy.Rational(1, 10**12) for x in row] for row in tableau.rows]
    planted = replace(tableau, rows=tuple(map(tuple, rows)))
    every_h = replace(gauss.every_h, tableau=planted)  # type: ignore[type-var]
    scheme = replace(gauss, every_h=every_h, build=None)
    assert not shown(TOP, scheme, "2*x**2 + y**2")
    assert not shown(TOP, scheme, "symmetric")
