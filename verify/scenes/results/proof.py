"""What was proved of a scheme, for one H and for every H."""

from verify.prose import Prose
from verify.scenes.frozen import Frozen, OfScheme, Said, Seconds, WithProse
from verify.scenes.results.claim import StepResult
from verify.schemes.conditions.condition import Condition
from verify.verdict import Verdict


class Formulas(Frozen):
    """A map, its Jacobian matrix, ΔJ and its leading coefficient, some parameters as symbols."""

    symbols: tuple[str, ...]  # that have values of their own
    leading: str | None
    delta_j: str | None
    p_next: str | None
    q_next: str | None
    jacobian: tuple[tuple[str, str], tuple[str, str]] | None


class FormResult(Frozen):
    """What a proof in n degrees of freedom says beside: whether S = JᵀΩJ − Ω vanishes, the entries
    of its leading coefficient by their names, such as dp1∧dq2, each with its formula, none where
    they are too long; the order of det J − 1 and its coefficient; whether the leading coefficient
    telescopes, and the potential's entries in one text."""

    symplectic: bool | None
    entries: tuple[tuple[str, str], ...]
    entry: str
    volume_order: int | None
    volume_leading: str
    telescopes: bool | None
    potential: str
    why: str


class ProofResult(OfScheme, WithProse):
    """A `verify.proof.order.Proof`; closed forms are None where too large, or not asked for.

    In n degrees of freedom `form` is there; `order` and `leading` are then those of S. `domain`:
    where it holds, one condition a text, and `where` in words; none where everywhere. `symbolic`:
    the same formulas for people to read, where values are long numbers. `checked_by`: who else
    checked it, as of a claim; none where formulas were not asked for.
    """

    verdict: Verdict
    reason: Said
    order: int | None
    leading: str
    delta_j: str | None
    area_preserving: bool | None
    convergence_order: int | None
    convergence_decided: bool = True
    witness: dict[str, str]
    enclosure: str
    domain: tuple[str, ...] = ()
    where: Said = Prose("")
    p_next: str | None
    q_next: str | None
    jacobian: tuple[tuple[str, str], tuple[str, str]] | None
    symbolic: Formulas | None = None
    form: FormResult | None = None
    checked_by: tuple[Said, ...] = ()
    seconds: Seconds

    @property
    def what(self) -> str:
        """What has the order: ΔJ, or S in n degrees of freedom."""
        return "ΔJ" if self.form is None else "S"

    @property
    def keeps(self) -> bool | None:
        """Whether ΔJ ≡ 0; in n degrees of freedom S ≡ 0."""
        return self.area_preserving if self.form is None else self.form.symplectic

    @property
    def order_of_delta_j(self) -> int | None:
        """That of det J − 1, in any number of degrees of freedom."""
        return self.order if self.form is None else self.form.volume_order

    @property
    def shown(self) -> "ProofResult | Formulas":
        """What holds the formulas that people read."""
        return self.symbolic or self


class EveryResult(WithProse):
    """A `verify.proof.every.EveryProof`; `argument`: what is proved on paper beside it, and `steps`
    it is made of. `checked_by`: who else checked it, as of a claim.

    `timed`: it is for every H that depends on time. `degrees` of freedom: where there are more than
    one, order and leading coefficient are those of S.
    """

    scheme: str
    quantifier: str
    timed: bool = False
    degrees: int = 1
    verdict: Verdict
    reason: Said
    order: int | None
    area_preserving: bool | None
    convergence_order: int | None
    convergence_decided: bool = True
    formula: str
    leading: str
    telescopes: bool | None
    potential: str | None
    why: Said
    checked: tuple[Said, ...]
    conditions: tuple[Condition, ...] = ()
    argument: Said
    steps: tuple[StepResult, ...] = ()
    checked_by: tuple[Said, ...] = ()
