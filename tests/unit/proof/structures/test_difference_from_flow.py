"""The first difference from the flow shows the leading coefficient that the whole series has."""

from dataclasses import replace
from typing import Any

import pytest

from verify.hamiltonians.equations import read_system
from verify.proof.structures import difference_from_flow
from verify.proof.structures.difference_from_flow import ComponentLeading, leading_by_difference
from verify.proof.structures.structure_leading import _in_series
from verify.schemes import get
from verify.schemes.maps.step_map import StepMap
from verify.structures import Structure
from verify.structures.reading import KeepsRequest, read_structures

KEPLER = "p1**2/2 + p2**2/2 - 1/sqrt(q1**2 + q2**2)"
PREY = "u_dot = u*(v - 2); v_dot = v*(1 - u)"
TOP = "x_dot = -y*z/6; y_dot = z*x/3; z_dot = -x*y/6"
DRIVEN = "p**2/2 - (1 + cos(2*t)/2)*cos(q)"
FORM = {"form": "du^dv/(u*v)", "density": "1/(u*v)", "poisson": "0, u*v; -u*v, 0"}
CASIMIR = {"poisson": "0, z, -y; -z, 0, x; y, -x, 0", "casimirs": ("x**2 + y**2 + z**2",)}
CASES: list[tuple[str, str, tuple[str, ...], dict[str, Any]]] = [
    ("p**2/2 - cos(q)", "lie2", ("symmetric", "energy", "volume"), {}),
    ("p**3 + q**4/4 + a*p*q", "lie3", ("symmetric", "energy", "volume"), {}),
    (DRIVEN, "rk4", ("symmetric",), {}), (DRIVEN, "ruth3", ("symmetric",), {}),
    (DRIVEN, "lie2", ("symmetric", "volume"), {}),
    (KEPLER, "lie2", ("symmetric", "energy", "angular-momentum", "volume"), {}),
    (KEPLER, "ruth3", ("symmetric", "energy"), {}), (KEPLER, "gauss4", ("energy",), {}),
    (KEPLER, "kick 1/2; drift 1; kick 1/3", ("energy",), {}),
    (PREY, "lie2", ("symmetric",), FORM), (PREY, "rk4", (), FORM),
    (TOP, "lie2", ("volume", "symmetric"), CASIMIR), (TOP, "implicit-midpoint", ("volume",), {}),
]  # fmt: skip


def both(
    step_map: StepMap, structure: Structure, most: int
) -> tuple[ComponentLeading | None, ComponentLeading | None]:
    return leading_by_difference(step_map, structure, most), _in_series(
        step_map, structure, 0, most
    )


def shown(x: ComponentLeading | None) -> object:
    return None if x is None else (x[0], x[1].power, x[1].decision.zero, x[1].text)


@pytest.mark.parametrize(("system", "scheme", "keeps", "refined"), CASES)
def test_both_ways_show_the_same(
    system: str, scheme: str, keeps: tuple[str, ...], refined: dict[str, Any]
) -> None:
    parsed, method = read_system(system), get(scheme)
    step_map = method.step_map(parsed)
    for claim in read_structures(KeepsRequest(keeps, **refined), parsed):
        short, whole = both(step_map, claim.structure, method.order + 2)
        assert short is not None
        assert shown(short) == shown(whole)


def test_where_the_first_difference_keeps_it_nothing_is_said() -> None:
    """RK4 has no volume defect at h^5 for the pendulum, and one at h^6."""
    parsed = read_system("p**2/2 - cos(q)")
    (claim,) = read_structures(KeepsRequest(("volume",)), parsed)
    short, whole = both(get("rk4").step_map(parsed), claim.structure, 6)
    assert short is None
    assert whole is not None
    assert whole[1].power == 6


@pytest.mark.parametrize(
    "formulas",
    ["p_next = -p; q_next = q", "p_next = p; q_next = q", "p_next = p; q_next = q + h*p"],
)
def test_a_map_that_follows_no_flow_is_left_to_the_series(formulas: str) -> None:
    parsed = read_system("p**2/2 + q**2/2")
    (claim,) = read_structures(KeepsRequest(("symmetric",)), parsed)
    turned = get(formulas).step_map(parsed)
    assert leading_by_difference(turned, claim.structure, 4) is None


def test_a_wrong_difference_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """Half of d in place of d."""
    parsed, method = read_system("p**2/2 - cos(q)"), get("lie2")
    (claim,) = read_structures(KeepsRequest(("energy",)), parsed)
    right = difference_from_flow.first_nonzero

    def halved(n: int, parts: Any) -> ComponentLeading | None:
        result = right(n, {name: (ring, x / 2) for name, (ring, x) in parts.items()})
        return result and (result[0], replace(result[1]))

    monkeypatch.setattr(difference_from_flow, "first_nonzero", halved)
    short, whole = both(method.step_map(parsed), claim.structure, 4)
    assert shown(short) != shown(whole)
