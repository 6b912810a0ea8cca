"""The result of a proof about one step map, and its verdict on the claims of the scheme.

`verify.proof.order_for_one_h` makes such proofs.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction

import sympy

from verify.algebra.domain import EVERYWHERE, FormulaDomain
from verify.arithmetic.exact import text
from verify.notebook import aligned_latex, cut, html_table, short_latex
from verify.proof.expansion import Leading
from verify.prose import Prose, read_prose
from verify.schemes.conditions.condition import Condition, NearbyOrder
from verify.schemes.maps.step_map import StepMap
from verify.schemes.scheme import Scheme
from verify.structures import CanonicalForm
from verify.verdict import Verdict


@dataclass(frozen=True)
class Proof:
    """A proof about one step map.

    - `verdict`: REFUTED for a map that is not a scheme for H at all, and if the scheme claims more
      than the map has; `reason` gives the result in one line.
    - `first`: the leading coefficient of S; in the plane that of ΔJ.
    - `volume`: that of det J − 1, in the plane the same; its `decision.zero` is True if det J ≡ 1,
      as for every symplectic map and some others.
    - `convergence_order`: z' agrees with the exact flow up to this power of h; None if all examined
      coefficients agree. `convergence_decided`: True if it is shown to agree no further.
    - `nearby`: if the scheme's coefficients are printed decimals, the order of exact ones near
    them.
    - `telescopes`: True if the leading coefficient of S is the Lie derivative of the 2-form
      `potential`; None if undecided.
    """

    verdict: Verdict
    reason: Prose
    step_map: StepMap = field(repr=False, compare=False)
    first: Leading
    volume: Leading
    convergence_order: int | None
    convergence_decided: bool = True
    telescopes: bool | None = None
    potential: str = ""
    nearby: NearbyOrder | None = None
    # A proof for every H has these too; in a proof for one H they are empty.
    formula: str = ""
    why: str = ""
    checked: tuple[Prose, ...] = ()

    @property
    def planar(self) -> bool:
        """True if the map is one of the plane, of p and q."""
        return self.step_map.hamiltonian.planar

    @property
    def structure(self) -> CanonicalForm:
        """The structure that a canonical step preserves: area, or the symplectic form."""
        return self.step_map.structure

    @property
    def degrees(self) -> int:
        """The number of degrees of freedom."""
        return self.step_map.degrees

    @property
    def order(self) -> int | None:
        """The order in h of S, in the plane of ΔJ; None if it vanishes or is not decided.

        S = `leading`·h^order + O(h^(order+1)), with `leading` not zero.
        """
        # If the coefficient is not proved to be nonzero, `power` is only where the search stopped.
        return self.first.power if self.first.decision.zero is False else None

    @property
    def symplectic(self) -> bool | None:
        """True if S ≡ 0; None if that is not decided."""
        return self.first.decision.zero

    @property
    def area_preserving(self) -> bool | None:
        """True if det J ≡ 1; None if that is not decided."""
        return self.volume.decision.zero

    @property
    def witness(self) -> dict[str, Fraction]:
        """A point (z, parameters) at which `leading`, or its `entry`, is not zero."""
        return self.first.decision.witness

    @property
    def enclosure(self) -> str:
        """The enclosure of the leading coefficient at the witness."""
        return self.first.decision.enclosure

    @property
    def entry(self) -> str:
        """The entry of S that is not 0 at the witness; empty in the plane."""
        return self.first.entry

    @property
    def volume_order(self) -> int | None:
        """The order in h of det J − 1; None if no coefficient is shown to be nonzero."""
        return self.volume.power if self.volume.decision.zero is False else None

    @property
    def volume_leading(self) -> str:
        """The leading coefficient of det J − 1 as a formula."""
        return self.volume.text

    @property
    def conditions(self) -> tuple[Condition, ...]:
        """The conditions on the scheme's coefficients by which the map is symplectic, if any."""
        return self.step_map.conditions

    @property
    def leading(self) -> sympy.Expr:
        """The coefficient in `first` as an expression; 0 if there is none."""
        return self.first.coefficient

    @property
    def leading_text(self) -> str:
        """The leading coefficient as a formula."""
        return self.first.text

    @property
    def delta_j(self) -> sympy.Expr | None:
        """ΔJ in closed form, computed when it is first used; None if it is too large."""
        return self.step_map.delta_j if self.step_map.has_closed_form else None

    @property
    def domain(self) -> FormulaDomain:
        """The domain where the map is smooth and `leading` is not the zero function of z."""
        # As a function of z, `leading` may be 0 for single values of the parameters.
        return self.step_map.domain & self.first.domain

    @property
    def consistent(self) -> bool:
        """True if the map agrees with the exact flow up to h, at least."""
        return self.convergence_order is None or self.convergence_order >= 1

    def __repr__(self) -> str:
        return f"Proof({self.verdict}: {cut(str(self.reason))})"

    def _repr_html_(self) -> str:
        return html_table("Proof", (), _rows(self))

    def _repr_latex_(self) -> str:
        return aligned_latex(_latex_lines(self))


