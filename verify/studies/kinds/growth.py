"""Λ of the grid's runs against its growth law."""

from fractions import Fraction
from typing import Any

from verify.execution.plan import Plan
from verify.execution.study import Results, Section, Study, called, known_results
from verify.scenes.results.growth import AverageResult, GrowthLawResult
from verify.scenes.scene import Scene
from verify.studies.growth.task import GrowthTask
from verify.studies.kinds.grid import grid_runs

_DIGITS = 30  # of the time average


def _tasks(scene: Scene, scheme: str) -> list[GrowthTask]:
    """The growth laws of the grid's orbits, by initial value; none where none are asked for."""
    if scene.grid is None or not scene.grid.growth:
        return []
    given = scene.hamiltonian_fields()
    return [
        GrowthTask(**given, scheme=scheme, q=at.q, p=at.p, digits=_DIGITS)
        for at in scene.grid.in_the_plane
    ]


def _need(plan: Plan, scene: Scene, scheme: str, preserves: bool) -> None:
    tasks = _tasks(scene, scheme)
    if tasks and preserves:
        why = "ΔJ ≡ 0 is proved: Λ is exactly 0"
        plan.leave_out(f"{called(scene)}: growth law of Λ for {scheme}", why)
        return
    for task in tasks:
        plan.need(task, f"{called(scene)}: growth law of Λ")


def _found(scene: Scene, results: Results) -> dict[str, Any]:
    if scene.grid is None or not scene.grid.growth:
        return {"growth_explains": scene.grid.growth_explains if scene.grid else ""}
    from verify.studies.growth.prediction import predictions

    exact, found = scene.exact_hamiltonian(), []
    for scheme in scene.schemes:
        runs = grid_runs(scene, scheme, results)
        for law in known_results(AverageResult, _tasks(scene, scheme), results):
            own = [run for run in runs if (run.q, run.p) == (law.q, law.p)]
            own.sort(key=lambda run: Fraction(run.step_size))
            found.append(GrowthLawResult(law=law, predictions=predictions(exact, law, own)))
    return {"growth_laws": tuple(found), "growth_explains": scene.grid.growth_explains}


_SECTION = Section(
    3,
    "Λ against its growth law",
    "the scene has no [grid] that says `growth = true`",
    lambda scene: scene.grid and scene.grid.growth,
)
STUDY = Study(3, (_SECTION,), need_of_scheme=_need, found=_found)
