"""What is proved of one step map in n degrees of freedom; see `verify.proof.symplectic.order`."""

from dataclasses import dataclass, field
from fractions import Fraction

from verify.algebra.domain import Domain
from verify.notebook import cut
from verify.prose import Prose
from verify.schemes.conditions import Condition, NearbyOrder
from verify.schemes.degrees.two_form import MOST_TERMS, TwoForm
from verify.verdict import Verdict


@dataclass(frozen=True)
class SymplecticProof:
    """What is proved of one step map.

    `order`: S = `leading`·h^order + O(h^(order+1)), `leading` not the zero form; None where S ≡ 0
    (`symplectic` True) or where it is not decided (None). `entry`: the one that is not 0 at
    `witness`, where it has the value `enclosure`. `area_preserving`: whether det J ≡ 1, which every
    symplectic map fulfils and some others do; `volume_order` and `volume_leading` are those of
    det J − 1. `convergence_order`: z' agrees with the exact flow up to h to this power; None: in
    all that was looked at; `convergence_decided`: whether it is shown to agree no further;
    `nearby`: of which coefficients, where those of the scheme are printed and leave residues.
    `telescopes`: whether `leading` is the Lie derivative of a 2-form,
    `potential`; None where that is not known; `why` says how it is.
    `formula`: what `leading` is of lieη, for any η. `checked` names the identities
    that were checked, of a proof for every H.
    """

    verdict: Verdict
    reason: Prose
    degrees: int
    order: int | None
    leading: TwoForm | None
    symplectic: bool | None
    area_preserving: bool | None
    volume_order: int | None
    volume_leading: str
    convergence_order: int | None
    domain: Domain
    entry: str = ""
    witness: dict[str, Fraction] = field(default_factory=dict)
    enclosure: str = ""
    telescopes: bool | None = None
    potential: str = ""
    formula: str = ""
    why: str = ""
    conditions: tuple[Condition, ...] = ()
    checked: tuple[Prose, ...] = ()
    convergence_decided: bool = True
    nearby: NearbyOrder | None = None

    def __repr__(self) -> str:
        return f"SymplecticProof({self.verdict}: {cut(str(self.reason))})"

    @property
    def leading_text(self) -> str:
        """The leading coefficient of S as a formula: `formula` where its terms are too many."""
        if self.leading is None:
            return "0"
        long = self.leading.length > MOST_TERMS
        return self.formula if long and self.formula else self.leading.text
