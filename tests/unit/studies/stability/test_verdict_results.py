"""The largest step with bounded motion, the map of step size and stiffness, sensitive motion."""

from fractions import Fraction
from typing import Any

import pytest

import verify
from verify.flows.exact_orbit import exact_orbit
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.studies.stability.verdict_results import largest_step, linear_limit, stability_map

ONE, NONE = Fraction(1), Fraction(0)
HARMONIC = Hamiltonian.parse("p**2/2 + w**2*q**2/2", {"w": "3"})
DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + d*q**4/4", {"d": "1"})
# Masses 1 with springs 1 and 4, whose normal frequencies are 1 and 3.
COUPLED = Hamiltonian.parse("(p1**2 + p2**2 + q1**2 + q2**2)/2 + k*(q1 - q2)**2", {"k": "2"})
HENON_HEILES = systems.get("henon-heiles").hamiltonian({})
PLANE: dict[str, Any] = {"p": NONE, "q": ONE}
DEGREES: dict[str, Any] = {"p": (NONE, NONE), "q": (ONE, NONE)}


LIMITS = {
    "lie3": 3**0.5, "lie4": 8**0.5, "symplectic-euler": 2, "stormer-verlet": 2, "rk4": 8**0.5,
}  # fmt: skip


@pytest.mark.left_to_ci
@pytest.mark.parametrize(
    ("h", "scheme", "start", "time"),
    [
        *(
            pytest.param(HARMONIC, scheme, PLANE, 100, id=f"plane-{scheme}",
                         marks=pytest.mark.sample(3)) for scheme in LIMITS
        ),
        pytest.param(COUPLED, "stormer-verlet", DEGREES, 80, id="degrees-stormer-verlet"),
        pytest.param(COUPLED, "rk4", DEGREES, 80, id="degrees-rk4"),
    ],
)  # fmt: skip
def test_on_a_linear_problem_the_largest_step_is_that_of_its_fastest_mode(
    h: Hamiltonian, scheme: str, start: dict[str, Any], time: int
) -> None:
    largest = largest_step(h, scheme, **start, time=Fraction(time))
    assert largest.q == ("1" if h.planar else ("1", "0"))
    assert largest.linear is not None
    assert largest.bounded is not None
    assert largest.unbounded is not None
    bounded, unbounded, linear = map(Fraction, (largest.bounded, largest.unbounded, largest.linear))
    assert float(linear) == pytest.approx(LIMITS[scheme] / 3, rel=1e-3)
    assert 1 < unbounded / bounded < Fraction(1002, 1000)
    assert abs(bounded / linear - 1) < Fraction(1, 50)


@pytest.mark.parametrize(
    ("h", "scheme", "start", "times"),
    [(HARMONIC, "lie2", PLANE, (30, 300)), (COUPLED, "euler", DEGREES, (5, 20))],
    ids=["plane", "degrees"],
)
def test_where_linear_theory_allows_no_step_it_is_the_time_that_decides(
    h: Hamiltonian, scheme: str, start: dict[str, Any], times: tuple[int, int]
) -> None:
    short, long = (largest_step(h, scheme, **start, time=Fraction(time)) for time in times)
    assert short.linear == long.linear == "0"
    assert short.bounded is not None
    assert long.bounded is not None
    assert Fraction(long.bounded) < Fraction(short.bounded)


def test_near_an_equilibrium_of_a_nonlinear_problem_linear_theory_holds() -> None:
    found = largest_step(
        DUFFING, "stormer-verlet", p=NONE, q=Fraction(1, 10**4), time=Fraction(300)
    )
    assert found.bounded is not None
    assert abs(Fraction(found.bounded) - 2) < Fraction(1, 20)


REGULAR: dict[str, Any] = {"q": (NONE, Fraction(1, 10)), "p": (Fraction(2, 5), NONE)}


@pytest.mark.left_to_ci
def test_criteria_beside_the_bounds_make_the_step_smaller_where_they_are_not_kept() -> None:
    """A symplectic scheme keeps the form at every step size; its energy error is of order 2."""
    most, finer = Fraction(1, 100), Fraction(1, 400)
    run: dict[str, Any] = {**REGULAR, "time": Fraction(15)}
    plain = largest_step(HENON_HEILES, "stormer-verlet", **run)
    of_form = largest_step(HENON_HEILES, "stormer-verlet", **run, symplectic_defect=most)
    one, four = (
        largest_step(HENON_HEILES, "stormer-verlet", **run, energy_error=x) for x in (most, finer)
    )
    assert of_form.bounded == plain.bounded
    assert plain.bounded is not None
    assert one.bounded is not None
    assert four.bounded is not None
    assert float(one.bounded) < float(plain.bounded) / 2
    assert float(one.bounded) / float(four.bounded) == pytest.approx(2, rel=0.1)
    lie2 = largest_step(HENON_HEILES, "lie2", **run, symplectic_defect=most)
    free = largest_step(HENON_HEILES, "lie2", **run)
    assert lie2.bounded is not None
    assert free.bounded is not None
    assert float(lie2.bounded) < float(free.bounded) / 4


