"""The task of a proof for every H."""

from typing import Any, Literal

from verify.execution.keeping import Keeper
from verify.execution.task import Task
from verify.scenes.results.claim import StepResult
from verify.scenes.results.proof import EveryResult

_COST = 20_000_000  # of a proof, about


class EveryTask(Task):
    """Prove properties of a scheme for every H, in so many degrees of freedom.

    `timed`: for every H that depends on time.
    """

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
        """About the number of float64 steps that it is worth."""
        return _COST

    def compute(self, keeper: Keeper) -> EveryResult:
        """Return the proof for every H as a result."""
        from verify.proof.checked import marks
        from verify.proof.checked.paper_steps import steps_of
        from verify.proof.checked.proved import ALL, proved_for_every
        from verify.proof.every import prove_every
        from verify.schemes import get

        proof = prove_every(self.scheme, timed=self.timed, degrees=self.degrees)
        differs: dict[str, Any] = {
            "steps": tuple(
                StepResult(text=x.text, checked_by=x.checked_by) for x in steps_of(proof)
            ),
            "checked_by": marks(proved_for_every(proof, get(self.scheme), ALL)),
        }
        if not proof.planar:  # S is written out in its formula, where it has one
            differs |= {"formula": "", "leading": proof.formula or proof.leading}
        same = EveryResult.model_fields.keys() - differs
        return EveryResult(**{name: getattr(proof, name) for name in same}, **differs)
