"""The result of a proof about one scheme for every H; see `verify.proof.every`."""

from dataclasses import dataclass, field

from verify.algebra.domain import EVERYWHERE, Domain
from verify.proof.lie_argument import paragraph
from verify.prose import Prose
from verify.schemes import get
from verify.schemes.conditions.condition import Condition, NearbyOrder
from verify.schemes.conditions.every_hamiltonian import TaylorSeries
from verify.schemes.maps.step_map import solvable
from verify.schemes.steps.two_form import MOST_TERMS, TwoForm
from verify.structures import AREA, SYMPLECTIC, Structure, structure_in
from verify.verdict import Verdict

NONE = Prose()


@dataclass(frozen=True)
class EveryProof:
    """A proof about one scheme for every H (`separable`: every H = T(p) + V(q)).

    `order`, `area_preserving`, `convergence_order` as in `verify.proof.order.Proof`, for a generic
    H, and `convergence_decided`: of some H it is no higher; `leading` is the coefficient of
    h^order, a polynomial in H_p, H_q, H_pp, …, empty where it is not written out, and `formula`
    its closed form, where there is one. `telescopes`: whether it is X·`potential` for every H;
    `why` says how that is shown.
    `checked` names the identities that were checked, `conditions` those on the coefficients, of a
    scheme that is given by them. `timed`: for every such H that depends on t, with D = ∂_t + X in
    place of X. `nearby`: the exact coefficients that have this order, where those of the scheme are
    printed, rounded.

    In several `degrees` of freedom order, leading coefficient and potential are those of S, and
    `leading` is the formula where it has too many terms; `entry` is one of S that is not 0,
    `volume_order` and `volume_leading` are of det J − 1. `form` and `potential_form` are the
    leading coefficient and its potential as 2-forms.
    """

    scheme: str
    separable: bool
    verdict: Verdict
    reason: Prose
    order: int | None = None
    area_preserving: bool | None = None
    convergence_order: int | None = None
    convergence_decided: bool = True
    leading: str = "0"
    formula: str = ""
    telescopes: bool | None = None
    potential: str | None = None
    why: Prose = NONE
    checked: tuple[Prose, ...] = ()
    conditions: tuple[Condition, ...] = ()
    timed: bool = False
    nearby: NearbyOrder | None = None
    degrees: int = 1
    entry: str = ""
    volume_order: int | None = None
    volume_leading: str = "0"
    form: TwoForm | None = field(default=None, repr=False, compare=False)
    potential_form: TwoForm | None = field(default=None, repr=False, compare=False)

    @property
    def leading_text(self) -> str:
        """The same as `leading`, under the name that proofs for one H use."""
        return self.leading

    @property
    def planar(self) -> bool:
        """True if there is one degree of freedom."""
        return self.degrees == 1

    @property
    def structure(self) -> Structure:
        """The structure that a canonical step preserves: area, or the symplectic form."""
        return structure_in(self.degrees)

    def format_form(self, form: TwoForm, formula: str = "") -> str:
        """Format a 2-form, in the plane its one entry; `formula` where it has too many terms."""
        if self.planar:
            return str(form.ring.text(form.divergence))
        return formula if formula and form.length > MOST_TERMS else form.text

    @property
    def symplectic(self) -> bool | None:
        """True if S ≡ 0, which in the plane means that area is preserved; None if undecided."""
        return self.area_preserving if self.order is None else False

    @property
    def argument(self) -> Prose:
        """The argument on paper for every η; empty where there is none for this scheme."""
        taylor = isinstance(get(self.scheme).every_h, TaylorSeries)  # the argument is of p and q
        # The argument on paper speaks of X and of dp∧dq; it is not given for D or n degrees of
        # freedom.
        return paragraph() if taylor and self.planar and not self.timed else NONE

    @property
    def domain(self) -> Domain:
        """The domain where it holds, H being smooth at every point and time where it is taken."""
        explicit = get(self.scheme).explicit
        # The equations of an implicit step need a smooth solution, which is a condition of its own.
        return EVERYWHERE if explicit else Domain.from_requirements((), solvable(self.structure))

    @property
    def quantifier(self) -> str:
        """The class of H for which it is proved, in words."""
        t = ", t" * self.timed
        general, degrees = {
            AREA: ("H(p, q, t)" if self.timed else "H", ""),
            SYMPLECTIC: (f"H(p, q{t})", f" in {self.degrees} degrees of freedom"),
        }[self.structure]
        return f"every smooth {f'H = T(p{t}) + V(q{t})' if self.separable else general}{degrees}"
