"""Linear stability at an equilibrium in n degrees of freedom, against formulas and against runs."""

import math
from fractions import Fraction
from typing import Any

import flint
import numpy as np
import pytest

from verify import arithmetic as number_systems
from verify.errors import InputError
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun
from verify.studies.stability.equilibrium import LinearAtEquilibrium, linear_at_equilibrium
from verify.studies.stability.step_matrix import stays_bounded, step_matrix

COUPLED = Hamiltonian.parse("(p1**2 + p2**2 + q1**2 + q2**2)/2 + 2*(q1 - q2)**2")  # ω = 1 and 3
TRAP = systems.get("magnetic").hamiltonian({"b": "3/2", "k": 1, "c": 1})  # ω = 1/2 and 2
HENON_HEILES = systems.get("henon-heiles").hamiltonian({})


def chain(n: int) -> Hamiltonian:
    return systems.get("fput").hamiltonian({"n": n, "alpha": "1/4", "beta": "1/2"})


def at(hamiltonian: Hamiltonian, scheme: str, *sizes: str, **point: int) -> LinearAtEquilibrium:
    origin = dict.fromkeys(hamiltonian.coordinates, Fraction(0))
    given = origin | {name: Fraction(x) for name, x in point.items()}
    return linear_at_equilibrium(hamiltonian, scheme, given, [Fraction(h) for h in sizes])


@pytest.mark.parametrize("n", [2, 3, 8])
def test_the_normal_frequencies_of_a_chain_are_the_known_ones(n: int) -> None:
    found = at(chain(n), "stormer-verlet")
    known = [2 * math.sin(k * math.pi / (2 * (n + 1))) for k in range(1, n + 1)]
    assert [float(f.decimal()) for f in found.frequencies] == pytest.approx(known, rel=1e-14)
    assert found.oscillates
    assert float(found.step_size or 0) == pytest.approx(2 / known[-1], rel=1e-14)


def test_a_field_across_the_plane_parts_two_equal_frequencies() -> None:
    found = at(TRAP, "rk4", "1")
    assert [f.exact for f in found.frequencies] == ["1/2", "2"]
    assert found.interval is None  # T and V are coupled
    assert [f.multiplicity for f in at(HENON_HEILES, "rk4").frequencies] == [2]


@pytest.mark.parametrize(
    ("scheme", "limit"),
    [
        ("stormer-verlet", "2/3"),
        ("rk4", "2*sqrt(2)/3"),
        ("lie3", "sqrt(3)/3"),
        ("lie2", ""),
        ("implicit-midpoint", ""),
    ],
)
def test_the_matrix_of_a_step_says_the_same_as_the_interval(scheme: str, limit: str) -> None:
    """The matrix is not asked where the interval allows h; here it is for both sides of the end."""
    from verify.studies.stability import equilibrium as module

    found = at(COUPLED, scheme)
    assert found.step_size_exact == limit
    point = dict.fromkeys(COUPLED.coordinates, Fraction(0))
    hessian = module.hessian_at(COUPLED, point)
    end = math.inf if found.step_size == "infinite" else float(found.step_size or 0)
    for h in (Fraction(k, 100) for k in (1, 10, 50, 57, 58, 66, 67, 94, 95, 150)):
        step = step_matrix(scheme, COUPLED, module._field_matrix(hessian), h)
        assert step is not None
        assert stays_bounded(step) is (float(h) < end), h


@pytest.mark.parametrize(("part", "stays"), [("99/100", True), ("101/100", False)])
@pytest.mark.parametrize("scheme", ["stormer-verlet", "rk4"])
def test_runs_of_the_linear_chain_stay_below_the_limit_and_leave_above(
    scheme: str, part: str, stays: bool
) -> None:
    linear = systems.get("fput").hamiltonian({"n": 3, "alpha": 0, "beta": 0})
    h = Fraction(part) * Fraction(at(linear, scheme).step_size or 0).limit_denominator(10**6)
    start = dict.fromkeys(linear.coordinates, Fraction(0)) | {"q1": Fraction(1, 100)}
    run = KernelRun(linear, scheme, {**start, "h": h, "t": Fraction(0)}, 600, frozenset(), 0)
    outcome = run.run(number_systems.get("fixed", 30))
    far = max(abs(outcome.values[name]) for name in linear.coordinates)
    assert (outcome.done == 600 and far < Fraction(1, 10)) is stays


