"""Proofs for every smooth H (or every H = T(p) + V(q)): the order of ΔJ, of the map, telescoping.

The jets are the derivatives of H at a point, as free variables. A coefficient is zero for every H
if it is the zero polynomial in the jets, which the machine checks. If it is another polynomial,
some polynomial H gives it a value other than 0.

The machine proves one η at a time. Two arguments on paper supplement it.

`lieη` (the Taylor polynomial of the flow), any η. The exact flow φ_h has det φ_h' = 1, so every
coefficient of h, h², … in det Σ hⁿ/n! (Xⁿz)' vanishes. The scheme has the same terms up to h^η, and
so has its determinant, whose coefficients of h … h^η therefore vanish. In that of h^(η+1) the exact
flow has one more term, which is linear, tr (X^(η+1)z)'/(η+1)! = div(X^η f)/(η+1)!, f = (−H_q, H_p);
so the scheme's coefficient is L = −div(X^η f)/(η+1)!. There are H for which L is not zero. Odd η:
at an equilibrium with D = det Hess H ≠ 0 it is −2 (−D)^((η+1)/2)/(η+1)! (see
`verify.proof.telescoping`). Even η: L = X·G, and G is −(−D)^(η/2)/η! at an equilibrium, as all η+1
terms of its sum are equal there. If L were zero for H = p²/2 + V(q), V with two maxima of the same
height and different V'', G would be constant along the orbit that joins them; but it has different
values at the ends. ∎

If H depends on t, both arguments hold in the jets of H(p, q, t) for D = ∂_t + X in place of X: the
two-forms [a, b] of Dᵃp and D^b q are taken at one t, and D, which is X in the extended phase space,
commutes with d and takes [a, b] to [a+1, b] + [a, b+1]. For odd η the leading coefficient is D·G
for no G in the jets: an H without t is one of these H, and for it D·G is X·G. Splittings and stages
are proved by conditions on sizes, coefficients and times (`verify.schemes.conditions`), which are
also necessary.

In n degrees of freedom S = JᵀΩJ − Ω takes the place of ΔJ; see `verify.proof.series_for_every_h`.
The orders of splittings and of Gauss methods follow from conditions on their coefficients. Those of
splittings suffice in any number of degrees of freedom, and so do those of all trees. Conditions
that are necessary in the plane are necessary in n degrees, as H1(p1, q1) + H2(p2, q2) + … is such
an H.

Stages: if A J = B with det A = det B, det J = 1; see `StageEquations.determinants`.

Coefficients: exact conditions on them; see `verify.proof.order_conditions`.
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

from verify.errors import InputError, LimitError
from verify.hamiltonians.coordinates import check_degrees
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_conditions import (
    agreed_order,
    describe_nearby,
    first_wrong,
    prove_by_conditions,
)
from verify.proof.order_for_one_h import leading_of
from verify.proof.proof_for_every_h import NONE, ProofForEveryH
from verify.proof.series_for_every_h import is_long, prove_by_series
from verify.prose import Formula, Prose, prose
from verify.schemes import get
from verify.schemes.conditions.condition import ByConditions
from verify.schemes.conditions.every_hamiltonian import BySeries, TaylorSeries
from verify.schemes.conditions.scheme_clocks import conditions_for, find_mistakes
from verify.schemes.conditions.splitting_conditions import Splitting
from verify.schemes.conditions.tree_conditions import TreeConditions, holds_for_all_trees
from verify.schemes.conditions.words.words import Kinetic
from verify.schemes.maps import kind_of
from verify.schemes.scheme import Scheme
from verify.structures import AREA, SYMPLECTIC
from verify.verdict import Verdict

_MOST_ORDER = {AREA: 14, SYMPLECTIC: math.inf}  # L's terms double with each order: 20 s for lie14
_MOST_ETA_IN_TIME = 8  # with time the terms triple with each order; lie8 takes 2 s
# H for counterexamples: polynomials, so that all is decided, and not quadratic, as for a quadratic
# H too many terms vanish.
SEPARABLE_EXAMPLES = ("p**2/2 + q**2/2 + q**3/3", "p**2/2 + p**3/3 + q**2/2 + q**4/4 + q**3/3")
MIXED_EXAMPLES = ("p**2/2 + q**2/2 + p*q**2 + q**3/3",)


def prove_for_every_h(
    name: str, separable: bool = False, least: int = 0, *, timed: bool = False, degrees: int = 1
) -> ProofForEveryH:
    """Prove the orders of ΔJ, or S, and of the map of a scheme, for every H that it takes.

    `name`: the scheme's name. `separable`: True for H = T(p) + V(q) only, for which more may hold.
    `least`: the order up to which a scheme by coefficients is at least examined, as it may claim
    none itself. `timed`: True for H that depend on t. `degrees`: the degrees of freedom. Raises
    InputError for a scheme that is defined for one H at a time or in the plane only, or of too high
    an order; LimitError for polynomials that are too long.
    """
    check_degrees(degrees)
    scheme = get(name)
    if degrees > 1:
        kind_of(scheme.every_h, scheme.name)
    every_h = scheme.every_h
    if every_h is None:
        hamiltonians = f"every H{' in t' * timed}"
        raise InputError(
            "scheme", name, f"is given for one H; it cannot be proved for {hamiltonians}"
        )
    separable = every_h.separable or (separable and (degrees > 1 or not timed))
    blank = ProofForEveryH(
        scheme.name, separable, Verdict.UNDECIDED, NONE, timed=timed, degrees=degrees
    )
    _check_length(blank, scheme, every_h)
    # If H depends on time, the stages' times enter conditions; otherwise the series decides.
    by_coefficients = isinstance(every_h, ByConditions) or (
        timed and not isinstance(every_h, TaylorSeries)
    )
    if isinstance(every_h, BySeries) and not (blank.planar and by_coefficients):
        return prove_by_series(blank, scheme, every_h)
    prove = {AREA: _prove_by_coefficients, SYMPLECTIC: _prove_in_degrees}[blank.structure]
    return prove(blank, scheme, every_h, least)


def _check_length(blank: ProofForEveryH, scheme: Scheme, every_h: BySeries | ByConditions) -> None:
    """Raise InputError or LimitError if the polynomials would be too long."""
    name, order, taylor = scheme.name, scheme.order, isinstance(every_h, TaylorSeries)
    if isinstance(every_h, BySeries) and is_long(blank, order):
        problem = f"are too many for {name}: its polynomials are too long"
        raise LimitError("degrees", blank.degrees, problem)
    if not blank.timed and order > _MOST_ORDER[blank.structure]:
        problem = f"of order {_MOST_ORDER[AREA]} at most: its polynomials have too many terms"
        raise InputError("scheme", name, f"for every H a scheme is proved {problem}")
    if blank.timed and taylor and order > _MOST_ETA_IN_TIME:
        limit = f"up to lie{_MOST_ETA_IN_TIME}: its polynomials are too long"
        raise InputError("scheme", name, f"is proved for every H in t {limit}")


# -- by conditions on coefficients ----------------------------------------------------------------


def conditions_of_class(blank: ProofForEveryH, every_h: BySeries | ByConditions) -> ByConditions:
    """Return the conditions on coefficients, and on times if H depends on time."""
    if blank.timed or not isinstance(every_h, ByConditions):
        return conditions_for(every_h)
    if blank.separable and isinstance(every_h, TreeConditions):
        return replace(every_h, kinetic=Kinetic.GENERAL)
    return every_h


def _prove_by_coefficients(
    blank: ProofForEveryH, scheme: Scheme, every_h: BySeries | ByConditions, least: int
) -> ProofForEveryH:
    """Prove by the scheme's coefficients, and if det J is then undecided by its series.

    A scheme without a series may be refuted by a counterexample: an H, always without t, for which
    det J is not 1.
    """
    conditions = conditions_of_class(blank, every_h)
    proof = prove_by_conditions(scheme, conditions, least)
    proof = replace(proof, separable=blank.separable, timed=blank.timed)
    agreed = proof.convergence_order or 0
    if blank.timed and isinstance(conditions, Splitting):
        mistakes = find_mistakes(conditions) if proof.verdict is Verdict.REFUTED else []
        reason = prose(proof.reason, f"; it is {'; '.join(mistakes)}") if mistakes else proof.reason
        checked = (*proof.checked, *_higher_orders(scheme, conditions, agreed))
        return replace(proof, reason=reason, checked=checked)
    if proof.verdict is Verdict.REFUTED and blank.separable and not conditions.separable:
        alone = "; of H = T(p) + V(q) alone nothing is said"  # the refuting H may not be separable
        reason = prose("of every smooth H: ", proof.reason, alone)
        return replace(proof, verdict=Verdict.UNDECIDED, reason=reason)
    if proof.verdict is not Verdict.UNDECIDED:
        return proof
    if isinstance(scheme.every_h, BySeries):
        by_series = prove_by_series(blank, scheme, scheme.every_h)
        return replace(by_series, conditions=proof.conditions)
    example = counterexample(scheme, blank.separable) if agreed >= scheme.order else None
    if example is None:
        return proof
    lost = f"not det J ≡ 1: ΔJ has order {example.order} for H = "
    reason = prose(f"of order {scheme.order}, but {lost}", Formula(example.hamiltonian))
    return replace(proof, verdict=Verdict.REFUTED, reason=reason, area_preserving=False)


class RefutingHamiltonian(NamedTuple):
    """An H with ΔJ ≠ 0, as a formula, and the exact order of its ΔJ."""

    hamiltonian: str
    order: int


def counterexample(scheme: Scheme, separable: bool) -> RefutingHamiltonian | None:
    """Find an H with ΔJ ≠ 0; None if none is found."""
    for text in (*SEPARABLE_EXAMPLES, *(() if separable else MIXED_EXAMPLES)):
        try:
            step_map = scheme.step_map(Hamiltonian.parse(text))
        except InputError:
            continue
        leading = leading_of(step_map)
        if leading.decision.zero is False and leading.power is not None:
            return RefutingHamiltonian(text, leading.power)
    return None


def _higher_orders(scheme: Scheme, timed: Splitting, general: int) -> Iterator[Prose]:
    """Yield sentences on the smaller classes of H for which the map has a higher order."""
    for kinetic in Kinetic:
        order, _ = agreed_order(replace(timed, kinetic=kinetic), scheme.order)
        if order > general:
            yield prose(f"for every H = {kinetic.value} + V(q, t) the map has order {order}")


# -- in n degrees of freedom ----------------------------------------------------------------------


def _prove_in_degrees(
    blank: ProofForEveryH, scheme: Scheme, every_h: BySeries | ByConditions, least: int
) -> ProofForEveryH:
    """Prove the order as in the plane, and S ≡ 0 by conditions that suffice for it."""
    planar = _prove_by_coefficients(blank, scheme, every_h, least)
    conditions = kind_of(every_h, scheme.name).conditions(every_h, blank.degrees)
    verdict, reason = planar.verdict, planar.reason
    symplectic = True if conditions and first_wrong(conditions) is None else None
    if planar.nearby is not None and verdict is planar.nearby.verdict and symplectic:
        reason = prose("symplectic, and ", describe_nearby(planar.nearby))
    elif verdict is Verdict.PROVED:
        sentence = "every condition on the coefficients holds exactly"
        reason = prose(f"symplectic, and of order {scheme.order}: {sentence}")
        if not symplectic:
            verdict = Verdict.UNDECIDED
            reason = prose("of what suffices for a symplectic map one condition does not hold")
        elif not _suffices(every_h, scheme.order):
            verdict = Verdict.UNDECIDED
            reason = prose("symplectic; its order is known in the plane, where fewer trees count")
    return replace(
        blank,
        verdict=verdict,
        reason=reason,
        area_preserving=symplectic,
        convergence_order=planar.convergence_order,
        convergence_decided=planar.convergence_decided,
        conditions=(*(c for c in planar.conditions if c.order), *conditions),
        checked=planar.checked,
        telescopes=symplectic,
        potential="0" if symplectic else None,
        nearby=planar.nearby,
    )


def _suffices(every_h: object, order: int) -> bool:
    """Return True if the order proved in the plane holds in n degrees of freedom."""
    return not isinstance(every_h, TreeConditions) or holds_for_all_trees(every_h.tableau, order)
