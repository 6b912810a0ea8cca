"""The task of a proof for every H."""

from typing import TYPE_CHECKING, Literal

from verify.execution.keeping import Keeper
from verify.execution.task import Task
from verify.scenes.results.proof import EveryResult
from verify.scenes.results.step import StepResult

if TYPE_CHECKING:
    from verify.proof.every_proof import EveryProof

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

        if self.degrees > 1:
            return _in_degrees(self.scheme, self.degrees, self.timed)
        proof = _in_time(self.scheme) if self.timed else prove_every(self.scheme)
        known = EveryResult.model_fields.keys() - {"degrees", "steps", "checked_by"}
        return EveryResult(
            **{name: getattr(proof, name) for name in known},
            steps=tuple(StepResult(text=x.text, checked_by=x.checked_by) for x in steps_of(proof)),
            checked_by=marks(of_every_hamiltonian(proof, get(self.scheme), ALL)),
        )


def _in_time(scheme: str) -> "EveryProof":
    from verify.proof.every_in_time import prove_every_in_time

    return prove_every_in_time(scheme)


def _in_degrees(name: str, degrees: int, timed: bool) -> EveryResult:
    from verify.proof.checked import marks
    from verify.proof.checked.proved import ALL, of_degrees
    from verify.proof.symplectic.every import prove_every_in_degrees, quantifier
    from verify.prose import Prose
    from verify.schemes import get

    proof = prove_every_in_degrees(name, degrees, timed=timed)
    return EveryResult(
        scheme=name,
        quantifier=quantifier(get(name), degrees, separable=False, timed=timed),
        timed=timed,
        degrees=degrees,
        verdict=proof.verdict,
        reason=proof.reason,
        order=proof.order,
        area_preserving=proof.area_preserving,
        convergence_order=proof.convergence_order,
        convergence_decided=proof.convergence_decided,
        formula="",
        leading=proof.formula or proof.leading_text,
        telescopes=proof.telescopes,
        potential=proof.potential,
        why=Prose(proof.why),
        checked=proof.checked,
        conditions=proof.conditions,
        argument=Prose(),
        checked_by=marks(of_degrees(proof, get(name), ALL, timed=timed)),
    )
