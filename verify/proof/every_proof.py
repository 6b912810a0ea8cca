"""What is proved of one scheme for every H; see `verify.proof.every`."""

from dataclasses import dataclass

from verify.algebra.domain import EVERYWHERE, Domain
from verify.proof.lie_argument import paragraph
from verify.prose import Prose
from verify.schemes import get
from verify.schemes.conditions import Condition, NearbyOrder
from verify.schemes.every_hamiltonian import TaylorSeries
from verify.schemes.step_map import SOLVABLE
from verify.verdict import Verdict

NONE = Prose()


@dataclass(frozen=True)
class EveryProof:
    """What is proved of one scheme for every H (`separable`: every H = T(p) + V(q)).

    `order`, `area_preserving`, `convergence_order` as in `verify.proof.order.Proof`, for a generic
    H, and `convergence_decided`: of some H it is no higher; `leading` is the coefficient of
    h^order, a polynomial in H_p, H_q, H_pp, …, empty where it is not written out, and `formula`
    what it is in closed form, where that is known. `telescopes`: whether it is X·`potential` for
    every H, `why` says how that is known.
    `checked` names the identities that were checked, `conditions` those on the coefficients, of a
    scheme that is given by them. `timed`: for every such H that depends on t, with D = ∂_t + X in
    place of X. `nearby`: of which coefficients it is, where those of the scheme are printed with
    digits that leave residues.
    """

    scheme: str
    separable: bool
    verdict: Verdict
    reason: Prose
    order: int | None
    area_preserving: bool | None
    convergence_order: int | None
    convergence_decided: bool
    leading: str = "0"
    formula: str = ""
    telescopes: bool | None = None
    potential: str | None = None
    why: Prose = NONE
    checked: tuple[Prose, ...] = ()
    conditions: tuple[Condition, ...] = ()
    timed: bool = False
    nearby: NearbyOrder | None = None

    @property
    def argument(self) -> Prose:
        """What is proved on paper, for every η, beside what the machine checked of this one."""
        taylor = isinstance(get(self.scheme).every_h, TaylorSeries)
        return paragraph() if taylor and not self.timed else NONE

    @property
    def domain(self) -> Domain:
        """Where it holds, beside that H is smooth at every point and time at which it is read."""
        return EVERYWHERE if get(self.scheme).explicit else Domain.of((), SOLVABLE)

    @property
    def quantifier(self) -> str:
        """For which H it is proved, in words."""
        if self.timed:
            form = "T(p, t) + V(q, t)" if self.separable else "H(p, q, t)"
            return f"every smooth {'H = ' * self.separable}{form}"
        return "every smooth H = T(p) + V(q)" if self.separable else "every smooth H"
