"""The result of a proof about one step map; see `verify.proof.order`."""

from dataclasses import dataclass, field
from fractions import Fraction

import sympy

from verify.algebra.domain import Domain
from verify.arithmetic.exact import text
from verify.notebook import aligned_latex, cut, html_table, short_latex
from verify.proof.expansion import Leading
from verify.prose import Prose
from verify.schemes.conditions.condition import Condition, NearbyOrder
from verify.schemes.maps.step_map import StepMap
from verify.structures import Structure
from verify.verdict import Verdict


@dataclass(frozen=True)
class Proof:
    """A proof about one step map.

    `first`: the leading coefficient of S; in the plane that is of ΔJ. `volume`: that of det J − 1,
    which is the same in the plane; `decision.zero` says whether det J ≡ 1, which every symplectic
    map fulfils and some others do.
    `convergence_order`: z' agrees with the exact flow up to h to this power; None where all
    coefficients looked at agree. `convergence_decided`: whether it is shown to agree no further.
    `nearby`: the exact coefficients that have this order, where the scheme's are printed, rounded.
    `telescopes`: whether the leading coefficient of S is the Lie derivative of a 2-form,
    `potential`; None where that is not known.
    `verdict` is REFUTED for a map that is not a scheme for H at all, or misses the order its
    scheme claims; `reason` gives the result in one line.
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
    def structure(self) -> Structure:
        """The structure that a canonical step preserves: area, or the symplectic form."""
        return self.step_map.structure

    @property
    def degrees(self) -> int:
        """The number of degrees of freedom."""
        return self.step_map.degrees

    @property
    def order(self) -> int | None:
        """The order in h of S, in the plane of ΔJ; None where it vanishes or is not decided.

        S = `leading`·h^order + O(h^(order+1)), with `leading` not zero.
        """
        # A power without a proved nonzero coefficient is only where the search stopped.
        return self.first.power if self.first.decision.zero is False else None

    @property
    def symplectic(self) -> bool | None:
        """True if S ≡ 0; None where that is not decided."""
        return self.first.decision.zero

    @property
    def area_preserving(self) -> bool | None:
        """True if det J ≡ 1; None where that is not decided."""
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
        """The order in h of det J − 1, or None where that is not shown to be nonzero."""
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
        """The leading coefficient as an expression, of ΔJ in the plane; 0 where it vanishes."""
        return self.first.coefficient

    @property
    def leading_text(self) -> str:
        """The leading coefficient as a formula."""
        return self.first.text

    @property
    def delta_j(self) -> sympy.Expr | None:
        """ΔJ in closed form, computed when it is first used; None where it is too large."""
        return self.step_map.delta_j if self.step_map.has_closed_form else None

    @property
    def domain(self) -> Domain:
        """The domain where it holds: the map is defined, and `leading` is no zero function of z."""
        # The order needs `leading` ≠ 0 as a function of z, which may fail for single parameter
        # values.
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
