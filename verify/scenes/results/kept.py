"""What the steps of a scheme keep, as it is proved for the system of a scene."""

from verify.prose import Prose
from verify.scenes.frozen import OfScheme, ProseText, Seconds, WithProse
from verify.verdict import Verdict


class StructureResult(WithProse):
    """A `verify.proof.structures.structure_order.StructureProof`, under the keys of the command.

    `observable`: that of a run in which the defect of its steps accumulates; "" if none does.
    """

    structure: str
    label: str
    defect: str
    verdict: Verdict
    reason: ProseText
    exact: bool | None
    order: int | None
    claimed: int | None
    leading: str | None
    component: str | None
    telescopes: bool | None
    potential: str | None
    domain: tuple[str, ...] = ()
    where: ProseText = Prose("")
    observable: str = ""


class KeptResult(OfScheme, WithProse):
    """The proofs of all structures that a scheme is meant to keep; `verdict` is their worst.

    `hamiltonian`: H, or equations without one. `exact` of a structure: its defect is 0 at every
    step; None if that is not decided. `convergence_order`: as in a proof.
    """

    verdict: Verdict
    reason: ProseText
    convergence_order: int | None
    convergence_decided: bool
    keeps: tuple[StructureResult, ...]
    seconds: Seconds

    @property
    def order_of_delta_j(self) -> int | None:
        """The proved order in h of ΔJ = det J − 1; None if it is 0, or was not asked for."""
        return next((x.order for x in self.keeps if x.label == "volume"), None)
