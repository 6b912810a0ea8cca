"""Proofs for every smooth H by the series of a step in H's derivatives: orders, S, telescoping.

In the plane S = JᵀΩJ − Ω is ΔJ dp∧dq, and its one entry stands for it. What is zero is a polynomial
in H's derivatives that is the zero polynomial: machine-checked. What is not zero is one that is
not, and some polynomial H gives it a value other than 0.

lieη, of any η and in n degrees of freedom: the exact flow preserves Ω, and lieη shares its terms up
to h^η, so that S begins with −h^(η+1)/(η+1)! ([η+1, 0] + [0, η+1]); see
`verify.proof.telescoping`.
"""

import math
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

from verify.algebra.generator import Poly
from verify.algebra.series.jets import Jets
from verify.algebra.series.power_series import Series
from verify.hamiltonians.jet_flow import JetFlow
from verify.proof.by_conditions import first_wrong
from verify.proof.every_proof import EveryProof
from verify.proof.telescoping import potential_of_lie, telescopes
from verify.prose import Formula, Prose, joined, prose, read_prose
from verify.schemes.conditions.condition import Condition
from verify.schemes.conditions.every_hamiltonian import BySeries, TaylorSeries
from verify.schemes.maps import kind_of
from verify.schemes.scheme import Scheme
from verify.schemes.steps.defect import DefectSeries
from verify.schemes.steps.two_form import TwoForm, lie_derivative
from verify.structures import AREA, SYMPLECTIC
from verify.verdict import Verdict

_MORE = {AREA: 3, SYMPLECTIC: 0}  # orders that are looked at beyond the first of S
_SAME = "A J = B with det A = det B = "  # what a condition on stages of the plane begins with
_MOST_TERMS = {AREA: math.inf, SYMPLECTIC: 5000}  # (2n)^order, about those of X^order z


def is_long(proof: EveryProof, order: int) -> bool:
    """Whether the terms of X^order z are too many in so many degrees of freedom."""
    return bool((2 * proof.degrees + proof.timed) ** order > _MOST_TERMS[proof.structure])


def series_in_jets(proof: EveryProof, every_h: BySeries, most: int) -> DefectSeries[JetFlow]:
    """The coefficients of z' up to h^most, and those of S, for every H that the proof is of."""
    flow = JetFlow.of_degrees(proof.degrees, most + 1, separable=proof.separable, timed=proof.timed)
    state = tuple(Series(flow.ring, tuple(x)) for x in every_h.taylor(flow.ring, most))
    return DefectSeries(lambda _: (flow, state), most)


def prove_by_series(blank: EveryProof, scheme: Scheme, every_h: BySeries) -> EveryProof:
    """The proof for every H that `blank` is to be of; REFUTED where the scheme claims more."""
    most, last = scheme.order + 1, scheme.order + 1 + _MORE[blank.structure]
    own = kind_of(every_h, scheme.name).conditions(every_h, blank.degrees)
    preserved = bool(own) and first_wrong(own) is None
    while True:
        series = series_in_jets(blank, every_h, most)
        order = next((m for m in range(1, most + 1) if series.form(m).entries), None)
        if preserved or order is not None or most == last:
            break
        most += 1
    agreed = next((n - 1 for n in range(most + 1) if not series.agrees(n)[0]), most)
    found = replace(blank, convergence_order=agreed, convergence_decided=agreed < most)
    if preserved:
        return _held_to(scheme, _symplectic(found, own))
    if order is not None:
        return _held_to(scheme, _leading(found, series, every_h, order))
    said = f"the coefficients of {blank.structure.defect} up to `h^{most}` vanish"
    undecided = read_prose(f"{said}; whether all do is not decided")
    return _held_to(scheme, replace(found, reason=undecided))


def _held_to(scheme: Scheme, found: EveryProof) -> EveryProof:
    """REFUTED where the scheme claims more."""
    agreed = found.convergence_order
    if agreed is not None and agreed < scheme.order:
        return replace(found, verdict=Verdict.REFUTED, reason=missed(scheme, agreed))
    if scheme.area_preserving and found.symplectic is False:
        what = found.structure
        said = f"{scheme.name} claims {what.claim}; {what.defect} has order {found.order}"
        return replace(found, verdict=Verdict.REFUTED, reason=prose(said))
    return found


def missed(scheme: Scheme, agreed: int) -> Prose:
    """That it claims a higher order than the map's for every H."""
    return read_prose(
        f"{scheme.name} claims order {scheme.order}; for a generic H the map agrees with the exact "
        f"flow up to `h^{agreed}` only"
    )


# -- where S vanishes -----------------------------------------------------------------------------


def _symplectic(found: EveryProof, own: tuple[Condition, ...]) -> EveryProof:
    """Of stages that are solved for: S ≡ 0 by what their coefficients fulfil."""
    reason = prose(f"{found.structure.vanishes}, stage by stage")
    found = replace(found, verdict=Verdict.PROVED, reason=reason, area_preserving=True)
    if not found.planar:  # where a condition is no identity in H_pp, H_pq and H_qq
        return replace(found, telescopes=True, potential="0", conditions=own)
    names = (condition.name for condition in own)
    ratios = joined(", ", dict.fromkeys(Formula(name.removeprefix(_SAME)) for name in names))
    read = read_prose(" (a, b, c = `H_pp`, `H_pq`, `H_qq`)")
    return replace(found, checked=(prose(_SAME, ratios, read),))


