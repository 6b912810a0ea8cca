"""Proofs for every smooth H(p, q, t), or every T(p, t) + V(q, t).

`lieη`: as in `verify.proof.every`, in the jets of H(p, q, t), with D = ∂_t + X in place of X. Both
arguments there hold for D: the two-forms [a, b] of Dᵃp and D^b q are taken at one t, and D, which
is X in the extended phase space, commutes with d and takes [a, b] to [a+1, b] + [a, b+1]. For odd
η the leading coefficient is D·G for no G in the jets: an H without t is one of these H, for which
D·G is X·G.

Splittings: by conditions on sizes and times, `verify.schemes.clock_conditions`.

Runge–Kutta methods: by the conditions of all trees. What fails for an H without t fails; where a
condition does not hold that such an H does not need, nothing is said.
"""

import math

from verify.algebra.series.jets import shown
from verify.algebra.series.timed_jets import TimedJets
from verify.errors import InputError
from verify.proof.by_conditions import prove_by_conditions
from verify.proof.every import prove_every
from verify.proof.every_proof import EveryProof
from verify.proof.telescoping import potential_of_lie
from verify.prose import Prose, prose, read_prose
from verify.schemes import get
from verify.schemes.clock_conditions import ClockedSplitting
from verify.schemes.clock_mistakes import mistake
from verify.schemes.every_hamiltonian import RungeKutta, StageEquations, TaylorSeries
from verify.schemes.implicit_tableau import ImplicitTableau
from verify.schemes.scheme import Scheme
from verify.schemes.splitting import all_times
from verify.schemes.splitting_conditions import Splitting
from verify.schemes.tree_conditions import TreeConditions, TreeConditionsInTime
from verify.verdict import Verdict

_MOST_ETA = 8  # the terms triple with every order; lie8 takes 2 s


def prove_every_in_time(name: str) -> EveryProof:
    """The order of ΔJ and of the map of the scheme of that name, for every H in t that it takes.

    Raises InputError for a scheme that is no lieη, no splitting and no Runge–Kutta method, and for
    η above 8.
    """
    scheme = get(name)
    if isinstance(scheme.every_h, TaylorSeries):
        return _of_lie(scheme, scheme.every_h.eta)
    if isinstance(scheme.every_h, Splitting):
        return _of_splitting(scheme, scheme.every_h)
    tableau = _tableau_of(scheme.every_h)
    if tableau is not None:
        return _of_stages(scheme, tableau)
    allowed = "lieη, splittings, Runge–Kutta methods, for every H in t; for one such H any scheme"
    raise InputError("scheme", name, f"is none of which that is proved; allowed: {allowed}")


def _of_lie(scheme: Scheme, eta: int) -> EveryProof:
    if eta > _MOST_ETA:
        problem = f"is proved for every H in t up to lie{_MOST_ETA}: its polynomials are too long"
        raise InputError("scheme", scheme.name, problem)
    jets = TimedJets(eta + 2)
    flows = [jets.lie_derivatives(name, eta + 1) for name in ("p", "q")]
    p_next, q_next = (
        [x / math.factorial(n) if n <= eta else jets.zero for n, x in enumerate(flow)]
        for flow in flows
    )
    coefficients = list(jets.delta_j(p_next, q_next))
    order = next(n for n, x in enumerate(coefficients, 1) if not x.is_zero())
    leading = coefficients[order - 1]
    divergence = jets.diff(flows[0][-1], "p") + jets.diff(flows[1][-1], "q")
    checked = [f"the coefficients of h¹ … `h^{order - 1}` in det J are the zero polynomial"]
    formula, potential = "", None
    if leading * math.factorial(eta + 1) == -divergence:
        formula = f"-div(D^{eta} f)/{eta + 1}!, f = (-H_q, H_p)"
        checked.append(f"that of `h^{eta + 1}` is −div(`D^{eta}` f)/{eta + 1}!")
    if eta % 2 == 0:
        found = potential_of_lie(jets, eta)
        potential = found if jets.derive(found) == leading else None
    holds = potential is not None
    if holds:
        checked.append("D·G is that coefficient")
    return EveryProof(
        scheme.name,
        separable=False,
        verdict=Verdict.PROVED,
        reason=read_prose(
            f"the coefficients of ΔJ below `h^{order}` vanish for every H, that of `h^{order}` "
            "does not"
        ),
        order=order,
        area_preserving=False,
        convergence_order=eta,
        convergence_decided=not all(flow[-1].is_zero() for flow in flows),
        leading=shown(leading),
        formula=formula,
        telescopes=holds,
        potential=None if potential is None else shown(potential),
        why=_why(eta, holds),
        checked=tuple(map(read_prose, checked)),
        timed=True,
    )


def _why(eta: int, holds: bool) -> Prose:
    if holds:
        return read_prose(
            f"G = −1/{eta + 1}! `Σ_k` `(−1)^k` ∂(`D^({eta}−k)` p, `D^k` q)/∂(p, q), k = 0 … {eta}"
        )
    return read_prose(
        "for an H without t, D·G would be X·G, and that is `L` for no smooth G: where such a "
        "motion rests, X·G = 0 and `L` is not"
    )


def _of_splitting(scheme: Scheme, every_h: Splitting) -> EveryProof:
    times = all_times(every_h.parts, every_h.times)
    found = prove_by_conditions(scheme, ClockedSplitting(every_h.parts, times))
    named = mistake(every_h.parts, times) if found.verdict is Verdict.REFUTED else ""
    reason = prose(found.reason, f"; it is {named}") if named else found.reason
    return EveryProof(**vars(found) | {"reason": reason, "timed": True})


def _tableau_of(every_h: object) -> ImplicitTableau | None:
    """The coefficients of what is a Runge–Kutta method."""
    if isinstance(every_h, RungeKutta):
        return ImplicitTableau.of(*every_h.square)
    if isinstance(every_h, TreeConditions):
        return every_h.tableau
    if isinstance(every_h, StageEquations) and len(every_h.stages) == 1:
        (stage,) = every_h.stages
        if stage.at_p == stage.at_q and stage.kick == stage.drift:
            return ImplicitTableau.of(((stage.kick * stage.at_p,),), (stage.kick,))
    return None


def _of_stages(scheme: Scheme, tableau: ImplicitTableau) -> EveryProof:
    found = prove_by_conditions(scheme, TreeConditionsInTime(tableau))
    still = prove_every(scheme.name)  # for an H without t, which is one of these
    agreed, needed = found.convergence_order or 0, still.convergence_order or 0
    decided = found.convergence_decided and needed <= agreed
    told = {"timed": True, "convergence_decided": decided, "separable": False}
    if agreed < scheme.order:
        verdict = Verdict.REFUTED if decided else Verdict.UNDECIDED
        return EveryProof(**vars(found) | told | {"verdict": verdict})
    if scheme.area_preserving or still.area_preserving is not False:
        return EveryProof(**vars(found) | told)
    reason = read_prose(
        f"order {scheme.order}: every condition on the coefficients holds exactly; ΔJ is "
        f"O(`h^{agreed + 1}`), and not 0 for an H without t"
    )
    more = {"verdict": Verdict.PROVED, "reason": reason, "area_preserving": False}
    return EveryProof(**vars(found) | told | more)
