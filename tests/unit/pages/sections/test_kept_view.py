"""The section on what is kept: schemes by structures, details, runs, H − H₀ over time."""

from pathlib import Path

import pytest

from tests.helpers.constructed.scenes import load
from verify.claims.verdicts import make_report
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.pages.markdown import page as markdown
from verify.pages.page import render
from verify.pages.sections.scene.kept import SECTION, KeptView
from verify.pages.sections.scheme import series
from verify.scenes.results.report import Report

PENDULUM = """
system = "pendulum"
schemes = ["lie2", "stormer-verlet"]
keeps = ["area", "energy: 3", "reversible"]
[grid]
time = 2
step_sizes = [0.1, 0.05]
initial_values = [{ q = 1.5, p = 0 }]
[[series]]
time = 2
step_size = 0.1
initial_value = { q = 1.5, p = 0 }
"""
PREY = """
field = "u_dot = u*(v - a); v_dot = v*(1 - u)"
parameters = { a = 2 }
schemes = ["rk4"]
[keeps]
structures = ["2*log(v) - v + log(u) - u: 3"]
form = "du^dv/(u*v)"
"""


def report_of(folder: Path, content: str) -> Report:
    scene = load(folder, content)
    return make_report("x", [scene], (), Store(None), command="x", where=THIS_PROCESS)


@pytest.fixture(scope="module")
def pendulum(tmp_path_factory: pytest.TempPathFactory) -> Report:
    return report_of(tmp_path_factory.mktemp("scene"), PENDULUM)


def view_of(report: Report) -> KeptView:
    view = SECTION.view(report.scenes[0], "x")
    assert isinstance(view, KeptView)
    return view


def test_schemes_stand_by_structures(pendulum: Report) -> None:
    view = view_of(pendulum)
    assert view.structures == ("area", "energy", "reversible by p ↦ −p")
    marks = {each.result.scheme: [row.mark for row in each.rows] for each in view.schemes}
    assert marks == {"lie2": ["h³", "h³", "h⁴"], "stormer-verlet": ["✓", "h³", "✓"]}


def test_what_is_not_decided_has_a_question_mark(pendulum: Report) -> None:
    scene = pendulum.scenes[0]
    first = scene.keeps[0]
    open_one = first.keeps[0].model_copy(update={"exact": None, "order": None})
    kept = first.model_copy(update={"keeps": (open_one, *first.keeps[1:])})
    changed = pendulum.model_copy(
        update={"scenes": (scene.model_copy(update={"keeps": (kept, *scene.keeps[1:])}),)}
    )
    assert view_of(changed).schemes[0].rows[0].mark == "?"
    assert "not decided" in render(changed)


def test_runs_say_what_has_accumulated_and_a_proof_says_nothing_has(pendulum: Report) -> None:
    lie2, verlet = view_of(pendulum).schemes
    (greatest,) = {
        run.values["energy_error_max"].value
        for run in pendulum.scenes[0].runs
        if (run.scheme, run.step_size) == ("lie2", "0.1")
    }
    assert lie2.rows[1].accumulated.startswith(f"max |H − H₀|: {float(greatest):.3e}"[:19])
    assert "h\xa0=\xa00.1, N\xa0=\xa020: enclosed" in lie2.rows[1].accumulated
    assert lie2.rows[0].accumulated.startswith("Λ: ")
    assert [row.accumulated for row in verlet.rows[::2]] == ["0, proved"] * 2
    assert verlet.rows[1].accumulated.startswith("max |H − H₀|: ")
    assert lie2.rows[2].accumulated == "–"


def test_the_energy_is_drawn_for_each_scheme_and_a_zero_line_for_none(pendulum: Report) -> None:
    (plot,) = view_of(pendulum).plots
    assert "H − H₀ over time, h = 0.1" in plot.lead
    assert all(f"H − H₀, {name}" in plot.svg for name in ("lie2", "stormer-verlet"))
    scene = pendulum.scenes[0]
    lie2, verlet = (series.SECTION.view(scene, proof, "x") for proof in scene.proofs)
    assert (len(lie2), len(verlet)) == (1, 0)


def test_the_page_and_markdown_have_the_same_section(pendulum: Report) -> None:
    page, (text, figures) = render(pendulum), markdown.render(pendulum)
    for said in ("What is kept", "meant to be 0", "agrees with the exact flow"):
        assert said in page
    assert "| <code>stormer-verlet</code> | ✓ | h³ | ✓ |" in text
    assert "Of 6 statements on what steps keep: 4 proved and 2 refuted." in text
    assert any("H − H₀, lie2" in svg for svg in figures.values())


def test_equations_without_an_h_have_a_page(tmp_path: Path) -> None:
    report = report_of(tmp_path, PREY)
    page, (text, figures) = render(report), markdown.render(report)
    assert "u\u0307" in page
    assert r"\dot{u}=u\,(v-a)" in text
    assert "Without a value" not in page
    assert "the integral 2*log(v)" in page
    assert "the form du^dv/(u*v)" in page
    assert "The report holds no claim" not in page
    assert not figures
    # One scheme needs no table of schemes.
    assert "What each scheme keeps" not in page


def test_a_scene_that_asks_nothing_has_no_section(tmp_path: Path) -> None:
    report = report_of(tmp_path, 'system = "pendulum"\nschemes = ["lie2"]\n')
    assert SECTION.view(report.scenes[0], "x") is None
    assert "What is kept" not in render(report)