@pytest.mark.parametrize(
    ("formula", "start", "time", "said"),
    [
        ("p**2/2 + q**2/2 - q**3/3", PLANE | {"q": Fraction(3, 2)}, 10, "blows up at t = 3.14159"),
        ("(p1**2 + p2**2 - q1**2 - q2**2)/2", DEGREES, 40, "is 1e+06 times as far out as z0"),
    ],
    ids=["plane", "degrees"],
)
def test_an_exact_solution_that_leaves_has_no_largest_step(
    formula: str, start: dict[str, Any], time: int, said: str
) -> None:
    found = largest_step(Hamiltonian.parse(formula), "rk4", **start, time=Fraction(time))
    assert (found.bounded, found.unbounded) == (None, None)
    assert str(found.detail).startswith(f"the exact solution {said}")


def test_what_never_fails_is_told() -> None:
    free = Hamiltonian.parse("p**2/2")
    found = largest_step(free, "lie2", p=ONE, q=NONE, time=Fraction(10))
    assert found.unbounded is None
    assert found.detail == "bounded with every step size looked at"


def test_the_limit_of_a_scheme_that_linear_theory_does_not_know_is_none() -> None:
    assert linear_limit("p_next = p - h*q**3; q_next = q + h*p_next") is None
    assert linear_limit("stormer-verlet") == 2


def test_the_greatest_frequency_is_that_at_the_stiffest_point() -> None:
    orbit = exact_orbit(DUFFING, NONE, Fraction(5), Fraction(1))
    assert abs(float(orbit.frequency) - 76**0.5) < 1e-12  # 1 + 3 q² at q = 5


@pytest.mark.parametrize(
    ("h", "parameter", "values", "limits", "sizes", "steps", "start"),
    [
        pytest.param(
            HARMONIC, "w", [1, 10, 100], [2, 0.2, 0.02],
            ["0.019", "0.021", "0.19", "0.21", "1.9", "2.1"], 800, PLANE, id="plane",
        ),
        pytest.param(  # of frequencies 1 and 1, 1 and √17
            COUPLED, "k", [0, 4], [2, 2 / 17**0.5], ["0.47", "0.5", "1.95", "2.05"], 60, DEGREES,
            id="degrees", marks=pytest.mark.left_to_ci,
        ),
    ],
)  # fmt: skip
def test_the_map_turns_at_the_line_of_linear_theory(
    h: Hamiltonian, parameter: str, values: list[int], limits: list[float], sizes: list[str],
    steps: int, start: dict[str, Any],
) -> None:  # fmt: skip
    over = stability_map(
        h, "stormer-verlet", parameter=parameter, values=[Fraction(x) for x in values],
        step_sizes=[Fraction(x) for x in sizes], steps=steps, **start,
    )  # fmt: skip
    for limit, linear, row in zip(limits, over.linear, over.cells, strict=True):
        assert linear is not None
        assert linear == f"{limit:.3e}"
        expected = ["stable" if float(x) < limit else "unstable: scheme" for x in sizes]
        assert [cell.kind for cell in row] == expected


# -- in two degrees of freedom --------------------------------------------------------------------


@pytest.mark.left_to_ci
def test_chaos_of_the_exact_solution_is_nobodys_fault() -> None:
    """float64 parts from high precision: so do exact neighbours, without any rounding."""
    (chaotic,) = verify.stability(
        "henon-heiles", "stormer-verlet", q=[0, "-0.1"], p=["0.5", "0.2"], step_size="0.1", time=320
    )  # of energy 0.1503
    assert chaotic.kind == "sensitive"
    assert chaotic.lyapunov is not None
    assert 0.05 < float(chaotic.lyapunov) < 0.2
    assert "float64 parts at step" in str(chaotic.detail)


def test_a_regular_motion_in_two_degrees_is_told_as_one() -> None:
    (regular,) = verify.stability(
        "henon-heiles", "stormer-verlet", q=[0, "0.1"], p=["0.4", 0], step_size="0.1", time=60
    )
    assert (regular.kind, regular.q) == ("stable", ("0", "0.1"))
    assert "no faster than a power of t" in str(regular.exact_orbit)
