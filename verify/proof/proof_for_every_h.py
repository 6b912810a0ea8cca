"""The result of a proof about one scheme for every H; see `verify.proof.order_for_every_h`.

For `lieη` an argument on paper accompanies the proof in steps. It is for every η at once, while the
machine's proof is for one η. Each step names the theorems of the shipped theory for Rocq that state
it, by file and name; one step has none.
"""

from dataclasses import dataclass, field

from verify.algebra.domain import EVERYWHERE, FormulaDomain
from verify.prose import Prose, join_prose, read_prose
from verify.schemes import get
from verify.schemes.conditions.condition import Condition, NearbyOrder
from verify.schemes.conditions.every_hamiltonian import TaylorSeries
from verify.schemes.maps.step_map import solvable
from verify.schemes.steps.two_form import MOST_TERMS, TwoForm
from verify.structures import AREA, SYMPLECTIC, CanonicalForm, structure_in
from verify.verdict import Verdict

NONE = Prose()
STEPS: tuple[tuple[str, tuple[str, ...]], ...] = (
    (
        "The exact flow has det 1: the coefficients of h, h², … in the determinant of its "
        "series vanish.",
        ("Taylor.flow_has_no_defect",),
    ),
    (
        "The scheme shares its terms up to `h^η`, so the coefficients of h … `h^η` vanish for "
        "it too.",
        ("Volume.volume_below",),
    ),
    (
        "In that of `h^(η+1)` the flow has one term more, which is linear. With f = (−`H_q`, "
        "`H_p`) the scheme’s coefficient is ``L = −div(X^η f)/(η+1)!``.",
        ("Theorems.determinant_of_lie_in_plane",),
    ),
    (
        "For even η it is X·G with `P_(a, b)` = ∂(Xᵃp, `X^b` q)/∂(p, q) and ``G = −1/(η+1)! "
        "Σ_{k=0}^{η} (−1)^k P_{η−k, k}``: in X·G all terms but the ends cancel.",
        ("Theorems.lie_telescopes_in_plane_for_even",),
    ),
    (
        "Along an orbit the leading term therefore sums to a boundary term, and Λ gains one "
        "order in h.",
        (),
    ),
    (
        "For odd η it does not telescope. X·G vanishes at an equilibrium for every smooth G, "
        "and for H = (p² + q²)/2 L is ``2 (−1)^j/(2j+2)!`` there, η = 2j + 1.",
        ("Oscillator.oscillator_first_for_odd", "Theorems.lie_does_not_telescope_for_odd"),
    ),
)


@dataclass(frozen=True)
class ProofForEveryH:
    """A proof about one scheme for every H, if `separable` for every H = T(p) + V(q).

    - `order`, `area_preserving`, `convergence_order`: as in `verify.proof.proof_for_one_h.Proof`,
      for a generic H; `convergence_decided`: True if for some H the order is no higher.
    - `leading`: the coefficient of h^order, a polynomial in H_p, H_q, H_pp, …; `formula`: its
    closed
      form, if there is one.
    - `telescopes`: True if it is X·`potential` for every H; `why` says how that is shown.
    - `checked`: the identities that were checked; `conditions`: the conditions on the coefficients
      of a scheme that is given by them.
    - `timed`: True for H that depend on t, with D = ∂_t + X in place of X.
    - `nearby`: if the scheme's coefficients are printed decimals, the order of exact ones near
    them.

    In several `degrees` of freedom order, leading coefficient and potential are those of S;
    `leading` is the formula if there are too many terms; `entry` is an entry of S that is not 0;
    `volume_order` and `volume_leading` are those of det J − 1. `form` and `potential_form` are the
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
    def structure(self) -> CanonicalForm:
        """The structure that a canonical step preserves: area, or the symplectic form."""
        return structure_in(self.degrees)

    def format_form(self, form: TwoForm, formula: str = "") -> str:
        """Format a 2-form, in the plane its one entry; return `formula` if it is too long."""
        if self.planar:
            return str(form.ring.text(form.divergence))
        return formula if formula and form.length > MOST_TERMS else form.text

    @property
    def symplectic(self) -> bool | None:
        """True if S ≡ 0, which in the plane means that area is preserved; None if undecided."""
        return self.area_preserving if self.order is None else False

    @property
    def argument(self) -> Prose:
        """The argument on paper for every η; empty if there is none for this scheme."""
        taylor = isinstance(get(self.scheme).every_h, TaylorSeries)
        # The argument is about X and dp∧dq, and not about D or n degrees of freedom.
        return _paragraph() if taylor and self.planar and not self.timed else NONE

    @property
    def domain(self) -> FormulaDomain:
        """The domain of the statement, for an H that is smooth wherever the step evaluates it."""
        explicit = get(self.scheme).explicit
        # The equations of an implicit step need a smooth solution, which is a condition of its own.
        return (
            EVERYWHERE
            if explicit
            else FormulaDomain.from_requirements((), solvable(self.structure))
        )

    @property
    def quantifier(self) -> str:
        """The class of H that the proof is about, in words."""
        t = ", t" * self.timed
        general, degrees = {
            AREA: ("H(p, q, t)" if self.timed else "H", ""),
            SYMPLECTIC: (f"H(p, q{t})", f" in {self.degrees} degrees of freedom"),
        }[self.structure]
        return f"every smooth {f'H = T(p{t}) + V(q{t})' if self.separable else general}{degrees}"


def _paragraph() -> Prose:
    """Join the steps of the argument into one paragraph."""
    return join_prose(" ", [*(read_prose(text) for text, _ in STEPS), "∎"])
