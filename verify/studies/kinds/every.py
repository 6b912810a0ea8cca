"""What holds of the scene's schemes for every H.

The task of a proof for every H.
"""

from typing import Any, Literal

from verify.execution.keeping import Keeper
from verify.execution.plan import Plan
from verify.execution.study import Results, Section, Study, called, known_results
from verify.execution.task import Task
from verify.scenes.results.proof import EveryResult
from verify.scenes.results.step import StepResult
from verify.scenes.scene import Scene
from verify.schemes import get

_COST = 20_000_000  # of a proof, about


class EveryTask(Task):
    """What is proved of a scheme for every H, in so many degrees of freedom; `timed`: for every H
    that depends on time."""

    result = EveryResult
    imports = (
        "verify.proof.checked",
        "verify.proof.checked.paper_steps",
        "verify.proof.checked.proved",
        "verify.proof.every",
        "verify.schemes",
    )
    kind: Literal["every"] = "every"
    scheme: str
    timed: bool = False
    degrees: int = 1

    @property
    def cost(self) -> int:
        """About how many float64 steps it is worth."""
        return _COST

    def compute(self, keeper: Keeper) -> EveryResult:
        """The proof for every H, as a result."""
        from verify.proof.checked import marks
        from verify.proof.checked.paper_steps import steps_of
        from verify.proof.checked.proved import ALL, of_every_hamiltonian
        from verify.proof.every import prove_every
        from verify.schemes import get

        proof = prove_every(self.scheme, timed=self.timed, degrees=self.degrees)
        differs: dict[str, Any] = {
            "steps": tuple(
                StepResult(text=x.text, checked_by=x.checked_by) for x in steps_of(proof)
            ),
            "checked_by": marks(of_every_hamiltonian(proof, get(self.scheme), ALL)),
        }
        if not proof.planar:  # S is written out in its formula, where it has one
            differs |= {"formula": "", "leading": proof.formula or proof.leading}
        same = EveryResult.model_fields.keys() - differs
        return EveryResult(**{name: getattr(proof, name) for name in same}, **differs)


def _need(plan: Plan, scene: Scene, scheme: str, _preserves: bool) -> None:
    if not scene.every_hamiltonian:
        return
    if get(scheme).every_h is None:
        plan.leave_out(f"{called(scene)}: {scheme} for every H", "it is given for one H")
    else:
        plan.need(_task(scene, scheme), f"{called(scene)}: what holds for every H")


def _task(scene: Scene, scheme: str) -> EveryTask:
    exact = scene.exact_hamiltonian()
    return EveryTask(scheme=scheme, timed=exact.time_dependent, degrees=exact.degrees)


def _found(scene: Scene, results: Results) -> dict[str, Any]:
    tasks = [_task(scene, name) for name in scene.schemes if scene.every_hamiltonian]
    return {"every": tuple(known_results(EveryResult, tasks, results))}


_SECTION = Section(
    0,
    "proofs for every H",
    "the scene does not say `every_hamiltonian = true`",
    lambda scene: scene.every_hamiltonian,
)
STUDY = Study(1, (_SECTION,), need_of_scheme=_need, found=_found)