def _rows(proof: Proof) -> list[tuple[str, str]]:
    """Return the table's rows: verdict, orders, leading coefficient, witness, closed form."""
    closed = proof.step_map.delta_j_text
    rows = [("verdict", f"{proof.verdict}: {proof.reason}")]
    if proof.area_preserving:
        rows.append(("area", "det J ≡ 1: the map preserves area exactly"))
    if proof.order is not None:
        point = ", ".join(f"{name} = {text(value)}" for name, value in proof.witness.items())
        rows += [
            ("order of ΔJ", str(proof.order)),
            ("leading coefficient", cut(proof.first.text)),
            (f"its value at {point or 'any point'}", proof.enclosure),
        ]
    rows.append(("ΔJ in closed form", "too large; left out" if closed is None else cut(closed)))
    order = proof.convergence_order
    agrees = "agrees with the exact flow in every power of h looked at" if order is None else order
    rows.append(("order of the map", str(agrees)))
    return rows


def _latex_lines(proof: Proof) -> list[str]:
    """Return ΔJ by its leading term and in closed form, or det J ≡ 1 where that is proved."""
    lines = []
    if proof.area_preserving:
        lines.append(r"\det J &\equiv 1")
    if proof.order is not None:
        n = proof.order
        power = "h" if n == 1 else f"h^{{{n}}}"
        lead = short_latex(sympy.latex(proof.leading))
        lines.append(rf"\Delta J &= \left({lead}\right) {power} + O(h^{{{n + 1}}})")
    closed = proof.delta_j
    if closed is not None and not proof.area_preserving:
        lines.append(rf"\Delta J &= {short_latex(sympy.latex(closed))}")
    if not lines:
        lines.append(r"\Delta J &= \text{undecided}")
    return lines


# -- the verdict on a scheme's claims -------------------------------------------------------------


@dataclass(frozen=True)
class Convergence:
    """The power of h up to which p' and q' agree with the exact flow, shown by algebra.

    `order` is None if all examined coefficients agree, and −1 if they differ at h⁰. `decided`: True
    if the next coefficient is shown to differ, or all are shown to agree; `exact_for()`: the
    parameters for which it differs.
    """

    order: int | None
    decided: bool
    exact_for: Callable[[], FormulaDomain] = field(default=lambda: EVERYWHERE, repr=False)

    def misses(self, claimed: int) -> bool:
        return self.order is not None and self.order < claimed


@dataclass(frozen=True)
class SchemeClaims:
    """The claims about a map: its order, and whether it is symplectic.

    `name`: the scheme's name; empty for a map without a scheme.
    """

    name: str = ""
    order: int = 1
    symplectic: bool = False

    @classmethod
    def from_scheme(cls, scheme: Scheme) -> "SchemeClaims":
        """Return the claims of a scheme; backquotes surround a name that is a user's formulas."""
        name = f"`{scheme.name}`" if "=" in scheme.name else scheme.name
        return cls(name, scheme.order, scheme.area_preserving)


def judge_claims(
    claimed: SchemeClaims,
    convergence: Convergence,
    defect: tuple[int | None, bool | None],
    most: int,
    structure: CanonicalForm,
) -> tuple[Verdict, Prose]:
    """Return the verdict on the claims, and the reason for it.

    `defect`: the power of h, up to h^`most`, in the first coefficient of the defect that is not
    shown to vanish; and True if the defect is zero, False if not, None if undecided.
    """
    verdict, reason = _judge_order(claimed, convergence) or _judge_defect(
        claimed, *defect, most, structure
    )
    return verdict, read_prose(reason)


def _judge_order(claimed: SchemeClaims, convergence: Convergence) -> tuple[Verdict, str] | None:
    """Return the verdict if the map is not shown to have the claimed order; else None."""
    if not convergence.misses(claimed.order):
        return None
    agreement = f"agrees with the exact flow up to `h^{convergence.order}`"
    if convergence.order == -1:
        agreement = "agrees with the exact flow not even at h = 0"
    if not convergence.decided:
        return Verdict.UNDECIDED, f"the map {agreement}; whether further is not decided"
    if claimed.name:
        claims = f"{claimed.name} claims order {claimed.order}"
        return Verdict.REFUTED, f"{claims}; the map {agreement} only"
    # A map without a scheme claims order 1: a map that misses it does not approximate the flow.
    only = "" if convergence.order == -1 else " only"
    return Verdict.REFUTED, f"not a scheme for this H: the map {agreement}{only}"


def _judge_defect(
    claimed: SchemeClaims, power: int | None, zero: bool | None, most: int, structure: CanonicalForm
) -> tuple[Verdict, str]:
    name = structure.symbol
    if zero:
        return Verdict.PROVED, structure.vanishes
    if zero is None:
        what = f"of `h^{power}`" if power is not None else f"beyond `h^{most}`"
        sentence = f"the coefficient {what} in {name} is neither shown to vanish nor not to"
        return Verdict.UNDECIDED, sentence
    not_zero = (
        f"{name} is not the zero {structure.zero}, and its coefficients up to `h^{most}` vanish"
    )
    if claimed.symplectic:
        fact = not_zero if power is None else f"{name} has order {power}"
        return Verdict.REFUTED, f"{claimed.name} claims {structure.claim}; {fact}"
    if power is None:
        return Verdict.PROVED, not_zero
    return Verdict.PROVED, (
        f"the coefficients of {name} below `h^{power}` vanish identically, that of `h^{power}` "
        "does not"
    )
