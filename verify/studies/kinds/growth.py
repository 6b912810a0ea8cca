"""Λ of the grid's runs against its growth law."""

from fractions import Fraction
from typing import Any, Literal

from verify.execution.keeper import Keeper
from verify.execution.plan import Plan, Results, SceneQuestion, Study, results_of_tasks, scene_name
from verify.execution.task import StartTask
from verify.scenes.results.growth import AverageResult, GrowthLawResult
from verify.scenes.scene import Scene
from verify.studies.kinds.grid import grid_runs

_DIGITS = 30  # of the time average


class GrowthTask(StartTask):
    """The growth law of Λ on one orbit, with the time average in it."""

    result = AverageResult
    imports = ("verify.studies.growth_prediction",)
    price = 25_000_000
    kind: Literal["growth"] = "growth"
    digits: int

    def compute(self, keeper: Keeper) -> AverageResult:
        """Return the law, with its average enclosed."""
        from verify.studies.growth_prediction import compute_average

        return compute_average(self.exact_hamiltonian(), **self.other_fields())


def _tasks(scene: Scene, scheme: str) -> list[GrowthTask]:
    """Return the growth laws of the grid's orbits, by initial value, if the grid requests them."""
    if scene.grid is None or not scene.grid.growth:
        return []
    common = scene.hamiltonian_fields()
    return [
        GrowthTask(**common, scheme=scheme, q=initial_value.q, p=initial_value.p, digits=_DIGITS)
        for initial_value in scene.grid.in_the_plane
    ]


def _need(plan: Plan, scene: Scene, scheme: str, preserves: bool) -> None:
    tasks = _tasks(scene, scheme)
    if tasks and preserves:
        reason = "ΔJ ≡ 0 is proved: Λ is exactly 0"
        plan.leave_out(f"{scene_name(scene)}: growth law of Λ for {scheme}", reason)
        return
    for task in tasks:
        plan.need(task, f"{scene_name(scene)}: growth law of Λ")


def _collect(scene: Scene, results: Results) -> dict[str, Any]:
    if scene.grid is None or not scene.grid.growth:
        return {"growth_explains": scene.grid.growth_explains if scene.grid else ""}
    from verify.studies.growth_prediction import predict_runs

    hamiltonian, laws = scene.exact_hamiltonian(), []
    for scheme in scene.schemes:
        runs = grid_runs(scene, scheme, results)
        for law in results_of_tasks(AverageResult, _tasks(scene, scheme), results):
            orbit_runs = [run for run in runs if (run.q, run.p) == (law.q, law.p)]
            # Pages show predictions by step size.
            orbit_runs.sort(key=lambda run: Fraction(run.step_size))
            laws.append(
                GrowthLawResult(law=law, predictions=predict_runs(hamiltonian, law, orbit_runs))
            )
    return {"growth_laws": tuple(laws), "growth_explains": scene.grid.growth_explains}


_SECTION = SceneQuestion(
    3,
    "Λ against its growth law",
    "the scene has no [grid] that says `growth = true`",
    lambda scene: scene.grid and scene.grid.growth,
)
STUDY = Study(3, (_SECTION,), need_of_scheme=_need, results_for_scene=_collect)
