"""Proofs for every smooth H (or every H = T(p) + V(q)): the order of ΔJ, of the map, telescoping.

What is zero is a polynomial in the jets that is the zero polynomial: machine-checked. What is not
zero is one that is not, and some polynomial H gives it a value other than 0.

Two arguments on paper stand beside the machine's, since it checks one η at a time.

`lieη`, any η. The exact flow φ_h has det φ_h' = 1, so every coefficient of h, h², … in
det Σ hⁿ/n! (Xⁿz)' vanishes. The scheme has the same terms up to h^η; so has its determinant, whose
coefficients of h … h^η therefore vanish. In that of h^(η+1) the exact flow has one term more, which
is linear, tr (X^(η+1)z)'/(η+1)! = div(X^η f)/(η+1)!, f = (−H_q, H_p); so the scheme's
coefficient is L = −div(X^η f)/(η+1)!. It is not zero for every H. Odd η: at an equilibrium with
D = det Hess H ≠ 0 it is −2 (−D)^((η+1)/2)/(η+1)! (see `verify.proof.telescoping`). Even η: L = X·G,
and G is −(−D)^(η/2)/η! at an equilibrium, as all η+1 terms of its sum are equal there. Were L zero
for H = p²/2 + V(q), V with two maxima of one height and different V'', then G would be constant
along the orbit that joins them, and yet has different values at its ends. ∎

Stages. Where A J = B with det A = det B, det J = 1; see `StageEquations.determinants`.

Coefficients. Conditions on them, exact; see `verify.proof.by_conditions`.
"""

import math
from collections.abc import Callable
from dataclasses import replace

from verify.algebra.series.jets import Jets, Poly, Series, shown
from verify.algebra.series.timed_jets import TimedJets
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.by_conditions import prove_by_conditions
from verify.proof.every_proof import EveryProof as EveryProof
from verify.proof.order import leading_of
from verify.proof.telescoping import (
    EveryJets,
    Telescoping,
    along,
    telescopes,
    telescopes_of_lie,
)
from verify.prose import Formula, Prose, joined, prose, read_prose
from verify.schemes import get
from verify.schemes.conditions import ByConditions
from verify.schemes.every_hamiltonian import BySeries, StageEquations, TaylorSeries
from verify.schemes.scheme import Scheme
from verify.schemes.tree_conditions import TreeConditions
from verify.verdict import Verdict

_MOST_ORDER = 14  # the terms of L double with every order; lie14 takes 20 s
_MORE = 4  # orders beyond the claimed one that are looked at


def prove_every(name: str, separable: bool = False, least: int = 0) -> EveryProof:
    """The order of ΔJ and of the map of the scheme of that name, for every H that it takes.

    `separable`: only for every H = T(p) + V(q), of which more may be true. `least`: as far as that
    the map's order is looked at, of a scheme that is given by coefficients and may state none.
    Raises InputError for a scheme that is known for one H at a time only, or of an order above 14.
    """
    scheme = get(name)
    if scheme.every_h is None:
        raise InputError("scheme", name, "is given for one H; it cannot be proved for every H")
    if scheme.order > _MOST_ORDER:
        problem = f"of order {_MOST_ORDER} at most: its polynomials have too many terms"
        raise InputError("scheme", name, f"for every H a scheme is proved {problem}")
    separable = separable or scheme.every_h.separable
    if isinstance(scheme.every_h, ByConditions):
        return _of_conditions(scheme, scheme.every_h, separable, least)
    if isinstance(scheme.every_h, StageEquations):
        return _of_stages(scheme, scheme.every_h, separable)
    return _of_series(scheme, scheme.every_h, separable)


