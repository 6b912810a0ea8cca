"""Runs in n degrees of freedom, held against steps in mpmath that share no code with them.

There J is taken by differences, W as MᵀΩM − Ω from the product M of all J, in 400 digits; so what
the kernels carry without cancellation is seen from the other side.
"""

from collections.abc import Callable
from fractions import Fraction
from functools import cache
from itertools import combinations
from typing import Any

import pytest

from tests.helpers.stepping.steps_in_degrees import (
    Step,
    field,
    implicit_midpoint,
    jacobian,
    lie,
    mp,
    rk4,
    verlet,
)
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.orbit_table import orbit_of
from verify.runs.requested_run import run
from verify.scenes.observables import names
from verify.scenes.results.run import RunResult

HENON = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"
MIXED = "(p1*q2 + p2)**2/2 + q1*q2*exp(p1/2) + q1**2"
ARC = "(p1**2 + p2**2)/2 - 1/sqrt((q1 + 2)**2 + q2**2)"
KEPLER = "(p1**2 + p2**2)/2 - 1/sqrt(q1**2 + q2**2)"
CHAIN = "(p1**2 + p2**2 + p3**2)/2 - cos(q1 - q2) - cos(q2 - q3)*q1"
ENERGIES: dict[str, Callable[..., Any]] = {
    HENON: lambda p1, p2, q1, q2: (p1**2 + p2**2 + q1**2 + q2**2) / 2 + q1**2 * q2 - q2**3 / 3,
    MIXED: lambda p1, p2, q1, q2: (p1 * q2 + p2) ** 2 / 2 + q1 * q2 * mp.exp(p1 / 2) + q1**2,
    ARC: lambda p1, p2, q1, q2: (p1**2 + p2**2) / 2 - 1 / mp.sqrt((q1 + 2) ** 2 + q2**2),
    CHAIN: lambda p1, p2, p3, q1, q2, q3: (
        (p1**2 + p2**2 + p3**2) / 2 - mp.cos(q1 - q2) - mp.cos(q2 - q3) * q1
    ),
}
STEPS: dict[str, Step] = {
    "lie1": lie(1), "lie2": lie(2), "rk4": rk4,
    "stormer-verlet": verlet, "implicit-midpoint": implicit_midpoint,
}  # fmt: skip
SIZE, COUNT = Fraction(1, 20), 5
POINT = [Fraction(n, d) for n, d in ((3, 7), (-2, 5), (1, 8), (4, 9), (-7, 11), (1, 3))]
CASES = [(HENON, "lie1"), (HENON, "lie2"), (MIXED, "lie2"), (ARC, "lie2"), (HENON, "rk4"),
         (CHAIN, "lie1"), (HENON, "stormer-verlet"), (MIXED, "implicit-midpoint")]  # fmt: skip
SEVERAL = names(planar=False)
OF_DEFECT = {*SEVERAL} - {"energy_error_max"}
every_case = pytest.mark.parametrize(("formula", "scheme"), CASES)


def point_of(formula: str) -> list[Fraction]:
    return POINT[: len(Hamiltonian.parse(formula).coordinates)]


def as_mp(x: Fraction) -> Any:
    return mp.mpf(x.numerator) / x.denominator


def form(columns: Any) -> list[Any]:
    """JᵀΩJ − Ω of a Jacobian by columns, its entries above the diagonal."""
    n, found = len(columns) // 2, []
    for a, b in combinations(range(2 * n), 2):
        u, v = columns[a], columns[b]
        both = sum(u[i] * v[n + i] - u[n + i] * v[i] for i in range(n))
        found.append(both - (b == a + n))
    return found


@cache
def true(formula: str, scheme: str) -> dict[str, Any]:
    """The values of the run, to a hundred digits."""
    energy, step, h = ENERGIES[formula], STEPS[scheme], as_mp(SIZE)
    z, f = [as_mp(x) for x in point_of(formula)], field(energy)
    size = len(z)
    total = mp.eye(size)
    lam, mse, top, s_top, lam_top = mp.mpf(1), mp.mpf(0), mp.mpf(0), mp.mpf(0), mp.mpf(0)
    first, energy_top = energy(*z), mp.mpf(0)
    for _ in range(COUNT):
        columns = jacobian(step, energy, z, h)
        own = mp.matrix(size, size)
        for b, column in enumerate(columns):
            for a, x in enumerate(column):
                own[a, b] = x
        change = mp.det(own) - 1
        total, lam, mse = own * total, lam * (1 + change), mse + change**2
        top, s_top = max(top, abs(change)), max(s_top, *map(abs, form(columns)))
        lam_top = max(lam_top, abs(lam - 1))
        z = step(f, z, h)
        energy_top = max(energy_top, abs(energy(*z) - first))
    whole = [[total[a, b] for a in range(size)] for b in range(size)]
    found = dict(zip(Hamiltonian.parse(formula).coordinates, z, strict=True))
    return found | {
        "lambda": lam - 1, "mse": mse / COUNT, "delta_j_max": top, "lambda_max": lam_top,
        "symplectic_defect_max": s_top, "symplectic_defect": max(map(abs, form(whole))),
        "energy_error_max": energy_top,
    }  # fmt: skip


