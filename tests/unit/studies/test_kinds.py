"""The studies that are found: together they make a scene's plan and its result."""

from collections import Counter
from pathlib import Path

import pytest

from tests.unit.studies.test_tasks_of_scenes import HEAD, load
from verify.execution.plan import SceneQuestion, Study
from verify.scenes.results.report import SceneResult
from verify.studies import tasks_of_scenes as module
from verify.studies.kinds import studies
from verify.studies.kinds.proofs import proof_task
from verify.studies.tasks_of_scenes import collect_findings, plan_scenes

OTHERS = {"name", "title", "hamiltonian", "parameters", "source", "time", "proofs", "criteria"}


def test_no_two_have_one_place() -> None:
    orders = [study.order for study in studies()]
    places = [section.place for study in studies() for section in study.sections]
    assert orders == sorted(set(orders))
    assert sorted(places) == sorted(set(places))


def test_each_part_of_a_scenes_result_is_one_studys(tmp_path: Path) -> None:
    scene = load(tmp_path, HEAD)
    parts = Counter(
        k for each in studies() if each.results_for_scene for k in each.results_for_scene(scene, {})
    )
    assert set(parts.values()) == {1}
    optional = {n for n, field in SceneResult.model_fields.items() if not field.is_required()}
    assert set(parts) <= set(SceneResult.model_fields) - OTHERS
    assert set(SceneResult.model_fields) - OTHERS - set(parts) <= optional


def test_a_study_that_is_found_is_planned_and_shown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = load(tmp_path, HEAD)
    made = Study(
        99,
        (SceneQuestion(99, "what is new", "the scene has no [new]", lambda scene: False),),
        need=lambda plan, scene: plan.need(proof_task(scene, "rk4"), "new"),
        results_for_scene=lambda scene, results: {"new": len(results)},
    )
    before = plan_scenes([scene])
    monkeypatch.setattr(module, "studies", lambda: [*studies(), made])
    after = plan_scenes([scene])
    assert set(after.tasks) - set(before.tasks) == {proof_task(scene, "rk4").key}
    assert [*after.left_out][-1][1] == "the scene has no [new]"
    assert collect_findings(scene, {})["new"] == 0