def _of_conditions(
    scheme: Scheme, every_h: ByConditions, separable: bool, least: int
) -> EveryProof:
    """By its coefficients; where they leave det J open, by the series, if the scheme has one."""
    if separable and isinstance(every_h, TreeConditions):
        every_h = replace(every_h, separable=True)
    proof = prove_by_conditions(scheme, every_h, least)
    if separable and not every_h.separable:
        proof = replace(proof, separable=True)
        if proof.verdict is Verdict.REFUTED:  # the H that it fails for may be no T(p) + V(q)
            alone = "; of H = T(p) + V(q) alone nothing is said"
            reason = prose("of every smooth H: ", proof.reason, alone)
            return replace(proof, verdict=Verdict.UNDECIDED, reason=reason)
    agreed = proof.convergence_order
    if proof.verdict is Verdict.UNDECIDED and agreed is not None and agreed >= scheme.order:
        found = counterexample(scheme, separable)
        if found is not None:
            hamiltonian, order = found
            lost = f"not det J ≡ 1: ΔJ has order {order} for H = "
            reason = prose(f"of order {scheme.order}, but {lost}", Formula(hamiltonian))
            return replace(proof, verdict=Verdict.REFUTED, reason=reason, area_preserving=False)
    if proof.verdict is not Verdict.UNDECIDED or not isinstance(every_h, BySeries):
        return proof
    return replace(_of_series(scheme, every_h, separable), conditions=proof.conditions)


def _convergence(jets: EveryJets, series: tuple[Series, Series]) -> int:
    """p', q' agree with the exact flow up to this power of h, as far as the series reach."""
    most = len(series[0]) - 1
    flows = jets.lie_derivatives("p", most), jets.lie_derivatives("q", most)
    for n in range(most + 1):
        if any(s[n] * math.factorial(n) != x[n] for s, x in zip(series, flows, strict=True)):
            return n - 1
    return most


def _of_stages(scheme: Scheme, every_h: StageEquations, separable: bool) -> EveryProof:
    most = scheme.order + 2
    jets = Jets(most + 2, separable=separable)
    agreed = _convergence(jets, every_h.taylor(jets, most))
    preserved = all(a == b and not a.is_zero() for a, b in every_h.determinants())
    verdict, reason = Verdict.PROVED, prose("ΔJ is the zero function: det J ≡ 1, stage by stage")
    if agreed < scheme.order:
        verdict, reason = Verdict.REFUTED, missed(scheme, agreed)
    elif not preserved:
        return _of_series(scheme, every_h, separable)
    ratios = joined(", ", dict.fromkeys(Formula(str(a)) for a, _ in every_h.determinants()))
    names = read_prose(" (a, b, c = `H_pp`, `H_pq`, `H_qq`)")
    return EveryProof(
        scheme.name,
        separable,
        verdict,
        reason,
        order=None,
        area_preserving=True,
        convergence_order=agreed,
        convergence_decided=agreed < most,
        checked=(prose("A J = B with det A = det B = ", ratios, names),),
    )


def _of_series(scheme: Scheme, every_h: BySeries, separable: bool) -> EveryProof:
    def jets_for(most: int) -> Jets:
        return Jets(most + 2, separable=separable)

    return _over(jets_for, scheme, every_h, separable)


def prove_lie_in_time(scheme: Scheme, every_h: TaylorSeries) -> EveryProof:
    """Of `lieη`, for every H(p, q, t)."""
    found = _over(lambda most: TimedJets(most + 1), scheme, every_h, separable=False)
    return replace(found, timed=True)


