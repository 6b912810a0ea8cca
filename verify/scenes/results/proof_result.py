"""Results of proofs on a scheme, for one H and for every H."""

from verify.prose import Prose
from verify.scenes.frozen import Frozen, OfScheme, ProseText, Seconds, WithProse
from verify.scenes.results.claim import StepResult
from verify.schemes.conditions.condition import Condition
from verify.verdict import Verdict


class Formulas(Frozen):
    """A map, its Jacobian matrix, ΔJ and its leading coefficient, some parameters as symbols."""

    symbols: tuple[str, ...]  # the parameters that have values in the scene
    leading: str | None
    delta_j: str | None
    p_next: str | None
    q_next: str | None
    jacobian: tuple[tuple[str, str], tuple[str, str]] | None


class FormResult(Frozen):
    """The further results of a proof in n degrees of freedom.

    `symplectic`: S = JᵀΩJ − Ω vanishes. `entries`: the entries of the leading coefficient of S by
    their names, such as dp1∧dq2, with their formulas, empty if they are too long. `volume_order`
    and `volume_leading`: the order of det J − 1 and its coefficient. `telescopes`: the leading
    coefficient telescopes, with the entries of its `potential` in one text.
    """

    symplectic: bool | None
    entries: tuple[tuple[str, str], ...]
    entry: str
    volume_order: int | None
    volume_leading: str
    telescopes: bool | None
    potential: str
    why: str


class ProofResult(OfScheme, WithProse):
    """A `verify.Proof`; closed forms are None if too large, or not requested.

    In n degrees of freedom `form` is present, and `order` and `leading` are those of S. `domain`:
    the conditions under which it holds, one text each, and `where` the same in words; empty if
    it holds everywhere. `symbolic`: the same formulas for readers, where values are long numbers.
    `checked_by`: other checkers, as in a claim; empty if formulas were not requested.
    """

    verdict: Verdict
    reason: ProseText
    order: int | None
    leading: str
    delta_j: str | None
    area_preserving: bool | None
    convergence_order: int | None
    convergence_decided: bool = True
    witness: dict[str, str]
    enclosure: str
    domain: tuple[str, ...] = ()
    where: ProseText = Prose("")
    p_next: str | None
    q_next: str | None
    jacobian: tuple[tuple[str, str], tuple[str, str]] | None
    symbolic: Formulas | None = None
    form: FormResult | None = None
    checked_by: tuple[ProseText, ...] = ()
    seconds: Seconds

    @property
    def what(self) -> str:
        """The name of the defect that has the order: ΔJ, or S in n degrees of freedom."""
        return "ΔJ" if self.form is None else "S"

    @property
    def keeps(self) -> bool | None:
        """True if ΔJ ≡ 0, in n degrees of freedom S ≡ 0; None if that is undecided."""
        return self.area_preserving if self.form is None else self.form.symplectic

    @property
    def order_of_delta_j(self) -> int | None:
        """The order of det J − 1, in any number of degrees of freedom."""
        return self.order if self.form is None else self.form.volume_order

    @property
    def readable(self) -> "ProofResult | Formulas":
        """The formulas for readers: `symbolic`, or the proof's own."""
        return self.symbolic or self


class EveryResult(WithProse):
    """A `verify.proof.proof_for_every_h.ProofForEveryH`.

    `argument`: the proof on paper beside it, and `steps`: the steps of that. `checked_by`: other
    checkers, as in a claim. `timed`: it is for every H that depends on time. `degrees` of freedom:
    where there are several, order and leading coefficient are those of S.
    """

    scheme: str
    quantifier: str
    timed: bool = False
    degrees: int = 1
    verdict: Verdict
    reason: ProseText
    order: int | None
    area_preserving: bool | None
    convergence_order: int | None
    convergence_decided: bool = True
    formula: str
    leading: str
    telescopes: bool | None
    potential: str | None
    why: ProseText
    checked: tuple[ProseText, ...]
    conditions: tuple[Condition, ...] = ()
    argument: ProseText
    steps: tuple[StepResult, ...] = ()
    checked_by: tuple[ProseText, ...] = ()
