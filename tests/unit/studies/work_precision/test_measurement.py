"""Error against run time as a whole: run times, comparisons, number systems, peers, bad input."""

from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.constructed.work import work_task
from verify.errors import InputError
from verify.execution.execute import compute_task
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.requested_run import run
from verify.scenes.results.work_precision import WorkPrecisionResult
from verify.studies.work_precision.measurement import _digits_of_state

PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")


def done(**changes: Any) -> WorkPrecisionResult:
    found = compute_task(work_task(**changes))
    assert isinstance(found, WorkPrecisionResult)
    return found


def test_every_finished_point_has_its_run_times_and_the_result_survives_json() -> None:
    found = done()
    for line in found.lines:
        for point in line.points:
            assert point.seconds_min is not None
            assert point.seconds_median is not None
            assert 0 < point.seconds_min <= point.seconds_median
    (compared,) = found.comparisons
    assert (compared.one, compared.other) == ("lie2", "stormer-verlet")
    assert WorkPrecisionResult.model_validate_json(found.model_dump_json()) == found


def test_an_orbit_that_does_not_reach_the_time_is_bad_input() -> None:
    with pytest.raises(InputError, match=r"work_precision\.time=20"):
        done(hamiltonian="p**2/2 - q**4", time=20, step_sizes=("0.5", "0.25"),
             number_systems_step_size="0.5")  # fmt: skip


def test_number_systems_give_the_digits_that_were_asked_for() -> None:
    found = done(
        schemes=("lie2",), step_sizes=("0.1", "0.05"), number_systems=("float64", "mpfr", "ball"),
        digits=(20, 40), number_systems_step_size="0.1",
    ).systems  # fmt: skip
    assert [(s.arithmetic, s.digits) for s in found] == [
        ("float64", 17), ("mpfr", 20), ("mpfr", 40), ("ball", 20), ("ball", 40),
    ]  # fmt: skip
    for system in found:
        assert system.certified is not None
        least = 14 if system.arithmetic == "float64" else system.digits - 1
        assert least < float(system.certified) < system.digits + 1


@pytest.mark.parametrize("name", ["DOP853", "Taylor (heyoka)"])
def test_a_peer_is_held_against_the_same_exact_solution(name: str) -> None:
    pytest.importorskip({"DOP853": "scipy"}.get(name, "heyoka"))
    line = done(schemes=("lie2",), peers=(name,)).lines[-1]
    assert (line.name, line.peer, line.cost) == (name, True, None)
    errors = [float(p.error.value) for p in line.points if p.error]
    assert len(errors) == len(line.points)
    assert errors[-1] < 1e-12 < errors[0] < 1e-1
    assert all(p.step_size is None and p.tolerance and p.limited_by == "tolerance"
               for p in line.points)  # fmt: skip
    assert line.error_slope.value is None


def test_heyoka_takes_numbers_that_are_no_binary_fractions() -> None:
    pytest.importorskip("heyoka")
    found = done(
        hamiltonian="p**2/2 + delta*(1 + q**2)**(1/3)", parameters={"delta": "7/3"},
        schemes=("lie2",), peers=("Taylor (heyoka)",),
    )  # fmt: skip
    last = found.lines[-1].points[-1]
    assert last.error is not None, last.reason
    assert float(last.error.value) < 1e-13


def test_digits_beyond_the_range_of_float_are_told() -> None:
    found = run(
        PENDULUM, "lie2", q=Fraction(1), p=Fraction(0),
        step_size=Fraction(1, 4), steps=4, arithmetic="mpfr", digits=350, observables=(),
    )  # fmt: skip
    digits = _digits_of_state(found)
    assert digits is not None
    assert 345 < float(digits) < 370
