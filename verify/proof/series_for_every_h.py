"""Proofs for every smooth H by the series of a step in H's derivatives: orders, S, telescoping.

In the plane S = JᵀΩJ − Ω is ΔJ dp∧dq, with ΔJ as its one entry. A coefficient is zero for every H
if it is the zero polynomial in H's derivatives, which the machine checks. If it is another
polynomial, some polynomial H gives it a value other than 0.

lieη, for any η and in n degrees of freedom: the exact flow preserves Ω, and lieη shares its terms
up to h^η, so that S begins with −h^(η+1)/(η+1)! ([η+1, 0] + [0, η+1]), where [a, b] is the 2-form
of `verify.proof.telescoping`.
"""

import math
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

from verify.algebra.identities.polynomials import Poly
from verify.algebra.jets import Jets
from verify.algebra.power_series import Series
from verify.hamiltonians.canonical_field import JetField
from verify.proof.order_conditions import first_wrong
from verify.proof.proof_for_every_h import ProofForEveryH
from verify.proof.telescoping import potential_of_lie, telescopes
from verify.prose import Formula, Prose, join_prose, prose, read_prose
from verify.schemes.conditions.condition import Condition
from verify.schemes.conditions.every_hamiltonian import BySeries, TaylorSeries
from verify.schemes.maps import kind_of
from verify.schemes.scheme import Scheme
from verify.schemes.steps.defect import DefectSeries
from verify.schemes.steps.two_form import TwoForm, lie_derivative
from verify.structures import AREA, SYMPLECTIC
from verify.verdict import Verdict

_EXTRA_ORDERS = {AREA: 3, SYMPLECTIC: 0}  # powers of h tried for S beyond the first possible one
# A condition on a stage in the plane begins so.
_STAGE_CONDITION = "A J = B with det A = det B = "
_MOST_TERMS = {AREA: math.inf, SYMPLECTIC: 5000}  # limit of (2n)^order ≈ the terms of X^order z


def is_long(proof: ProofForEveryH, order: int) -> bool:
    """Return True if X^order z has too many terms in this many degrees of freedom."""
    return bool((2 * proof.degrees + proof.timed) ** order > _MOST_TERMS[proof.structure])


def series_in_jets(proof: ProofForEveryH, every_h: BySeries, most: int) -> DefectSeries[JetField]:
    """Expand z' and S up to h^most, for every H that the proof covers."""
    flow = JetField.with_degrees(
        proof.degrees, most + 1, separable=proof.separable, timed=proof.timed
    )
    state = tuple(Series(flow.ring, tuple(x)) for x in every_h.taylor(flow.ring, most))
    return DefectSeries(lambda _: (flow, state), most)


def prove_by_series(blank: ProofForEveryH, scheme: Scheme, every_h: BySeries) -> ProofForEveryH:
    """Complete the proof `blank` by the series of the step; REFUTED if the scheme claims more."""
    most, last = scheme.order + 1, scheme.order + 1 + _EXTRA_ORDERS[blank.structure]
    conditions = kind_of(every_h, scheme.name).conditions(every_h, blank.degrees)
    preserved = bool(conditions) and first_wrong(conditions) is None
    # S may begin later than the order suggests: a few more powers are tried, each of which
    # multiplies the number of terms.
    while True:
        series = series_in_jets(blank, every_h, most)
        order = next((m for m in range(1, most + 1) if series.form(m).entries), None)
        if preserved or order is not None or most == last:
            break
        most += 1
    # The derivatives of H are free, so agreement in the jets is decided for every H at once.
    agreed = next((n - 1 for n in range(most + 1) if not series.agrees(n)[0]), most)
    proof = replace(blank, convergence_order=agreed, convergence_decided=agreed < most)
    if preserved:
        return _judge_claims(scheme, _with_symplecticity(proof, conditions))
    if order is not None:
        return _judge_claims(scheme, _with_leading(proof, series, every_h, order))
    sentence = f"the coefficients of {blank.structure.symbol} up to `h^{most}` vanish"
    undecided = read_prose(f"{sentence}; whether all do is not decided")
    return _judge_claims(scheme, replace(proof, reason=undecided))


def _judge_claims(scheme: Scheme, proof: ProofForEveryH) -> ProofForEveryH:
    """Return the proof; its verdict becomes REFUTED if it contradicts the scheme's claims."""
    agreed = proof.convergence_order
    if agreed is not None and agreed < scheme.order:
        return replace(proof, verdict=Verdict.REFUTED, reason=describe_missed_order(scheme, agreed))
    if scheme.area_preserving and proof.symplectic is False:
        structure = proof.structure
        sentence = (
            f"{scheme.name} claims {structure.claim}; {structure.symbol} has order {proof.order}"
        )
        return replace(proof, verdict=Verdict.REFUTED, reason=prose(sentence))
    return proof


def describe_missed_order(scheme: Scheme, agreed: int) -> Prose:
    """State that the scheme claims a higher order than the map has for a generic H."""
    return read_prose(
        f"{scheme.name} claims order {scheme.order}; for a generic H the map agrees with the exact "
        f"flow up to `h^{agreed}` only"
    )


# -- if S vanishes --------------------------------------------------------------------------------


def _with_symplecticity(proof: ProofForEveryH, conditions: tuple[Condition, ...]) -> ProofForEveryH:
    """Return the proof that S ≡ 0, by the conditions on the stages' coefficients."""
    reason = prose(f"{proof.structure.vanishes}, stage by stage")
    proof = replace(proof, verdict=Verdict.PROVED, reason=reason, area_preserving=True)
    if not proof.planar:  # the conditions are on coefficients, and not on H_pp, H_pq and H_qq
        return replace(proof, telescopes=True, potential="0", conditions=conditions)
    names = (condition.name for condition in conditions)
    ratios = join_prose(
        ", ", dict.fromkeys(Formula(name.removeprefix(_STAGE_CONDITION)) for name in names)
    )
    explanation = read_prose(" (a, b, c = `H_pp`, `H_pq`, `H_qq`)")
    return replace(proof, checked=(prose(_STAGE_CONDITION, ratios, explanation),))


