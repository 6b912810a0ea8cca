"""What was found for the scenes that claims speak of."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

from verify.errors import InputError, unknown
from verify.scenes.frozen import Frozen
from verify.scenes.results.claim import CriterionResult
from verify.scenes.results.proof import ProofResult
from verify.scenes.results.run import RunResult
from verify.scenes.scene import Scene
from verify.studies.criteria import judge
from verify.studies.kinds.grid import grid_runs
from verify.studies.kinds.proofs import proof_task


class _Speaking(Protocol):
    @property
    def scene(self) -> str: ...
    @property
    def scheme(self) -> str: ...


@dataclass(frozen=True)
class Findings:
    """The scenes with all results that were computed for them."""

    scenes: Mapping[str, Scene]
    results: Mapping[str, Frozen] = field(default_factory=dict)

    def scene(self, name: str) -> Scene:
        """The scene of that name. InputError where there is none."""
        if name not in self.scenes:
            raise unknown("claim.scene", name, self.scenes)
        return self.scenes[name]

    def scene_of(self, claim: _Speaking) -> Scene:
        """The claim's scene, which must have its scheme."""
        scene = self.scene(claim.scene)
        _has_scheme(scene, claim.scheme)
        return scene

    def proof(self, scene: Scene, scheme: str) -> ProofResult:
        """What was proved for the scene's H. InputError where the scene has not this scheme."""
        _has_scheme(scene, scheme)
        result = self.results[proof_task(scene, scheme).key]
        assert isinstance(result, ProofResult)  # noqa: S101 - the key is a proof's
        return result

    def runs(self, scene: Scene, scheme: str) -> list[RunResult]:
        """The grid's runs by initial value, then step size; empty where none were needed."""
        return grid_runs(scene, scheme, self.results)

    def criterion(self, scene: Scene, scheme: str, number: int) -> CriterionResult:
        return judge(number, self.proof(scene, scheme), self.runs(scene, scheme))


def _has_scheme(scene: Scene, scheme: str) -> None:
    if scheme not in scene.schemes:
        known = ", ".join(scene.schemes)
        raise InputError("claim.scheme", scheme, f"is not in scene {scene.name}: {known}")
