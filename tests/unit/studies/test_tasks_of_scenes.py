"""Plans: each task once, with every reason for it, and what is left out with the reason why."""

import time
from fractions import Fraction
from pathlib import Path

import pytest

from tests.helpers.constructed.scenes import DUFFING, GOOD, GRID, HEAD, PAPER, load
from verify.errors import InputError
from verify.execution.execute import compute_task
from verify.execution.plan import Plan
from verify.reference.make.scene_plan import plan_references
from verify.runs.task import RunTask
from verify.scenes.observables import CLOSED_FORM
from verify.scenes.results.proof_result import ProofResult
from verify.scenes.scene import load_scene
from verify.studies.kinds.growth import GrowthTask
from verify.studies.kinds.proofs import ProofTask
from verify.studies.tasks_of_scenes import plan_scenes


def runs_of(plan: Plan) -> list[RunTask]:
    return [t for t in plan.tasks.values() if isinstance(t, RunTask)]


def test_a_task_that_several_scenes_ask_for_is_done_once_with_every_reason(tmp_path: Path) -> None:
    one = load(tmp_path, GOOD)
    two = one.model_copy(update={"name": "other"})
    single, plan = plan_scenes([one]), plan_scenes([one, two, one])
    assert set(plan.tasks) == set(single.tasks)
    assert len(single.tasks) == 3  # a proof, a run of the grid, a series
    for name in plan.tasks:
        reasons = plan.reasons[name]
        assert len(reasons) == len(set(reasons)) == 2
        assert any("mine" in r for r in reasons)
        assert any("other" in r for r in reasons)


def test_equal_numbers_written_in_two_ways_are_one_task(tmp_path: Path) -> None:
    one = load(tmp_path, HEAD + GRID.replace("0.1", '"1/10"').replace("1.5", '"3/2"'))
    other_h = HEAD.replace("q**4/4", "0.25*q^4") + GRID.replace("0.1", "100e-3")
    assert set(plan_scenes([one, load(tmp_path, other_h)]).tasks) == set(plan_scenes([one]).tasks)


def test_tasks_that_differ_in_anything_have_different_keys(tmp_path: Path) -> None:
    base = runs_of(plan_scenes([load(tmp_path, HEAD + GRID)]))[0]
    changes = {
        "hamiltonian": "p**2/2", "parameters": {"a": Fraction(1)}, "scheme": "lie3",
        "step_size": Fraction(1, 11), "steps": 11,
        "q": Fraction(1), "p": Fraction(1), "start": {"u": Fraction(1)}, "t0": Fraction(1),
        "arithmetic": "mpmath", "digits": 18, "observables": ("mse",), "points": 3,
        "shares_kernel": True, "sections": 17,
    }  # fmt: skip
    assert set(changes) | {"kind"} == set(RunTask.model_fields)
    keys = [base.model_copy(update={n: v}).key for n, v in changes.items()]
    assert len({base.key, *keys}) == len(changes) + 1


def test_what_is_not_needed_is_left_out_and_the_plan_says_why(tmp_path: Path) -> None:
    plan = plan_scenes([load(tmp_path, HEAD)])
    assert not runs_of(plan)
    assert dict(plan.left_out) == {
        "mine: proofs for every H": "the scene does not say `every_hamiltonian = true`",
        "mine: runs over step sizes": "the scene has no [grid]",
        "mine: trajectories and plots over time": "the scene has no [[series]]",
        "mine: truncation separated from rounding": "the scene has no [[separation]], and its "
        "[grid] does not say `separate = true`",
        "mine: Λ against its growth law": "the scene has no [grid] that says `growth = true`",
        "mine: criteria 1–4": "the scene names no criteria",
        "mine: error against run time": "the scene has no [work_precision]",
        "mine: regions carried by maps, and their areas": "the scene has no [[flow]]",
        "mine: stability, and whose fault it is where there is none": "the scene has no "
        "[[stability]]",
        "mine: the largest stable step": "the scene has no [[largest_step]]",
        "mine: the map of step size and stiffness": "the scene has no [[stability_map]]",
        "mine: what a step keeps": "the scene has no `keeps`",
    }
    plan = plan_scenes([load(tmp_path, GOOD.replace("lie2", "symplectic-euler"))])
    assert not runs_of(plan)
    assert sum("ΔJ ≡ 0 is proved" in why for _, why in plan.left_out) == 2


