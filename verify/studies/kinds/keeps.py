"""What a step keeps: the proof on each structure, for the scene's system and each scheme."""

import time
from typing import TYPE_CHECKING, Any, Literal

from verify.algebra.formula import symbol
from verify.execution.keeper import Keeper
from verify.execution.plan import Plan, Results, SceneQuestion, Study, results_of_tasks, scene_name
from verify.execution.task import SchemeTask
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.keeps_section import Keeps, observable_of
from verify.scenes.results.kept import KeptResult, StructureResult
from verify.scenes.scene import Scene
from verify.schemes import get
from verify.structures.reading import read_structures
from verify.structures.structure import is_zero

if TYPE_CHECKING:
    from verify.proof.structures.structure_order import StructureProof

# The determinant of more takes long; then volume is for the scene to ask for.
_MOST_COORDINATES = 12
# What is asked of a field whose flow keeps it, where its scene says nothing.
VOLUME = Keeps(structures=("volume",))


class KeepsTask(SchemeTask):
    """Prove what one scheme keeps of one system, which is H or equations without one."""

    result = KeptResult
    imports = ("verify.proof.structures.structures_proof",)
    price = 20_000_000
    kind: Literal["keeps"] = "keeps"
    keeps: Keeps

    def compute(self, keeper: Keeper) -> KeptResult:
        """Return the proofs as a result."""
        from verify.proof.structures.structures_proof import prove_structures

        system, scheme, start_time = self.exact_hamiltonian(), get(self.scheme), time.perf_counter()
        claims = read_structures(self.keeps.request(*self.keeps.structures), system)
        proof = prove_structures(scheme.step_map(system), claims, scheme)
        return KeptResult.from_object(
            proof, **system.texts, scheme=self.scheme,
            keeps=tuple(_result_of(x, system) for x in proof.keeps),
            seconds=time.perf_counter() - start_time,
        )  # fmt: skip


def _result_of(x: "StructureProof", system: Hamiltonian) -> StructureResult:
    return StructureResult.from_object(
        x, structure=x.structure.name, label=x.structure.label, defect=x.structure.defect_formula,
        exact=x.is_kept, leading=x.leading or None, component=x.component or None,
        domain=x.domain.texts, where=x.domain.prose,
        observable=observable_of(x.structure, system),
    )  # fmt: skip


def _keeps_of(scene: Scene) -> Keeps | None:
    if scene.keeps is None and scene.field is not None and _flow_keeps_volume(scene):
        return VOLUME
    return scene.keeps


def _flow_keeps_volume(scene: Scene) -> bool:
    """Return False if the divergence is shown not to vanish, and for too many coordinates."""
    system = scene.exact_hamiltonian()
    if len(system.coordinates) > _MOST_COORDINATES:
        return False
    pairs = zip(system.exact, system.coordinates, strict=True)
    divergence = sum(component.diff(symbol(name)) for component, name in pairs)
    return is_zero(divergence, (*system.coordinates, "t")) is not False


def _task(scene: Scene, scheme: str) -> KeepsTask | None:
    keeps = _keeps_of(scene)
    if keeps is None:
        return None
    return KeepsTask(**scene.hamiltonian_fields(), scheme=scheme, keeps=keeps)


def _need(plan: Plan, scene: Scene, scheme: str, _preserves: bool) -> None:
    if task := _task(scene, scheme):
        plan.need(task, f"{scene_name(scene)}: what a step keeps")


def _collect(scene: Scene, results: Results) -> dict[str, Any]:
    tasks = [task for name in scene.schemes if (task := _task(scene, name))]
    return {"keeps": tuple(results_of_tasks(KeptResult, tasks, results))}


_SECTION = SceneQuestion(14, "what a step keeps", "the scene has no `keeps`", _keeps_of)
STUDY = Study(12, (_SECTION,), need_of_scheme=_need, results_for_scene=_collect, takes_field=True)
