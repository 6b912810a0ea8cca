"""Error against run time in n degrees of freedom: errors, W, orders, and peers beside them."""

from fractions import Fraction
from typing import Any

import pytest

import verify
from verify.hamiltonians.start import point_of
from verify.hamiltonians.systems import get
from verify.kernels.step.computation import step_map_of
from verify.scenes.results.bounded_value import Value
from verify.structures import SYMPLECTIC
from verify.studies.work_precision import peers
from verify.studies.work_precision.lines import error_slope, lambda_slope
from verify.studies.work_precision.runs import Ladder, Problem, reference

HENON, KEPLER = get("henon-heiles").hamiltonian(), get("kepler").hamiltonian({"mu": 1})
START: dict[str, Any] = {"q": [0, "0.1"], "p": ["0.4", 0]}
ELLIPSE: dict[str, Any] = {"q": ["2/5", 0], "p": [0, 2]}


def problem(hamiltonian: Any, at: dict[str, Any], time: int) -> Problem:
    point, length = point_of(hamiltonian, **at), Fraction(time)
    exact = reference(hamiltonian, point, length, Fraction(0))
    return Problem(hamiltonian, point, length, Fraction(0), exact)


def number(value: Value | None) -> Fraction:
    assert value is not None
    return Fraction(value.value)


def test_the_reference_of_kepler_is_its_ellipse() -> None:
    of = problem(KEPLER, ELLIPSE, 3)
    assert "ellipse" in of.solution.method
    (h,) = (Fraction(1, 1000),)
    fine = Ladder(of, "yoshida4").point(h)
    assert number(fine.error) < Fraction(1, 10**6)
    assert number(fine.energy) < Fraction(1, 10**8)


def test_orders_are_those_of_the_schemes_and_w_is_lost_by_what_is_not_symplectic() -> None:
    of = problem(HENON, START, 3)
    for scheme, order, kept in (("lie2", 2, False), ("rk4", 4, False), ("yoshida4", 4, True)):
        ladder = Ladder(of, scheme)
        points = [ladder.point(Fraction(1, n)) for n in (40, 80, 160)]
        assert float(error_slope(points).value or 0) == pytest.approx(order, abs=0.06)
        assert ladder.preserves_area is kept
        assert all((number(point.symplectic_defect) == 0) is kept for point in points)
        of_form = lambda_slope(points, kept, structure=SYMPLECTIC)
        if kept:
            assert of_form.reason == "S ≡ 0 is proved: W is exactly 0"
        else:
            assert float(of_form.value or 0) >= order - 0.2
        assert all(point.lam_plain is None for point in points)


def test_w_is_that_of_a_run() -> None:
    (point,) = (Ladder(problem(HENON, START, 2), "lie2").point(Fraction(1, 10)),)
    run = verify.run(HENON, "lie2", **START, step_size="0.1", steps=20, digits=20)
    exact = Fraction(run.values["symplectic_defect"].value)
    assert abs(number(point.symplectic_defect) - exact) < Fraction(1, 10**12)
    assert abs(number(point.lam) - Fraction(run.values["lambda"].value)) < Fraction(1, 10**12)


def test_a_step_counts_the_operations_of_all_coordinates() -> None:
    of = problem(HENON, START, 1)
    small, chain = Ladder(of, "stormer-verlet").cost, step_map_of(HENON, "stormer-verlet")
    assert small.additions > 2 * chain.hamiltonian.degrees
    assert not small.functions


@pytest.mark.parametrize("name", peers.libraries())
def test_peers_go_to_the_same_place(name: str) -> None:
    pytest.importorskip(peers.libraries()[name])
    for hamiltonian, at in ((HENON, START), (KEPLER, ELLIPSE)):
        of = problem(hamiltonian, at, 3)
        found = peers.get(name).make(of, Fraction(1, 10**12)).solve()
        error, _ = of.error(tuple(map(Fraction, found.state)))
        assert error < Fraction(1, 10**9)
        turned = tuple(map(Fraction, reversed(found.state)))
        assert of.error(turned)[0] > Fraction(1, 10)
