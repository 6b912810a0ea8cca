"""What a separation reports: frozen results, grids, runs that blow up, bad input."""

import re
from fractions import Fraction
from statistics import median
from typing import Any

import pytest

from verify.errors import InputError
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.requested_run import run
from verify.scenes.results.separation import SeparationGrid
from verify.studies.separation.truncation_and_rounding import count_steps, separate, separate_grid

DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4", {"delta": 1})
PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
HENON = systems.get("henon-heiles").hamiltonian({})
AT = {"q": "1.5", "p": "1/3", "step_size": "0.001"}
SIZES = ["0.0005", "0.001", "0.002", "0.005"]


def test_a_result_survives_json_and_is_frozen() -> None:
    grid = separate_grid(DUFFING, "lie2", q="1.5", p=0, step_sizes=["0.1", "0.2"], time=3)
    assert SeparationGrid.model_validate_json(grid.model_dump_json()) == grid
    assert [point.steps for point in grid.points] == [30, 15]
    with pytest.raises(ValueError, match="frozen"):
        grid.points[0].steps = 3  # type: ignore[misc]


LEAVING: dict[str, tuple[Hamiltonian, str, Any, Any, Any, int, int]] = {
    "an escape": (Hamiltonian.parse("p**2/2 - q**4"), "lie2", "1.5", 0, 1, 90, 6),
    "a start beyond float64": (PENDULUM, "lie2", "1e400", 0, 1, 9, 1),
    "no real power": (Hamiltonian.parse("p**2/2 + q**(3/2)"), "lie2", "-1", 0, 1, 9, 1),
    "henon-heiles": (HENON, "lie2", ["0.9", "0.9"], ["0.1", "0.2"], "0.05", 2000, 121),
    "no solution": (
        Hamiltonian.parse("p1**2/2 + p2**2/2 - q1**4/4 - q2**4"),
        "implicit-midpoint", [3, 3], [3, 3], "0.5", 100, 1,
    ),
}  # fmt: skip


@pytest.mark.parametrize(
    ("hamiltonian", "scheme", "q", "p", "h", "steps", "failed_step"), LEAVING.values(), ids=LEAVING
)
def test_a_run_that_leaves_the_range_says_at_which_step_as_it_does_alone(
    hamiltonian: Hamiltonian, scheme: str, q: Any, p: Any, h: Any, steps: int, failed_step: int
) -> None:
    at = {"q": q, "p": p, "step_size": h}
    left = separate(hamiltonian, scheme, **at, steps=steps)
    assert (left.status, left.failed_step, left.plain) == ("left range", failed_step, None)
    observed = "lambda" if hamiltonian.planar else "symplectic_defect"
    alone = run(hamiltonian, scheme, **at, steps=steps, observables=(observed,))
    assert alone.failed_step == failed_step
    if failed_step > 1:
        assert separate(hamiltonian, scheme, **at, steps=failed_step - 1).status == "finished"


def test_the_closed_form_is_left_out_where_a_determinant_is_negative() -> None:
    found = separate(PENDULUM, "lie2", q="1.5", p=0, step_size="1.7", steps=20)
    assert found.status == "finished"
    assert found.plain is not None
    assert found.closed_form is None


