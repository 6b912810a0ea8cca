"""Closed form and order of ΔJ, for the scene's H and each of its schemes."""

from verify.execution.plan import Plan
from verify.execution.study import Study, scene_name
from verify.scenes.scene import Scene
from verify.studies.proofs.one import ProofTask


def proof_task(scene: Scene, scheme: str, *, formulas: bool = True) -> ProofTask:
    """Return the proof of one scheme for the scene's H; `formulas`: with ΔJ in closed form."""
    return ProofTask(**scene.hamiltonian_fields(), scheme=scheme, formulas=formulas)


def _need(plan: Plan, scene: Scene, scheme: str, _preserves: bool) -> None:
    plan.need(proof_task(scene, scheme), f"{scene_name(scene)}: closed form and order of ΔJ")


STUDY = Study(0, need_of_scheme=_need)
