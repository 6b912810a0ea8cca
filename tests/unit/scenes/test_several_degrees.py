"""Scenes and claims in n degrees of freedom: lists, what is refused, and what a report says."""

from pathlib import Path

import pytest

from verify.claims.claims_file import load_claims
from verify.claims.verdicts import make_report, prepare
from verify.errors import InputError
from verify.execution import execute
from verify.execution.executors import THIS_PROCESS
from verify.pages.page import render
from verify.scenes.results.report import Report
from verify.scenes.scene import Scene, scene_from_toml
from verify.verdict import Verdict

HENON = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"
HEAD = f"""
name = "several"
title = "Two degrees"
hamiltonian = "{HENON}"
schemes = ["lie2", "stormer-verlet"]
every_hamiltonian = true
"""
START = "{ q = [0.3, -0.1], p = [0.1, 0.2] }"
GRID = f"""
[grid]
steps = 60
step_sizes = [0.1, 0.05]
initial_values = [{START}]
digits = 20
"""
SEPARATED = f"""
[[separation]]
step_sizes = [0.1, 0.05]
steps = 30
initial_value = {START}
"""
SERIES = f"""
[[series]]
step_size = 0.1
initial_value = {START}
steps = 50
"""
OF_LIE2 = 'scheme = "lie2"\nsystem = "henon-heiles"\n'
CLAIMS = {
    'kind = "defect_order"\ndefect_order = 3': Verdict.PROVED,
    'kind = "defect_order"\ndefect_order = 4': Verdict.REFUTED,
    'kind = "defect_order"\ndefect_order = 2\nat_least = true': Verdict.PROVED,
    'kind = "order"\norder = 4': Verdict.PROVED,
    'kind = "order"\norder = 3': Verdict.REFUTED,
    'kind = "symplectic"\nsymplectic = true': Verdict.REFUTED,
    'kind = "symplectic"\nsymplectic = false': Verdict.PROVED,
    'kind = "area_preserving"\narea_preserving = true': Verdict.REFUTED,
    'kind = "convergence_order"\nconvergence_order = 2': Verdict.PROVED,
    'kind = "convergence_order"\nconvergence_order = 3': Verdict.REFUTED,
    'kind = "bounded"\nbound = 0.001\nstep_size = 0.01\nsteps = 500\nq = [0.3, -0.1]\n'
    "p = [0.1, 0.2]": Verdict.ENCLOSED,
    'kind = "bounded"\nbound = 1e-9\nstep_size = 0.01\nsteps = 500\nq = [0.3, -0.1]\n'
    "p = [0.1, 0.2]": Verdict.REFUTED,
    'kind = "magnitude"\nstep_size = 0.01\nsteps = 500\nq = [0.3, -0.1]\np = [0.1, 0.2]\n'
    'exponents = { symplectic_defect_max = -6 }\nquantifier = "every"': Verdict.ENCLOSED,
}  # fmt: skip


def scene(text: str) -> Scene:
    return scene_from_toml(text, "several")


@pytest.fixture(scope="module")
def report() -> Report:
    return make_report(
        "Several", [scene(HEAD + GRID + SERIES)], [], execute.Store(None), command="test",
        where=THIS_PROCESS,
    )  # fmt: skip


def test_runs_start_from_lists_and_carry_s_and_w(report: Report) -> None:
    (found,) = report.scenes
    assert [run.q for run in found.runs] == [("0.3", "-0.1")] * 2
    names = {"symplectic_defect_max", "symplectic_defect", "lambda", "mse", "delta_j_max"}
    for run in found.runs:
        assert run.scheme == "lie2"  # of what is symplectic nothing is run
        assert set(run.values) == names | {"p1", "p2", "q1", "q2"}
        assert run.error_kind == "enclosed"


def test_what_is_proved_is_of_s(report: Report) -> None:
    lie, verlet = report.scenes[0].proofs
    assert lie.form is not None
    assert (lie.order, lie.form.volume_order, lie.form.symplectic) == (3, 4, False)
    assert dict(lie.form.entries)["dp1∧dq1"] == "p2"
    assert verlet.form is not None
    assert verlet.form.symplectic is True
    every, _ = report.scenes[0].every
    assert (every.degrees, every.order) == (2, 3)
    assert "in 2 degrees of freedom" in every.quantifier


