"""The results computed for the scenes of claims."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

from verify.errors import InputError, unknown_name
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
        """Return the scene of that name. Raises InputError if there is none."""
        if name not in self.scenes:
            raise unknown_name("claim.scene", name, self.scenes)
        return self.scenes[name]

    def scene_of(self, claim: _Speaking) -> Scene:
        """Return the claim's scene, which must have its scheme."""
        scene = self.scene(claim.scene)
        _check_scheme(scene, claim.scheme)
        return scene

    def proof(self, scene: Scene, scheme: str) -> ProofResult:
        """Return the proof for the scene's H. Raises InputError if the scene lacks the scheme."""
        _check_scheme(scene, scheme)
        result = self.results[proof_task(scene, scheme).key]
        assert isinstance(result, ProofResult)  # noqa: S101 - the key is a proof's
        return result

    def runs(self, scene: Scene, scheme: str) -> list[RunResult]:
        """Return the grid's runs by initial value, then step size; empty if none were needed."""
        return grid_runs(scene, scheme, self.results)

    def criterion(self, scene: Scene, scheme: str, number: int) -> CriterionResult:
        return judge(number, self.proof(scene, scheme), self.runs(scene, scheme))


def _check_scheme(scene: Scene, scheme: str) -> None:
    if scheme not in scene.schemes:
        names = ", ".join(scene.schemes)
        raise InputError("claim.scheme", scheme, f"is not in scene {scene.name}: {names}")
