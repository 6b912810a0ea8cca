"""The task of a proof for every H."""

from typing import TYPE_CHECKING, Any, Literal

from verify.execution.keeping import Keeper
from verify.execution.task import Task
from verify.scenes.results.proof import EveryResult
from verify.scenes.results.step import StepResult

if TYPE_CHECKING:
    from verify.proof.every_proof import EveryProof
    from verify.proof.symplectic.proof import SymplecticProof

_COST = 20_000_000  # of a proof, about


class EveryTask(Task):
    """What is proved of a scheme for every H, in so many degrees of freedom; `timed`: for every H
    that depends on time."""

    result = EveryResult
    imports = (
        "verify.proof.checked",
        "verify.proof.checked.paper_steps",
        "verify.proof.checked.proved",
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
        from verify.schemes import get

        if self.degrees > 1:
            return _in_degrees(self.scheme, self.degrees, self.timed)
        proof = proof_of_every(self.scheme, timed=self.timed)
        steps = tuple(StepResult(text=x.text, checked_by=x.checked_by) for x in steps_of(proof))
        marked = marks(of_every_hamiltonian(proof, get(self.scheme), ALL))
        return _result(proof, degrees=1, steps=steps, checked_by=marked)


def _result(proof: "EveryProof | SymplecticProof", **differs: Any) -> EveryResult:
    """The proof's own fields, and those in which the result differs from it."""
    same = EveryResult.model_fields.keys() - differs
    return EveryResult(**{name: getattr(proof, name) for name in same}, **differs)


def proof_of_every(
    name: str, *, separable: bool = False, timed: bool = False, least: int = 0
) -> "EveryProof":
    """The proof for every H in the plane that is meant; `least` as for `prove_every`."""
    if timed:
        from verify.proof.every_in_time import prove_every_in_time

        return prove_every_in_time(name, least)
    from verify.proof.every import prove_every

    return prove_every(name, separable, least)


def _in_degrees(name: str, degrees: int, timed: bool) -> EveryResult:
    from verify.proof.checked import marks
    from verify.proof.checked.proved import ALL, of_degrees
    from verify.proof.symplectic.every import prove_every_in_degrees, quantifier
    from verify.prose import Prose
    from verify.schemes import get

    proof = prove_every_in_degrees(name, degrees, timed=timed)
    return _result(
        proof,
        scheme=name,
        quantifier=quantifier(get(name), degrees, separable=False, timed=timed),
        timed=timed,
        formula="",
        leading=proof.formula or proof.leading_text,
        why=Prose(proof.why),
        argument=Prose(),
        steps=(),
        checked_by=marks(of_degrees(proof, get(name), ALL, timed=timed)),
    )