def test_the_page_speaks_of_the_symplectic_form(report: Report) -> None:
    shown = render(report)
    assert "S of lie2 is of order h³; stormer-verlet is symplectic." in shown
    assert "Is the symplectic form preserved?" in shown
    assert "Is area preserved?" not in shown
    assert "dp1∧dq1" in shown
    assert "max |W|" in shown


@pytest.mark.parametrize(("claim", "verdict"), CLAIMS.items(), ids=range(len(CLAIMS)))
def test_claims_are_judged(tmp_path: Path, claim: str, verdict: Verdict) -> None:
    (tmp_path / "claims.toml").write_text(f'[[claim]]\nid = "a"\n{OF_LIE2}{claim}\n')
    check = prepare(load_claims(tmp_path / "claims.toml"))
    (found,) = check.run(execute.Store(None), where=THIS_PROCESS)
    assert found.verdict is verdict, found.evidence


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        (GRID.replace("[0.3, -0.1]", "[0.3]"), "q=0.3: has 1 of 2 numbers; H is of q1, q2"),
        (GRID.replace("[0.3, -0.1]", "0.3"), "grid.initial_values.0.p: number="),
        (GRID.replace("q = [0.3, -0.1], p = [0.1, 0.2]", "q = 1, p = 0"), "has 1 of 2 numbers"),
        (GRID.replace("-0.1", '"x"'), "grid.initial_values.0.q.1: number=x"),
        (SEPARATED.replace("initial_value = { q = [0.3, -0.1]", "initial_value = { q = [0.3]"),
         "q=0.3: has 1 of 2 numbers"),
        (GRID + "growth = true\n", "grid.growth takes p and q"),
        (GRID + 'observables = ["lambda_plain"]\n', "observable=lambda_plain"),
        ("criteria = [1]\n", "criteria takes p and q"),
        ("[[flow]]\nshape = 'cat'\ncentre = { q = 1, p = 0 }\nscale = 1\nstep_size = 0.1\n"
         "steps = [1]\n", "p=0: has 1 of 2 numbers; H is of p1, p2"),
        ("[[flow]]\nshape = 'cat'\nplane = 3\nstep_size = 0.1\nsteps = [1]\n",
         "plane=3: must be 1 … 2"),
        ("[[flow]]\nshape = 'cat'\nplane = 3\ncentre = { q = [1, 0], p = [0, 0] }\n"
         "step_size = 0.1\nsteps = [1]\n", "plane=3: must be 1 … 2"),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_refused_in_a_line(text: str, problem: str) -> None:
    with pytest.raises(InputError) as raised:
        scene(HEAD + text)
    assert problem in str(raised.value)
    assert "«" not in str(raised.value)


def test_lists_are_refused_in_the_plane() -> None:
    plane = HEAD.replace(HENON, "p**2/2 + q**4")
    with pytest.raises(InputError, match="is a list; H is of p and q"):
        scene(plane + GRID)
    with pytest.raises(InputError, match=r"is \|lambda\| in one degree of freedom"):
        scene(
            plane + GRID.replace(START, "{ q = 1, p = 0 }") + 'observables = ["symplectic_defect"]'
        )


def test_w_is_separated_where_lambda_is_in_the_plane() -> None:
    asked = scene(HEAD + GRID + "separate = true\n" + SEPARATED)
    made = make_report(
        "Separated", [asked], [], execute.Store(None), command="test", where=THIS_PROCESS
    )
    (found,) = made.scenes
    assert (found.separations, found.crossovers) == ((), ())
    (own,), (beside,) = found.form_separations, found.form_crossovers
    assert [point.scheme for point in (*own.points, *beside.points)] == ["lie2"] * 4
    assert any("separated from rounding for stormer-verlet" in what for what, _ in made.left_out)
    again = Report.model_validate_json(made.model_dump_json())
    assert again.scenes[0].form_crossovers == found.form_crossovers
    shown = render(made)
    assert "Truncation against rounding in W" in shown
    assert "‖∧²M‖" in shown
    assert "measured, not proved" in shown


def test_w_is_not_separated_in_more_degrees_than_it_is_made_for() -> None:
    chain = """
name = "chain"
title = "Five masses"
system = "fput"
schemes = ["lie2"]
[parameters]
n = 5
alpha = 1
beta = 0
[grid]
steps = 5
step_sizes = [0.1]
initial_values = [{ q = [1, 0, 0, 0, 0], p = [0, 0, 0, 0, 0] }]
"""
    assert scene(chain).grid
    with pytest.raises(InputError, match="is for up to 4 degrees of freedom; H has 5"):
        scene(chain + "separate = true\n")