def test_where_t_and_v_are_coupled_a_step_size_decides() -> None:
    found = at(TRAP, "rk4", "1.2", "1.5")
    assert list(found.decided.values()) == [True, False]
    with pytest.raises(InputError, match="step_sizes: is needed"):
        at(TRAP, "rk4")
    assert list(at(TRAP, "gauss4", "1").decided.values()) == [None]  # √3 in its coefficients


def test_on_a_saddle_no_step_stays_bounded() -> None:
    found = at(HENON_HEILES, "rk4", "0.1", q2=1)
    assert (found.oscillates, list(found.decided.values())) == (False, [False])
    assert [f.exact for f in found.frequencies] == ["sqrt(3)"]


@pytest.mark.parametrize(
    "formula",
    [
        "(p1**2 + p2**2 + q1**2)/2 + q2**4",
        "(p1**2 + p2**2 + q2**2)/2 + q1**4",
        "(p1**2 + p2**2)/2 + (q1 - q2)**2",
        "(p1**2 + q1**2 + q2**2)/2 + p2**4",
        "(p1**2 + p2**2 + p3**2)/2 + (q1 - q2)**2 + (q2 - q3)**2",
    ],
)
def test_where_a_coordinate_is_free_there_is_no_interval_and_no_step_stays_bounded(
    formula: str,
) -> None:
    """What moves evenly goes on: a quadratic part that is ≥ 0 alone is no sum of oscillators."""
    free = Hamiltonian.parse(formula)
    found = at(free, "stormer-verlet", "1/2")
    assert (found.interval, found.step_size, found.oscillates) == (None, None, False)
    assert list(found.decided.values()) == [False]
    with pytest.raises(InputError, match="step_sizes: is needed"):
        at(free, "stormer-verlet")


@pytest.mark.parametrize(
    ("rows", "stays"),
    [
        ([["3/5", "-4/5"], ["4/5", "3/5"]], True),
        ([["1", "1"], ["0", "1"]], False),  # a shear
        ([["-1", "0"], ["0", "-1"]], True),
        ([["-1", "1"], ["0", "-1"]], False),
        ([["1/2", "9"], ["0", "1/2"]], True),
        ([["2", "0"], ["0", "1/2"]], False),
        ([["101/100", "0"], ["0", "1/2"]], False),
    ],
)
def test_powers_of_known_matrices(rows: list[list[str]], stays: bool) -> None:
    entries = [flint.fmpq(*Fraction(x).as_integer_ratio()) for row in rows for x in row]
    assert stays_bounded(flint.fmpq_mat(2, 2, entries)) is stays


def test_powers_of_drawn_matrices_are_what_their_eigenvalues_say() -> None:
    random = np.random.default_rng(5)
    seen = set()
    for _ in range(40):
        entries = random.integers(-4, 5, (4, 4))
        greatest = abs(np.linalg.eigvals(entries / 7)).max()
        exact = flint.fmpq_mat(4, 4, [flint.fmpq(int(x), 7) for x in entries.ravel()])
        if abs(greatest - 1) < 1e-6:
            continue  # of size 1, which float64 does not tell
        assert stays_bounded(exact) is bool(greatest < 1)
        seen.add(bool(greatest < 1))
    assert seen == {True, False}


@pytest.mark.parametrize(
    ("hamiltonian", "point", "said"),
    [
        (HENON_HEILES, {"q2": 2}, "is no equilibrium: ∂H/∂q2 = -2 there"),
        (systems.get("kepler").hamiltonian({"mu": 1}), {}, "H is not smooth there"),
        (Hamiltonian.parse("p1**2/2 + p2**2/2 + sqrt(2)*q1**2 + q2**2"), {}, "not rational"),
        (Hamiltonian.parse("p1**2/2 + p2**2/2 + k*q1**2 + q2**2"), {}, "parameter=k: has no value"),
        (Hamiltonian.parse("p1**2/2 + p2**2/2 + q1**2*cos(t) + q2**2"), {}, "depends on t"),
    ],
)
def test_what_it_does_not_take_is_told(
    hamiltonian: Hamiltonian, point: dict[str, Any], said: str
) -> None:
    with pytest.raises(InputError) as told:
        at(hamiltonian, "rk4", **point)
    assert said in str(told.value)