# -- if S does not vanish -------------------------------------------------------------------------


def _with_leading(
    proof: ProofForEveryH, series: DefectSeries[JetField], every_h: BySeries, order: int
) -> ProofForEveryH:
    """Return the proof with the coefficient of h^order, the first in S that is not zero."""
    form, defect = series.form(order), proof.structure.symbol
    volume = form.divergence
    below = {
        AREA: f"the coefficients of h¹ … `h^{order - 1}` in det J are the zero polynomial",
        SYMPLECTIC: f"the entries of S up to `h^{order - 1}` are zero polynomials",
    }[proof.structure]
    proof = replace(
        proof,
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
        entry=form.entry_name(next(iter(form.entries))),
        checked=(read_prose(below),) if order > 1 else (),
    )
    proof = _with_telescoping(proof, series.flow, every_h, form)
    return replace(proof, leading=proof.format_form(form, proof.formula))


def _with_telescoping(
    proof: ProofForEveryH, flow: JetField, every_h: BySeries, form: TwoForm
) -> ProofForEveryH:
    """Decide whether the leading coefficient is a Lie derivative, by a formula where one exists."""
    lie = isinstance(every_h, TaylorSeries)
    if isinstance(every_h, TaylorSeries):
        proof = _with_lie_formulas(proof, flow, every_h.eta, form)
    if proof.telescopes:
        return proof
    ring = flow.ring
    if isinstance(ring, Jets):  # the plane
        telescoping = telescopes(ring, form.entry(0, 1))
        proof = replace(proof, telescopes=telescoping.holds, why=telescoping.reason)
        if telescoping.potential is None:
            return proof
        potential = TwoForm(ring, flow.names, {(0, 1): telescoping.potential})
        return replace(proof, potential=proof.format_form(potential), potential_form=potential)
    if not lie or form.divergence.subs(flow.at_rest).is_zero():
        return proof
    why = prose("where f vanishes a Lie derivative has no divergence, and this has one")
    return replace(proof, telescopes=False, why=why)


class _LieTexts(NamedTuple):
    """The texts about lieη.

    `formula`: the leading coefficient; `first`: the statement that it is. `potential`: the formula
    of the potential; `second`: the statement that it is.
    """

    formula: str
    first: Prose
    potential: Prose
    second: Prose


def _texts_in_plane(x: str, eta: int) -> _LieTexts:
    potential = (
        f"G = −1/{eta + 1}! `Σ_k` `(−1)^k` ∂(`{x}^({eta}−k)` p, `{x}^k` q)/∂(p, q), k = 0 … {eta}"
    )
    return _LieTexts(
        f"-div({x}^{eta} f)/{eta + 1}!, f = (-H_q, H_p)",
        read_prose(f"that of `h^{eta + 1}` is −div(`{x}^{eta}` f)/{eta + 1}!"),
        read_prose(potential),
        prose(f"{x}·G is that coefficient"),
    )


def _texts_in_degrees(x: str, eta: int) -> _LieTexts:
    formula = f"−1/{eta + 1}! Σ_i (d({x}^{eta + 1} p_i)∧dq_i + dp_i∧d({x}^{eta + 1} q_i))"
    terms = f"Σ_k (−1)^k Σ_i d({x}^({eta}−k) p_i)∧d({x}^k q_i), k = 0 … {eta}"
    return _LieTexts(
        formula,
        prose(read_prose(f"that of `h^{eta + 1}` is "), Formula(formula)),
        prose(f"β = −1/{eta + 1}! {terms}"),
        prose("the Lie derivative of β is that coefficient"),
    )


def _with_lie_formulas(
    proof: ProofForEveryH, flow: JetField, eta: int, form: TwoForm
) -> ProofForEveryH:
    """Return the proof with the formulas of lieη, each identity checked by machine."""
    describe = {AREA: _texts_in_plane, SYMPLECTIC: _texts_in_degrees}[proof.structure]
    texts, short = describe("D" if flow.timed else "X", eta), not is_long(proof, eta + 1)
    if proof.order == eta + 1 and short and not (_leading_of_lie(flow, eta) - form).entries:
        proof = replace(proof, formula=texts.formula, checked=(*proof.checked, texts.first))
    if eta % 2:
        return proof
    potential = potential_of_lie(flow, eta)
    # On paper the formula for β holds for every even η; the machine checks it for this η.
    if (lie_derivative(flow, potential) - form).entries:
        return proof
    return replace(
        proof,
        telescopes=True,
        potential=proof.format_form(potential, str(texts.potential)),
        potential_form=potential,
        why=texts.potential,
        checked=(*proof.checked, texts.second),
    )


def _leading_of_lie(flow: JetField, eta: int) -> TwoForm:
    """Return the leading coefficient of lieη's S, −1/(η+1)! ([η+1, 0] + [0, η+1]).

    It is d of the 1-form Σ_i X^(η+1)p_i dq_i − X^(η+1)q_i dp_i, divided by −(η+1)!.
    """
    n, ring, names = flow.degrees, flow.ring, flow.names
    last = flow.power(eta + 1)
    one_form = [*(-x for x in last[n:]), *last[:n]]
    share = ring.constant(Fraction(-1, math.factorial(eta + 1)))

    def entry(a: int, b: int) -> Poly:
        return share * (ring.diff(one_form[b], names[a]) - ring.diff(one_form[a], names[b]))

    return TwoForm.from_entries(ring, names, entry)
