"""The task of a proof for every H."""

from typing import TYPE_CHECKING, Literal

from verify.execution.keeping import Keeper
from verify.execution.task import Task
from verify.scenes.results.proof import EveryResult

if TYPE_CHECKING:
    from verify.proof.every_proof import EveryProof

_COST = 20_000_000  # of a proof, about


class EveryTask(Task):
    """What is proved of a scheme for every H; `timed`: for every H that depends on time."""

    result = EveryResult
    imports = ("verify.proof.every",)
    kind: Literal["every"] = "every"
    scheme: str
    timed: bool = False

    @property
    def cost(self) -> int:
        """About how many float64 steps it is worth."""
        return _COST

    def compute(self, keeper: Keeper) -> EveryResult:
        """The proof for every H, as a result."""
        from verify.proof.every import prove_every

        proof = _in_time(self.scheme) if self.timed else prove_every(self.scheme)
        return EveryResult(**{name: getattr(proof, name) for name in EveryResult.model_fields})


def _in_time(scheme: str) -> "EveryProof":
    from verify.proof.every_in_time import prove_every_in_time

    return prove_every_in_time(scheme)
