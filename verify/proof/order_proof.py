"""What is proved of one step map; see `verify.proof.order`."""

from dataclasses import dataclass, field
from fractions import Fraction

import sympy

from verify.algebra.domain import Domain
from verify.arithmetic.exact import text
from verify.notebook import aligned_latex, cut, html_table, short_latex
from verify.proof.expansion import Leading
from verify.prose import Prose
from verify.schemes.step_map import StepMap
from verify.verdict import Verdict


@dataclass(frozen=True)
class Proof:
    """What is proved of one step map.

    `order`: ΔJ = `leading`·h^order + O(h^(order+1)) with `leading` not the zero function; None
    where ΔJ ≡ 0 (`area_preserving` True) or where it is not decided (`area_preserving` None).
    `witness`: a point (p, q, parameters) at which `leading` is not zero; `enclosure`: its value.
    `convergence_order`: p', q' agree with the exact flow up to h to this power; None where all
    coefficients looked at agree. `convergence_decided`: whether it is shown to agree no further.
    `verdict` is REFUTED for a map that is not a scheme for H at all, or misses the order its
    scheme claims; `reason` says what was found in one line.
    """

    verdict: Verdict
    reason: Prose
    order: int | None
    first: Leading
    area_preserving: bool | None
    convergence_order: int | None
    step_map: StepMap = field(repr=False, compare=False)
    witness: dict[str, Fraction] = field(default_factory=dict)
    enclosure: str = ""
    convergence_decided: bool = True

    @property
    def leading(self) -> sympy.Expr:
        """The leading coefficient of ΔJ as an expression; 0 where ΔJ ≡ 0."""
        return self.first.coefficient

    @property
    def leading_text(self) -> str:
        """The same as a formula."""
        return self.first.text

    @property
    def symplectic(self) -> bool | None:
        """Whether det J ≡ 1, which in the plane is that."""
        return self.area_preserving

    @property
    def delta_j(self) -> sympy.Expr | None:
        """ΔJ in closed form, written out when it is asked for; None where it is too large."""
        return self.step_map.delta_j if self.step_map.has_closed_form else None

    @property
    def domain(self) -> Domain:
        """Where it holds: where the map is defined, and `leading` is not zero for all p and q."""
        return self.step_map.domain & self.first.domain

    @property
    def consistent(self) -> bool:
        """Whether the map agrees with the exact flow up to h, at least."""
        return self.convergence_order is None or self.convergence_order >= 1

    def __repr__(self) -> str:
        return f"Proof({self.verdict}: {cut(str(self.reason))})"

    def _repr_html_(self) -> str:
        return html_table("Proof", (), _rows(self))

    def _repr_latex_(self) -> str:
        return aligned_latex(_latex_lines(self))


def _rows(proof: Proof) -> list[tuple[str, str]]:
    """Verdict, order, leading coefficient, closed form, witness, order of the map."""
    closed = proof.step_map.delta_j_text
    rows = [("verdict", f"{proof.verdict}: {proof.reason}")]
    if proof.area_preserving:
        rows.append(("area", "det J ≡ 1: the map preserves area exactly"))
    if proof.order is not None:
        at = ", ".join(f"{name} = {text(value)}" for name, value in proof.witness.items())
        rows += [
            ("order of ΔJ", str(proof.order)),
            ("leading coefficient", cut(proof.first.text)),
            (f"its value at {at or 'any point'}", proof.enclosure),
        ]
    rows.append(("ΔJ in closed form", "too large; left out" if closed is None else cut(closed)))
    order = proof.convergence_order
    agrees = "agrees with the exact flow in every power of h looked at" if order is None else order
    rows.append(("order of the map", str(agrees)))
    return rows


def _latex_lines(proof: Proof) -> list[str]:
    """ΔJ by its leading term and in closed form; det J ≡ 1 where that is proved."""
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
