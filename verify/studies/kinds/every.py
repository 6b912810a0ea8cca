"""Proofs about the scene's schemes for every H."""

from typing import Any, Literal

from verify.execution.keeper import Keeper
from verify.execution.plan import Plan, Results, SceneQuestion, Study, results_of_tasks, scene_name
from verify.execution.task import Task
from verify.scenes.results.claim import StepResult
from verify.scenes.results.proof_result import EveryResult
from verify.scenes.scene import Scene
from verify.schemes import get


class EveryTask(Task):
    """Prove properties of a scheme for every H, in so many degrees of freedom.

    `timed`: for every H that depends on time.
    """

    result = EveryResult
    imports = (
        "verify.proof.checked.proof_marks",
        "verify.proof.checked.proved_statement",
        "verify.proof.order_for_every_h",
    )
    price = 20_000_000
    kind: Literal["every"] = "every"
    scheme: str
    timed: bool = False
    degrees: int = 1

    def compute(self, keeper: Keeper) -> EveryResult:
        """Return the proof for every H as a result."""
        from verify.proof.checked.proof_marks import marks, steps_of
        from verify.proof.checked.proved_statement import ALL, statement_for_every_h
        from verify.proof.order_for_every_h import prove_for_every_h

        proof = prove_for_every_h(self.scheme, timed=self.timed, degrees=self.degrees)
        differs: dict[str, Any] = {
            "steps": tuple(
                StepResult(text=x.text, checked_by=x.checked_by) for x in steps_of(proof)
            ),
            "checked_by": marks(statement_for_every_h(proof, get(self.scheme), ALL)),
        }
        if not proof.planar:  # S is written out in its formula, where it has one
            differs |= {"formula": "", "leading": proof.formula or proof.leading}
        return EveryResult.from_object(proof, **differs)


def _need(plan: Plan, scene: Scene, scheme: str, _preserves: bool) -> None:
    if not scene.every_hamiltonian:
        return
    if get(scheme).every_h is None:
        plan.leave_out(f"{scene_name(scene)}: {scheme} for every H", "it is given for one H")
    else:
        plan.need(_task(scene, scheme), f"{scene_name(scene)}: what holds for every H")


def _task(scene: Scene, scheme: str) -> EveryTask:
    hamiltonian = scene.exact_hamiltonian()
    return EveryTask(scheme=scheme, timed=hamiltonian.time_dependent, degrees=hamiltonian.degrees)


def _collect(scene: Scene, results: Results) -> dict[str, Any]:
    tasks = [_task(scene, name) for name in scene.schemes if scene.every_hamiltonian]
    return {"every": tuple(results_of_tasks(EveryResult, tasks, results))}


_SECTION = SceneQuestion(
    0,
    "proofs for every H",
    "the scene does not say `every_hamiltonian = true`",
    lambda scene: scene.every_hamiltonian,
)
STUDY = Study(1, (_SECTION,), need_of_scheme=_need, results_for_scene=_collect)