# -- where it does not ----------------------------------------------------------------------------


def _leading(
    found: EveryProof, series: DefectSeries[JetFlow], every_h: BySeries, order: int
) -> EveryProof:
    """With the coefficient of h^order, the first in S that is not the zero form."""
    form, defect = series.form(order), found.structure.defect
    volume = form.divergence
    below = {
        AREA: f"the coefficients of h¹ … `h^{order - 1}` in det J are the zero polynomial",
        SYMPLECTIC: f"the entries of S up to `h^{order - 1}` are zero polynomials",
    }[found.structure]
    found = replace(
        found,
        verdict=Verdict.PROVED,
        reason=read_prose(
            f"the coefficients of {defect} below `h^{order}` vanish for every H, that of "
            f"`h^{order}` does not"
        ),
        order=order,
        form=form,
        area_preserving=None if volume.is_zero() else False,
        volume_order=None if volume.is_zero() else order,
        volume_leading=series.flow.ring.text(volume),
        entry=form.called(next(iter(form.entries))),
        checked=(read_prose(below),) if order > 1 else (),
    )
    found = _telescoping(found, series.flow, every_h, form)
    return replace(found, leading=found.written(form, found.formula))


def _telescoping(found: EveryProof, flow: JetFlow, every_h: BySeries, form: TwoForm) -> EveryProof:
    """Whether the leading coefficient is a Lie derivative, by the formula where there is one."""
    lie = isinstance(every_h, TaylorSeries)
    if isinstance(every_h, TaylorSeries):
        found = _of_lie(found, flow, every_h.eta, form)
    if found.telescopes:
        return found
    ring = flow.ring
    if isinstance(ring, Jets):  # of the plane
        known = telescopes(ring, form.at(0, 1))
        found = replace(found, telescopes=known.holds, why=known.reason)
        if known.potential is None:
            return found
        potential = TwoForm(ring, flow.names, {(0, 1): known.potential})
        return replace(found, potential=found.written(potential), potential_form=potential)
    if not lie or form.divergence.subs(flow.at_rest).is_zero():
        return found
    why = prose("where f vanishes a Lie derivative has no divergence, and this has one")
    return replace(found, telescopes=False, why=why)


class _OfLie(NamedTuple):
    """How the leading coefficient of lieη and its potential are told, and what is checked."""

    formula: str
    first: Prose
    potential: Prose
    second: Prose


def _told_in_plane(by: str, eta: int) -> _OfLie:
    potential = (
        f"G = −1/{eta + 1}! `Σ_k` `(−1)^k` ∂(`{by}^({eta}−k)` p, `{by}^k` q)/∂(p, q), k = 0 … {eta}"
    )
    return _OfLie(
        f"-div({by}^{eta} f)/{eta + 1}!, f = (-H_q, H_p)",
        read_prose(f"that of `h^{eta + 1}` is −div(`{by}^{eta}` f)/{eta + 1}!"),
        read_prose(potential),
        prose(f"{by}·G is that coefficient"),
    )


def _told_in_degrees(by: str, eta: int) -> _OfLie:
    formula = f"−1/{eta + 1}! Σ_i (d({by}^{eta + 1} p_i)∧dq_i + dp_i∧d({by}^{eta + 1} q_i))"
    terms = f"Σ_k (−1)^k Σ_i d({by}^({eta}−k) p_i)∧d({by}^k q_i), k = 0 … {eta}"
    return _OfLie(
        formula,
        prose(read_prose(f"that of `h^{eta + 1}` is "), Formula(formula)),
        prose(f"β = −1/{eta + 1}! {terms}"),
        prose("the Lie derivative of β is that coefficient"),
    )


def _of_lie(found: EveryProof, flow: JetFlow, eta: int, form: TwoForm) -> EveryProof:
    """What is known of lieη, each identity checked."""
    tell = {AREA: _told_in_plane, SYMPLECTIC: _told_in_degrees}[found.structure]
    told, short = tell("D" if flow.timed else "X", eta), not is_long(found, eta + 1)
    if found.order == eta + 1 and short and not (_of_flow(flow, eta) - form).entries:
        found = replace(found, formula=told.formula, checked=(*found.checked, told.first))
    if eta % 2:
        return found
    potential = potential_of_lie(flow, eta)
    if (lie_derivative(flow, potential) - form).entries:
        return found
    return replace(
        found,
        telescopes=True,
        potential=found.written(potential, str(told.potential)),
        potential_form=potential,
        why=told.potential,
        checked=(*found.checked, told.second),
    )


def _of_flow(flow: JetFlow, eta: int) -> TwoForm:
    """−1/(η+1)! ([η+1, 0] + [0, η+1]): d of the 1-form Σ_i X^(η+1)p_i dq_i − X^(η+1)q_i dp_i."""
    n, ring, names = flow.degrees, flow.ring, flow.names
    last = flow.power(eta + 1)
    one_form = [*(-x for x in last[n:]), *last[:n]]
    share = ring.constant(Fraction(-1, math.factorial(eta + 1)))

    def entry(a: int, b: int) -> Poly:
        return share * (ring.diff(one_form[b], names[a]) - ring.diff(one_form[a], names[b]))

    return TwoForm.of(ring, names, entry)
