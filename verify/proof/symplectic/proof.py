"""What is proved of one step map in n degrees of freedom; see `verify.proof.symplectic.order`."""

from dataclasses import dataclass, field
from fractions import Fraction

from verify.algebra.conditions import Condition
from verify.algebra.domain import Domain
from verify.proof.symplectic.two_form import TwoForm
from verify.prose import Prose
from verify.verdict import Verdict


@dataclass(frozen=True)
class SymplecticProof:
    """What is proved of one step map.

    `order`: S = `leading`·h^order + O(h^(order+1)), `leading` not the zero form; None where S ≡ 0
    (`symplectic` True) or where it is not decided (None). `entry`: the one that is not 0 at
    `witness`, where it has the value `enclosure`. `area_preserving`: whether det J ≡ 1, which every
    symplectic map fulfils and some others do; `volume_order` and `volume_leading` are those of
    det J − 1. `convergence_order`: z' agrees with the exact flow up to h to this power; None: in
    all that was looked at. `telescopes`: whether `leading` is the Lie derivative of a 2-form,
    `potential`; None where that is not known.
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
    conditions: tuple[Condition, ...] = ()

    @property
    def leading_text(self) -> str:
        """The leading coefficient of S as a formula."""
        return self.leading.text if self.leading else "0"