def done(formula: str, scheme: str, name: str, digits: int = 25, **more: Any) -> RunResult:
    point = point_of(formula)
    n = len(point) // 2
    given = {"q": point[n:], "p": point[:n], "step_size": SIZE, "steps": COUNT} | more
    return run(Hamiltonian.parse(formula), scheme, arithmetic=name, digits=digits,
               observables=SEVERAL, **given)  # fmt: skip


@pytest.mark.left_to_ci
@pytest.mark.sample(4)
@every_case
@pytest.mark.parametrize("name", ["float64", "mpfr", "mpmath", "ball", "fixed"])
def test_the_true_values_are_within_the_bounds(formula: str, scheme: str, name: str) -> None:
    found, known = done(formula, scheme, name), true(formula, scheme)
    assert found.status == "finished"
    assert set(found.values) == set(known)
    for key, value in found.values.items():
        gap = abs(as_mp(Fraction(value.value)) - known[key])
        assert gap <= as_mp(Fraction(value.bound)) + mp.mpf(10) ** -50, key
    if name != "float64":
        sure = [n for n, x in found.values.items() if Fraction(x.value)]
        assert all(len(found.values[n].value.strip("-").partition("e")[0]) >= 20 for n in sure)


@pytest.mark.left_to_ci
@pytest.mark.sample(4)
@pytest.mark.parametrize(("formula", "scheme"), [(HENON, "lie2"), (CHAIN, "lie1"), (ARC, "lie2")])
@pytest.mark.parametrize("name", ["mpfr", "fixed"])
def test_bounds_are_rigorous_wherever_the_box_is_clear_of_poles(
    formula: str, scheme: str, name: str
) -> None:
    found = done(formula, scheme, name)
    assert found.error_kind == "enclosed"
    assert "a-posteriori" in found.error_method


def test_where_the_map_is_symplectic_nothing_is_run_for_s() -> None:
    for formula, scheme in [(HENON, "stormer-verlet"), (MIXED, "implicit-midpoint")]:
        found = done(formula, scheme, "mpfr")
        assert set(found.exact) == OF_DEFECT
        assert all(found.values[name].value == "0" for name in OF_DEFECT)


def test_a_map_that_preserves_volume_alone_has_a_defect() -> None:
    """p1 is stretched and p2 shrunk: det J = 1, and S has entries of the size of h."""
    scheme = "p1_next = p1*(1 + h); p2_next = p2/(1 + h); q1_next = q1; q2_next = q2"
    found = run(Hamiltonian.parse(HENON), scheme, q=[1, 2], p=[1, 2], step_size=Fraction(1, 10),
                steps=3, arithmetic="mpfr", digits=20, observables=SEVERAL)  # fmt: skip
    # W is diagonal: (1 + h)³ − 1, and (1 + h)⁻³ − 1.
    assert Fraction(found.values["lambda"].value) == 0
    assert Fraction(found.values["symplectic_defect_max"].value) == Fraction(1, 10)
    assert abs(Fraction(found.values["symplectic_defect"].value) - Fraction(331, 1000)) < 1e-18


def test_one_degree_by_a_number_is_the_plane() -> None:
    asked = {"step_size": "1/50", "steps": 500, "arithmetic": "mpfr", "digits": 25}
    one = run(Hamiltonian.parse("p1**2/2 + q1**4/4"), "lie2", q=["1/2"], p=["1/3"], **asked)  # type: ignore[arg-type]
    plane = run(Hamiltonian.parse("p**2/2 + q**4/4"), "lie2", q="1/2", p="1/3", **asked)  # type: ignore[arg-type]
    for name, value in plane.values.items():
        same = one.values[f"{name}1" if name in ("p", "q") else name]
        assert abs(Fraction(same.value) - Fraction(value.value)) <= 2 * Fraction(value.bound)
    assert one.values["symplectic_defect"].value.strip("-") == plane.values["lambda"].value.strip(
        "-"
    )
    assert one.values["symplectic_defect_max"].value == plane.values["delta_j_max"].value


