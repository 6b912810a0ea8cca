"""What is proved of one scheme for every H; see `verify.proof.every`."""

from dataclasses import dataclass

from verify.algebra.conditions import Condition
from verify.algebra.domain import EVERYWHERE, Domain
from verify.prose import Prose, read_prose
from verify.schemes import get
from verify.schemes.every_hamiltonian import TaylorSeries
from verify.schemes.step_map import SOLVABLE
from verify.verdict import Verdict

NONE = Prose()
ARGUMENT = read_prose(
    "For any η: the exact flow has det 1, so that all coefficients of h, h², … in its determinant "
    "vanish. The scheme shares its terms up to `h^η`, so the coefficients of h … `h^η` vanish for "
    "it too. In that of `h^(η+1)` the flow has one term more, which is linear: div(`X^η` f)/(η+1)!,"
    " f = (−`H_q`, `H_p`); the scheme's coefficient is L = −div(`X^η` f)/(η+1)!. For even η it is "
    "X·G, G = −1/(η+1)! `Σ_k` `(−1)^k` `P_(η−k, k)`, k = 0 … η, `P_(a, b)` = ∂(Xᵃp, `X^b` "
    "q)/∂(p, q): the two-forms [a, b] = d(Xᵃp)∧d(`X^b` q) + d(`X^b` p)∧d(Xᵃq) are symmetric, the "
    "Lie derivative takes [a, b] to [a+1, b] + [a, b+1], so that in its alternating sum over a + b "
    "= η all but 2 [η+1, 0] cancel, and [η+1, 0] is div(`X^η` f) dp∧dq. Along an orbit the leading "
    "term therefore sums to a boundary term, and Λ gains one order in h. For odd η it does not: "
    "X·G vanishes at an equilibrium for every smooth G, and L is −2 `(−D)^((η+1)/2)`/(η+1)! there, "
    "D = det Hess H. ∎"
)


@dataclass(frozen=True)
class EveryProof:
    """What is proved of one scheme for every H (`separable`: every H = T(p) + V(q)).

    `order`, `area_preserving`, `convergence_order` as in `verify.proof.order.Proof`, for a generic
    H, and `convergence_decided`: of some H it is no higher; `leading` is the coefficient of
    h^order, a polynomial in H_p, H_q, H_pp, …, and `formula` what it is in closed form, where that
    is known. `telescopes`: whether it is X·`potential` for every H, `why` says how that is known.
    `checked` names the identities that were checked, `conditions` those on the coefficients, of a
    scheme that is given by them. `timed`: for every such H that depends on t, with D = ∂_t + X in
    place of X.
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

    @property
    def argument(self) -> Prose:
        """What is proved on paper beside what the machine checked; see the module's text."""
        if isinstance(get(self.scheme).every_h, TaylorSeries) and not self.timed:
            return ARGUMENT
        return NONE

    @property
    def domain(self) -> Domain:
        """Where it holds, beside where H is smooth."""
        return EVERYWHERE if get(self.scheme).explicit else Domain.of((), SOLVABLE)

    @property
    def quantifier(self) -> str:
        """For which H it is proved, in words."""
        if self.timed:
            form = "T(p, t) + V(q, t)" if self.separable else "H(p, q, t)"
            return f"every smooth {'H = ' * self.separable}{form}"
        return "every smooth H = T(p) + V(q)" if self.separable else "every smooth H"