def _over(
    jets_for: Callable[[int], EveryJets], scheme: Scheme, every_h: BySeries, separable: bool
) -> EveryProof:
    """By the series over the jets that are enough up to a power of h."""
    most = scheme.order + 1
    while True:
        jets = jets_for(most)
        series = every_h.taylor(jets, most)
        coefficients = list(jets.delta_j(*series))
        order = next((n for n, x in enumerate(coefficients, 1) if not x.is_zero()), None)
        if order is not None or most == scheme.order + _MORE:
            break
        most += 1
    agreed = _convergence(jets, series)
    if order is None:
        verdict = Verdict.UNDECIDED
        reason = read_prose(
            f"the coefficients of ΔJ up to `h^{most}` vanish; whether all do is not decided"
        )
        if agreed < scheme.order:
            verdict, reason = Verdict.REFUTED, missed(scheme, agreed)
        return EveryProof(
            scheme.name, separable, verdict, reason, None, None, agreed, agreed < most
        )
    leading = coefficients[order - 1]
    verdict, reason = _verdict(scheme, order, agreed)
    found, formula, checked = _telescoping(jets, every_h, leading, order)
    below = f"the coefficients of h¹ … `h^{order - 1}` in det J are the zero polynomial"
    return EveryProof(
        scheme.name,
        separable,
        verdict,
        reason,
        order=order,
        area_preserving=False,
        convergence_order=agreed,
        convergence_decided=agreed < most,
        leading=shown(leading),
        formula=formula,
        telescopes=found.holds,
        potential=None if found.potential is None else shown(found.potential),
        why=found.reason,
        checked=(*([read_prose(below)] if order > 1 else []), *checked),
    )


def _verdict(scheme: Scheme, order: int, agreed: int) -> tuple[Verdict, Prose]:
    if agreed < scheme.order:
        return Verdict.REFUTED, missed(scheme, agreed)
    if scheme.area_preserving:
        return Verdict.REFUTED, prose(f"{scheme.name} claims det J ≡ 1; ΔJ has order {order}")
    return Verdict.PROVED, read_prose(
        f"the coefficients of ΔJ below `h^{order}` vanish for every H, that of `h^{order}` does not"
    )


def missed(scheme: Scheme, agreed: int) -> Prose:
    """That it claims a higher order than the map's for every H."""
    return read_prose(
        f"{scheme.name} claims order {scheme.order}; for a generic H the map agrees with the exact "
        f"flow up to `h^{agreed}` only"
    )


def telescoping_of(jets: EveryJets, every_h: object, leading: Poly) -> Telescoping:
    """Whether the leading coefficient is X·G; of `lieη` by the formula where there is one."""
    if isinstance(every_h, TaylorSeries):
        return telescopes_of_lie(jets, leading, every_h.eta)
    return telescopes(jets, leading)


def _telescoping(
    jets: EveryJets, every_h: object, leading: Poly, order: int
) -> tuple[Telescoping, str, tuple[Prose, ...]]:
    """Whether the leading coefficient is X·G, its formula, and the identities checked for that."""
    found = telescoping_of(jets, every_h, leading)
    if not isinstance(every_h, TaylorSeries):
        return found, "", ()
    eta, by = every_h.eta, along(jets)
    end = [jets.lie_derivatives(name, eta + 1)[-1] for name in ("p", "q")]
    divergence = jets.diff(end[0], "p") + jets.diff(end[1], "q")
    formula = ""
    checked: tuple[Prose, ...] = ()
    if order == eta + 1 and leading * math.factorial(eta + 1) == -divergence:
        formula = f"-div({by}^{eta} f)/{eta + 1}!, f = (-H_q, H_p)"
        told = f"that of `h^{eta + 1}` is −div(`{by}^{eta}` f)/{eta + 1}!"
        checked = (read_prose(told),)
    if found.holds:
        checked = (*checked, prose(f"{by}·G is that coefficient"))
    return found, formula, checked


# Polynomials, so that all is decided; with cubic terms, as a quadratic H makes too much vanish.
_SEPARABLE = ("p**2/2 + q**2/2 + q**3/3", "p**2/2 + p**3/3 + q**2/2 + q**4/4 + q**3/3")
_OTHERS = ("p**2/2 + q**2/2 + p*q**2 + q**3/3",)


def counterexample(scheme: Scheme, separable: bool) -> tuple[str, int] | None:
    """The H as a formula and the order of ΔJ for it, exact; None where none is found."""
    for text in (*_SEPARABLE, *(() if separable else _OTHERS)):
        try:
            step_map = scheme.step_map(Hamiltonian.parse(text))
        except InputError:
            continue
        leading = leading_of(step_map)
        if leading.decision.zero is False and leading.power is not None:
            return text, leading.power
    return None
