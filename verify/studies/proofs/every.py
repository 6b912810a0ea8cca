"""The task of a proof for every H."""

from typing import Literal

from verify.execution.keeping import Keeper
from verify.execution.task import Task
from verify.scenes.results.proof import EveryResult


class EveryTask(Task):
    """What is proved of a scheme for every H."""

    result = EveryResult
    imports = ("verify.proof.every",)
    kind: Literal["every"] = "every"
    scheme: str

    def compute(self, keeper: Keeper) -> EveryResult:
        """The proof for every H, as a result."""
        from verify.proof.every import prove_every

        proof = prove_every(self.scheme)
        return EveryResult(**{name: getattr(proof, name) for name in EveryResult.model_fields})