def test_parts_that_are_not_coupled_are_the_plane_side_by_side() -> None:
    """det J is the product of theirs, and S has their ΔJ on its diagonal blocks."""
    asked = {"step_size": "1/50", "steps": 100, "arithmetic": "mpfr", "digits": 25}
    both = run(Hamiltonian.parse("p1**2/2 + q1**4/4 + p2**2/2 - cos(q2)"), "lie2", q=["1/2", 1],
               p=["1/3", 0], **asked)  # type: ignore[arg-type]  # fmt: skip
    first = run(Hamiltonian.parse("p**2/2 + q**4/4"), "lie2", q="1/2", p="1/3", **asked)  # type: ignore[arg-type]
    other = run(Hamiltonian.parse("p**2/2 - cos(q)"), "lie2", q=1, p=0, **asked)  # type: ignore[arg-type]
    one, two = (Fraction(x.values["lambda"].value) for x in (first, other))
    assert abs(Fraction(both.values["lambda"].value) - ((1 + one) * (1 + two) - 1)) < 1e-24
    assert abs(Fraction(both.values["symplectic_defect"].value) - max(abs(one), abs(two))) < 1e-24


def test_in_time_the_clock_is_the_same() -> None:
    """H(p1, q1) cos²t: held against the plane, which has its own tests in time."""
    asked = {"step_size": "1/50", "steps": 100, "t0": "1/3", "arithmetic": "mpfr", "digits": 25}
    several = Hamiltonian.parse("p1**2/2 + q1**2*cos(t)/2 + p2**2/2 + q2**2/2")
    both = run(several, "lie2", q=["1/2", 0], p=["1/3", 0], **asked)  # type: ignore[arg-type]
    plane = run(Hamiltonian.parse("p**2/2 + q**2*cos(t)/2"), "lie2", q="1/2", p="1/3", **asked)  # type: ignore[arg-type]
    gap = abs(Fraction(both.values["q1"].value) - Fraction(plane.values["q"].value))
    assert gap < Fraction(1, 10**23)
    assert both.values["q2"].value == "0"


@pytest.mark.parametrize(
    ("given", "problem"),
    [
        ({"q": [1], "p": [1, 2]}, "q=1: has 1 of 2 numbers; H is of q1, q2"),
        ({"q": [1, 2], "p": [1, 2, 3]}, "p=1, 2, 3: has 3 of 2 numbers; H is of p1, p2"),
        ({"q": "1", "p": [1, 2]}, "q=1: has 1 of 2 numbers"),
        ({"q": ["x", 2], "p": [1, 2]}, "q1=x"),
    ],
)
def test_lists_of_another_length_are_refused(given: dict[str, Any], problem: str) -> None:
    with pytest.raises(InputError, match=problem):
        run(Hamiltonian.parse(HENON), "lie2", step_size="0.1", steps=3, **given)


def test_what_is_of_too_many_degrees_is_refused_before_anything_runs() -> None:
    formula = " + ".join(f"p{k}**2/2 + q{k}**4" for k in range(1, 6))
    with pytest.raises(InputError, match="symplectic_defect: is for up to 4 degrees of freedom"):
        run(Hamiltonian.parse(formula), "lie2", q=[1] * 5, p=[0] * 5, step_size="0.1", steps=2,
            observables=["symplectic_defect"])  # fmt: skip
    found = run(Hamiltonian.parse(formula), "lie2", q=[1] * 5, p=[0] * 5, step_size="0.1", steps=2)
    assert "symplectic_defect_max" in found.values
    assert "lambda" not in found.values


@pytest.mark.parametrize("name", ["lambda_plain", "delta_j", "symplectic"])
def test_unknown_observables_are_refused(name: str) -> None:
    with pytest.raises(InputError, match="observable"):
        run(Hamiltonian.parse(HENON), "lie2", q=[1, 1], p=[1, 1], step_size="0.1", steps=3,
            observables=[name])  # fmt: skip


def test_in_the_plane_the_defect_is_asked_for_by_its_name_there() -> None:
    with pytest.raises(InputError, match=r"symplectic_defect: is \|lambda\| in one degree"):
        run(Hamiltonian.parse("p**2/2"), "lie2", q=1, p=1, step_size="0.1", steps=3,
            observables=["symplectic_defect"])  # fmt: skip


def test_a_collision_on_the_way_ends_the_run_at_its_step() -> None:
    found = run(Hamiltonian.parse(KEPLER), "lie1", q=[1, 0], p=[-2, 0], step_size="1/2", steps=50,
                arithmetic="mpfr", digits=20)  # fmt: skip
    assert found.status == "left range"
    assert found.failed_step == 2


def test_states_on_the_way_are_those_of_the_run() -> None:
    found = done(HENON, "lie2", "mpfr")
    table = orbit_of(found)
    assert table.columns == ("t", "p1", "p2", "q1", "q2", "energy_error", "delta_j", "lambda",
                             "symplectic_defect")  # fmt: skip
    assert table.p.shape == table.q.shape == (COUNT + 1, 2)
    known = true(HENON, "lie2")
    for name in ("p1", "q2", "lambda", "symplectic_defect"):
        assert abs(as_mp(Fraction(table.texts(name)[-1])) - known[name]) < mp.mpf(10) ** -20