PLANE: dict[str, Any] = {"hamiltonian": DUFFING, **AT}
DEGREES: dict[str, Any] = {
    "hamiltonian": HENON, "q": ["0.3", "-0.1"], "p": ["0.1", "0.2"], "step_size": "0.1",
}  # fmt: skip
FIVE: dict[str, Any] = {
    "hamiltonian": systems.get("fput").hamiltonian({"n": 5, "alpha": 1, "beta": 1}),
    "q": [0] * 5, "p": [1] * 5, "step_size": "0.1",
}  # fmt: skip
BAD: dict[str, tuple[dict[str, Any], str]] = {
    "h": (PLANE | {"step_size": 0}, "step_size=0"),
    "steps": (PLANE | {"steps": 0}, "steps=0"),
    "digits": (PLANE | {"digits": 0}, "digits=0"),
    "float64": (PLANE | {"arithmetic": "float64"}, "arithmetic=float64: is what is examined"),
    "arithmetic": (PLANE | {"arithmetic": "decimal"}, "arithmetic=decimal: unknown"),
    "q": (PLANE | {"q": "nan"}, "q=nan"),
    "degrees-h": (DEGREES | {"step_size": 0}, "step_size=0"),
    "degrees-steps": (DEGREES | {"steps": 0}, "steps=0"),
    "degrees-float64": (DEGREES | {"arithmetic": "float64"}, "is what is examined"),
    "degrees-q": (DEGREES | {"q": ["0.3"]}, "has 1 of 2 numbers"),
    "five-degrees": (FIVE, "is for up to 4 degrees of freedom"),
}


@pytest.mark.parametrize(("arguments", "named"), BAD.values(), ids=BAD)
def test_bad_input_is_named_in_one_line_before_anything_runs(
    arguments: dict[str, Any], named: str
) -> None:
    with pytest.raises(InputError, match=re.escape(named)) as error:
        separate(**{"scheme": "lie2", "steps": 10, **arguments})
    assert "\n" not in str(error.value)


GRIDS: dict[str, tuple[dict[str, Any], str]] = {
    "both": ({"steps": 3, "time": 1}, "steps, time: give one"),
    "neither": ({}, "steps, time: give one"),
    "none": ({"step_sizes": [], "steps": 3}, "step_sizes="),
    "twice": ({"step_sizes": ["0.001", "1/1000"], "steps": 3}, "step_size=1/1000: is given twice"),
    "short": ({"time": "0.004"}, "time=0.004: is shorter than the step size 0.005"),
    "long": ({"time": "1e20"}, "steps="),
}


@pytest.mark.parametrize(("changes", "named"), GRIDS.values(), ids=GRIDS)
def test_a_bad_grid_is_named_before_anything_runs(changes: dict[str, Any], named: str) -> None:
    with pytest.raises(InputError, match=re.escape(named)):
        separate_grid(DUFFING, "lie2", q=1, p=0, **{"step_sizes": SIZES, **changes})


def test_the_number_of_steps_is_exact_where_h_divides_the_time() -> None:
    sizes = [Fraction(1, 10), "0.001", "0.3"]
    assert [count for _, count in count_steps(sizes, None, "0.7")] == [7, 700, 2]


@pytest.mark.left_to_ci
def test_the_crossover_of_lie4_on_duffing_lies_where_its_parts_are_equal() -> None:
    found = separate_grid(DUFFING, "lie4", q="1.5", p=0, step_sizes=SIZES, time=6)
    assert found.plain.bracket == ("0.0005", "0.001")
    assert found.plain.step_size is not None
    # What is rounded is another number at each step size: near by, it is as large in the mean.
    ratios = []
    for part in (0.9, 0.95, 1.0, 1.05, 1.1):
        h = round(part * float(found.plain.step_size), 9)
        at = separate(DUFFING, "lie4", q="1.5", p=0, step_size=str(h), steps=int(6 / h))
        assert at.plain is not None
        ratios.append(float(at.plain.largest["truncation"]) / float(at.plain.largest["total"]))
    assert 0.5 < median(ratios) < 2
    assert found.closed_form.step_size is None
    assert found.closed_form.reason.startswith("none in this range: truncation is larger")


def test_runs_that_end_early_are_left_out_of_the_crossover() -> None:
    found = separate_grid(
        Hamiltonian.parse("p**2/2 - q**4"), "lie2", q="1.5", p=0, step_sizes=[1, 2], steps=90
    )
    assert {point.status for point in found.points} == {"left range"}
    assert (found.plain.step_size, found.plain.bracket) == (None, None)