def test_the_plain_product_is_run_even_where_area_is_preserved(tmp_path: Path) -> None:
    content = HEAD.replace("lie2", "symplectic-euler") + GRID
    plan = plan_scenes([load(tmp_path, content + 'observables = ["lambda_plain"]')])
    assert [t.observables for t in runs_of(plan)] == [("lambda_plain",)]


def test_the_plan_of_the_paper_has_the_grids_and_says_why_of_each_task() -> None:
    scenes = [load_scene(PAPER / f"{name}.toml") for name in ("duffing", "pendulum")]
    shown = plan_scenes(scenes).as_json()
    grid = [t for t in shown["tasks"] if t["kind"] == "run" and t["scheme"] == "lie2"
            and t["points"] == 0]  # fmt: skip
    assert len(grid) == 60
    assert sum(t["steps"] for t in grid) == pytest.approx(4.8e8, rel=0.2)
    assert all(t["reasons"] for t in shown["tasks"])
    assert all(item["what"] and item["why"] for item in shown["left_out"])
    assert set(grid[0]["observables"]) >= set(CLOSED_FORM)


def test_a_grid_over_parameter_values_needs_one_task_for_each(tmp_path: Path) -> None:
    scenes = [load(tmp_path, DUFFING + f"parameters = {{ delta = {d} }}\n" + GRID) for d in (1, 2)]
    assert len(runs_of(plan_scenes(scenes))) == 2


def test_a_plan_of_many_tasks_is_made_quickly(tmp_path: Path) -> None:
    starts = ", ".join(f"{{ q = {k}, p = 0 }}" for k in range(50))
    steps = ", ".join(f"0.{k:03d}" for k in range(1, 21))
    grid = f"[grid]\nsteps = 10\nstep_sizes = [{steps}]\ninitial_values = [{starts}]\n"
    scene = load(tmp_path, HEAD + grid)
    begun = time.perf_counter()
    plan = plan_scenes([scene])
    assert len(runs_of(plan)) == 1000
    assert time.perf_counter() - begun < 4


def test_the_growth_law_is_planned_once_an_initial_value_and_only_where_it_is_asked_for(
    tmp_path: Path,
) -> None:
    two = GRID.replace("[0.1]", "[0.1, 0.05]").replace("}]", "}, { q = 1, p = 0 }]")

    def laws(content: str) -> list[GrowthTask]:
        tasks = plan_scenes([load(tmp_path, content)]).tasks.values()
        return [t for t in tasks if isinstance(t, GrowthTask)]

    asked = laws(HEAD + two + "growth = true")
    assert [(t.q, t.p) for t in asked] == [(Fraction(3, 2), 0), (1, 0)]
    assert laws(HEAD + two) == laws(HEAD + two + "growth = false") == []


def test_what_preserves_area_has_no_growth_law_and_the_plan_says_so(tmp_path: Path) -> None:
    content = HEAD.replace("lie2", "symplectic-euler") + GRID + "growth = true"
    plan = plan_scenes([load(tmp_path, content)])
    assert not [t for t in plan.tasks.values() if isinstance(t, GrowthTask)]
    left_out = dict(plan.left_out)
    assert left_out["mine: growth law of Λ for symplectic-euler"].endswith("Λ is exactly 0")


def test_a_growth_law_without_lambda_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="wants lambda"):
        load(tmp_path, HEAD + GRID + 'observables = ["mse"]\ngrowth = true')
    load(tmp_path, HEAD + GRID + 'observables = ["mse"]')


def test_a_proof_for_reference_data_writes_no_formulas_out(tmp_path: Path) -> None:
    scene = load(tmp_path, HEAD + '[[reference]]\nstep_sizes = [0.1]\nsteps = [1]\n'
                 'initial_values = [{ q = 1, p = 0 }]\n')  # fmt: skip
    (short,) = (t for t in plan_references([scene]).tasks.values() if isinstance(t, ProofTask))
    long = short.model_copy(update={"formulas": True})
    brief, full = compute_task(short), compute_task(long)
    assert isinstance(brief, ProofResult)
    assert isinstance(full, ProofResult)
    left = {"delta_j": None, "p_next": None, "q_next": None, "jacobian": None, "checked_by": ()}
    assert brief == full.model_copy(update=left | {"seconds": brief.seconds})
    assert None not in (full.delta_j, full.p_next, full.q_next, full.jacobian)
