"""What is run, proved and separated of a scene, and what the page says of it."""

from dataclasses import dataclass

import pytest

from verify.claims.verdicts import make_report
from verify.execution import execute
from verify.execution.executors import THIS_PROCESS
from verify.pages.page import render
from verify.scenes.results.report import Report
from verify.scenes.scene import scene_from_toml


@dataclass(frozen=True)
class Example:
    """A scene, and what is known of it by hand."""

    hamiltonian: str
    start: str
    q: object
    observables: frozenset[str]
    leading: str
    entries: dict[str, str]
    quantifier: str
    says: tuple[str, ...]
    says_not: str
    separated: str  # the fields that are of what is separated begin so
    says_separated: tuple[str, ...]

    def report(self, separate: bool) -> Report:
        text = HEAD + GRID + ("separate = true" + SEPARATION if separate else SERIES)
        text = text.replace("HAMILTONIAN", self.hamiltonian).replace("START", self.start)
        return make_report(
            "Mine", [scene_from_toml(text, "mine")], [], execute.Store(None), command="test",
            where=THIS_PROCESS,
        )  # fmt: skip


HEAD = """
name = "mine"
title = "Mine"
hamiltonian = "HAMILTONIAN"
schemes = ["lie2", "stormer-verlet"]
every_hamiltonian = true
"""
GRID = """
[grid]
steps = 60
step_sizes = [0.1, 0.05]
initial_values = [START]
digits = 20
"""
SEPARATION = """
[[separation]]
step_sizes = [0.1, 0.05]
steps = 30
initial_value = START
"""
SERIES = """
[[series]]
step_size = 0.1
initial_value = START
steps = 50
"""
EXAMPLES = {
    "plane": Example(
        "p**2/2 + q**2/2 + q**3/3", "{ q = 0.3, p = 0.1 }", "0.3",
        frozenset({"p", "q", "delta_j_max", "mse", "lambda"}),
        "p", {}, "every smooth H",
        ("Is area preserved?", "max |ΔJ|", "the map preserves area exactly",
         "ΔJ of lie2 is of order h³; stormer-verlet preserves area exactly"),
        "Is the symplectic form preserved?",
        "", ("Truncation against rounding", "the rounding in Λ is below truncation"),
    ),
    "degrees": Example(
        "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3",
        "{ q = [0.3, -0.1], p = [0.1, 0.2] }", ("0.3", "-0.1"),
        frozenset({"p1", "p2", "q1", "q2", "symplectic_defect_max", "symplectic_defect", "lambda",
                   "mse", "delta_j_max"}),
        "(p2)*dp1∧dq1 + (p1)*dp1∧dq2 + (p1)*dp2∧dq1 + (-p2)*dp2∧dq2",
        {"dp1∧dq1": "p2", "dp1∧dq2": "p1", "dp2∧dq1": "p1", "dp2∧dq2": "-p2"},
        "in 2 degrees of freedom",
        ("Is the symplectic form preserved?", "dp1∧dq1", "max |W|",
         "S of lie2 is of order h³; stormer-verlet is symplectic."),
        "Is area preserved?",
        "form_", ("Truncation against rounding in W", "‖∧²M‖", "measured, not proved"),
    ),
}  # fmt: skip


@pytest.fixture(scope="module", params=EXAMPLES.values(), ids=EXAMPLES)
def example(request: pytest.FixtureRequest) -> Example:
    return request.param


@pytest.fixture(scope="module")
def report(example: Example) -> Report:
    return example.report(separate=False)


def test_runs_are_of_what_is_not_symplectic_and_carry_its_errors(
    example: Example, report: Report
) -> None:
    (scene,) = report.scenes
    assert [run.q for run in scene.runs] == [example.q] * 2
    for run in scene.runs:
        assert run.scheme == "lie2"
        assert set(run.values) == example.observables
        assert run.error_kind == "enclosed"


def test_what_is_proved_is_of_this_h_and_of_every_h(example: Example, report: Report) -> None:
    lie, verlet = report.scenes[0].proofs
    assert (lie.order, lie.leading, lie.area_preserving) == (3, example.leading, False)
    assert verlet.area_preserving is True
    assert (lie.form is None) == (verlet.form is None) == (not example.entries)
    if lie.form is not None and verlet.form is not None:
        assert (lie.form.volume_order, lie.form.symplectic) == (4, False)
        assert dict(lie.form.entries) == example.entries
        assert verlet.form.symplectic is True
    every, _ = report.scenes[0].every
    assert (every.degrees, every.order) == (2 if example.entries else 1, 3)
    assert every.quantifier.endswith(example.quantifier)


def test_the_page_speaks_of_area_or_of_the_symplectic_form(
    example: Example, report: Report
) -> None:
    shown = render(report)
    for words in example.says:
        assert words in shown, words
    assert example.says_not not in shown


def test_lambda_is_separated_in_the_plane_and_else_w(example: Example) -> None:
    everything = example.report(separate=True)
    (scene,) = everything.scenes
    results = {name: getattr(scene, name) for name in (
        "separations", "crossovers", "form_separations", "form_crossovers",
    )}  # fmt: skip
    names = {f"{example.separated}separations", f"{example.separated}crossovers"}
    assert {name for name, values in results.items() if values} == names
    for name in names:
        (grid,) = results[name]
        assert [point.scheme for point in grid.points] == ["lie2"] * 2
    left_out = [what for what, _ in everything.left_out]
    assert any("separated from rounding for stormer-verlet" in what for what in left_out)
    again = Report.model_validate_json(everything.model_dump_json())
    assert {name: getattr(again.scenes[0], name) for name in results} == results
    shown = render(everything)
    for words in example.says_separated:
        assert words in shown, words
