"""What was proved of a scheme, for one H and for every H."""

from verify.algebra.conditions import Condition
from verify.prose import Prose
from verify.scenes.frozen import Frozen, OfScheme, Said, Seconds, WithProse
from verify.verdict import Verdict


class Formulas(Frozen):
    """A map, its Jacobian matrix, ΔJ and its leading coefficient, some parameters as symbols."""

    symbols: tuple[str, ...]  # that have values of their own
    leading: str | None
    delta_j: str | None
    p_next: str | None
    q_next: str | None
    jacobian: tuple[tuple[str, str], tuple[str, str]] | None


class ProofResult(OfScheme, WithProse):
    """A `verify.proof.order.Proof`; closed forms are None where too large, or not asked for.

    `domain`: where it holds, one condition a text, and `where` in words; none where everywhere.
    `symbolic`: the same formulas for people to read, where values are long numbers.
    """

    verdict: Verdict
    reason: Said
    order: int | None
    leading: str
    delta_j: str | None
    area_preserving: bool | None
    convergence_order: int | None
    witness: dict[str, str]
    enclosure: str
    domain: tuple[str, ...] = ()
    where: Said = Prose("")
    p_next: str | None
    q_next: str | None
    jacobian: tuple[tuple[str, str], tuple[str, str]] | None
    symbolic: Formulas | None = None
    seconds: Seconds

    @property
    def shown(self) -> "ProofResult | Formulas":
        """What holds the formulas that people read."""
        return self.symbolic or self


class EveryResult(WithProse):
    """A `verify.proof.every.EveryProof`; `argument`: what is proved on paper beside it.

    `timed`: it is for every H that depends on time.
    """

    scheme: str
    quantifier: str
    timed: bool = False
    verdict: Verdict
    reason: Said
    order: int | None
    area_preserving: bool | None
    convergence_order: int | None
    formula: str
    leading: str
    telescopes: bool | None
    potential: str | None
    why: Said
    checked: tuple[Said, ...]
    conditions: tuple[Condition, ...] = ()
    argument: Said
