"""Orbits over two initial values: what stays, is sensitive, leaves; each with its control."""

from fractions import Fraction
from math import e
from typing import Any

import pytest

import verify
from verify.errors import InputError
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.results.stability import OrbitMapResult
from verify.scenes.scene import scene_from
from verify.studies.stability.map_of_orbits import orbit_map

HENON_HEILES = systems.get("henon-heiles").hamiltonian({})
TWO = Hamiltonian.parse("(p1**2 + p2**2 + q1**2 + q2**2)/2")


def evenly(low: str, high: str, count: int) -> list[Fraction]:
    first, last = Fraction(low), Fraction(high)
    return [first + (last - first) * k / (count - 1) for k in range(count)]


def found(hamiltonian: Hamiltonian, scheme: str, **changes: Any) -> OrbitMapResult:
    zero = Fraction(0), Fraction(0)
    given: dict[str, Any] = {
        "axes": ("q2", "p2"),
        "across": evenly("-0.6", "1.2", 13), "upwards": evenly("-0.6", "0.6", 9),
        "q": zero, "p": (Fraction(1, 5), Fraction(0)), "step_size": Fraction(1, 10), "steps": 3000,
        "beyond": Fraction(12), **changes,
    }  # fmt: skip
    return orbit_map(hamiltonian, scheme, **given)


def in_the_well(over: OrbitMapResult) -> list[tuple[int, int]]:
    """Those of an energy below 1/6 inside of the triangle, which no exact orbit leaves."""
    return [
        (i, j)
        for i, j in over.places()
        if Fraction(over.energies[i][j] or 1) < Fraction(16, 100) and Fraction(over.across[j]) < 1
    ]


@pytest.mark.parametrize(("scheme", "stays"), [("stormer-verlet", True), ("euler", False)])
def test_below_the_escape_energy_a_good_scheme_stays_and_eulers_leaves(
    scheme: str, stays: bool
) -> None:
    over = found(HENON_HEILES, scheme)
    kinds = [over.kinds[i][j] for i, j in in_the_well(over)]
    assert len(kinds) > 25
    assert ("leaves" not in kinds) is stays
    outer = [over.kinds[i][-1] for i in range(len(over.upwards))]  # beyond the saddle at q2 = 1
    assert set(outer) == {"leaves"}


def test_the_inner_orbits_are_regular_and_those_near_the_escape_energy_sensitive() -> None:
    over = found(HENON_HEILES, "stormer-verlet")
    energies: dict[str, list[float]] = {"regular": [], "sensitive": []}
    for i, j in in_the_well(over):
        energies.setdefault(over.kinds[i][j], []).append(float(over.energies[i][j] or 0))
    mean = {kind: sum(x) / len(x) for kind, x in energies.items() if x}
    assert mean["regular"] < 0.09 < mean["sensitive"]


def test_neighbours_on_a_saddle_part_at_its_exponent_and_on_an_oscillator_do_not() -> None:
    saddle = Hamiltonian.parse("(p1**2 - q1**2 + p2**2 + q2**2)/2")
    start = {"across": [Fraction(0)], "upwards": [Fraction(1, 2)], "p": (Fraction(0), Fraction(0))}
    apart = found(saddle, "rk4", **start, steps=150)
    assert apart.kinds == (("sensitive",),)
    assert float(apart.lyapunov[0][0] or 0) == pytest.approx(1, rel=0.1)
    together = found(TWO, "rk4", **start, steps=150)
    assert together.kinds == (("regular",),)


def test_w_is_what_theory_says_of_an_oscillator_and_0_where_it_is_proved() -> None:
    """A step of lie2 has det J = 1 + h⁴/4 in each plane, and W = (1 + h⁴/4)^N − 1 times Ω."""
    over = found(TWO, "lie2")
    expected = e ** (3000 * 1e-4 / 4) - 1
    assert all(
        float(x or 0) == pytest.approx(expected, rel=0.01) for row in over.defects for x in row
    )
    assert {x for row in found(TWO, "stormer-verlet").defects for x in row} == {"0"}


def test_a_run_of_the_same_start_says_the_same_of_w() -> None:
    over = found(HENON_HEILES, "lie2", across=[Fraction(0)], upwards=[Fraction(1, 10)])
    run = verify.run(
        "henon-heiles", "lie2", q=["0", "0"], p=["0.2", "0.1"], step_size="0.1", steps=3000,
        observables=["symplectic_defect"],
    )  # fmt: skip
    known = float(run.values["symplectic_defect"])
    assert float(over.defects[0][0] or 0) == pytest.approx(known, rel=0.01)


def test_in_the_plane_the_separatrix_of_the_pendulum_parts_what_turns_over() -> None:
    pendulum = systems.get("pendulum").hamiltonian({})
    over = found(
        pendulum, "lie2", axes=("q", "p"), across=[Fraction(1, 10)],
        upwards=[Fraction(1), Fraction(3)], q=Fraction(0), p=Fraction(0), steps=1000,
    )  # fmt: skip
    assert [row[0] for row in over.kinds] == ["regular", "leaves"]
    run = verify.run(pendulum, "lie2", q="0.1", p=1, step_size="0.1", steps=1000)
    known = abs(float(run.values["lambda"]))
    assert float(over.defects[0][0] or 0) == pytest.approx(known, rel=0.01)


@pytest.mark.left_to_ci
def test_where_h_is_not_defined_nothing_is_said() -> None:
    kepler = systems.get("kepler").hamiltonian({"mu": 1})
    over = found(
        kepler, "rk4", axes=("q1", "p2"), across=[Fraction(0), Fraction(1)], upwards=[Fraction(1)],
        p=(Fraction(0), Fraction(0)), steps=1000,
    )  # fmt: skip
    assert over.kinds == (("undecided", "regular"),)
    assert over.energies[0] == (None, "-5.00000e-01")


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"axes": ["q2", "x"]}, "axes=x: is no coordinate; allowed: p1, p2, q1, q2"),
        ({"axes": ["q2", "q2"]}, "axes"),
        ({"across": {"from": 1, "to": 0, "count": 3}}, "from must be less than to"),
        ({"beyond": 0}, "beyond=0: must be greater than 0"),
        ({"steps": 10}, "give one of the two"),
        ({"across": [0] * 2}, "stands twice"),
    ],
)
def test_mistakes_are_told(changes: dict[str, Any], said: str) -> None:
    section = {
        "axes": ["q2", "p2"], "across": [0, "0.1"], "upwards": [0], "time": 1, "step_size": "0.1",
        "initial_value": {"q": [0, 0], "p": [0, 0]}, **changes,
    }  # fmt: skip
    with pytest.raises(InputError, match=said):
        scene_from({"system": "henon-heiles", "schemes": ["rk4"], "orbit_map": [section]}, "mine")
