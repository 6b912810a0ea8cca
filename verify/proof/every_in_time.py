"""Proofs for every smooth H(p, q, t), or every T(p, t) + V(q, t).

`lieη`: as in `verify.proof.every`, in the jets of H(p, q, t), with D = ∂_t + X in place of X. Both
arguments there hold for D: the two-forms [a, b] of Dᵃp and D^b q are taken at one t, and D, which
is X in the extended phase space, commutes with d and takes [a, b] to [a+1, b] + [a, b+1]. For odd
η the leading coefficient is D·G for no G in the jets: an H without t is one of these H, for which
D·G is X·G.

Splittings and stages: by conditions on sizes, coefficients and times, `verify.schemes.timed`, which
are necessary, too.
"""

from collections.abc import Iterator
from dataclasses import replace

from verify.errors import InputError
from verify.proof.by_conditions import agreed_order, prove_by_conditions
from verify.proof.every import prove_every, prove_lie_in_time
from verify.proof.every_proof import EveryProof
from verify.prose import Prose, prose, read_prose
from verify.schemes import get
from verify.schemes.conditions import ByConditions
from verify.schemes.every_hamiltonian import TaylorSeries
from verify.schemes.scheme import Scheme
from verify.schemes.splitting_conditions import Splitting
from verify.schemes.timed.for_scheme import conditions_for
from verify.schemes.timed.mistakes import mistakes_of_splitting
from verify.schemes.timed.splitting import TimedSplitting
from verify.schemes.words.kinetic import Kinetic
from verify.verdict import Verdict

_MOST_ETA = 8  # the terms triple with every order; lie8 takes 2 s


def prove_every_in_time(name: str, least: int = 0) -> EveryProof:
    """The order of ΔJ and of the map of the scheme of that name, for every H in t that it takes.

    `least`: as for `verify.proof.every.prove_every`.

    Raises InputError for a scheme that is known for one H at a time only, and for η above 8.
    """
    scheme = get(name)
    if isinstance(scheme.every_h, TaylorSeries):
        if scheme.order > _MOST_ETA:
            told = f"up to lie{_MOST_ETA}: its polynomials are too long"
            raise InputError("scheme", scheme.name, f"is proved for every H in t {told}")
        return prove_lie_in_time(scheme, scheme.every_h)
    if isinstance(scheme.every_h, Splitting):
        return _of_splitting(scheme, scheme.every_h, least)
    if scheme.every_h is None:
        raise InputError("scheme", name, "is given for one H; it cannot be proved for every H in t")
    return _of_stages(scheme, conditions_for(scheme.every_h), least)


def _of_splitting(scheme: Scheme, every_h: Splitting, least: int) -> EveryProof:
    times = every_h.times or (None,) * len(every_h.parts)
    timed = TimedSplitting(every_h.parts, times, nearby=every_h.nearby_at(times))
    found = prove_by_conditions(scheme, timed, least)
    named = mistakes_of_splitting(timed) if found.verdict is Verdict.REFUTED else []
    reason = prose(found.reason, f"; it is {'; '.join(named)}") if named else found.reason
    checked = (*found.checked, *_of_fewer(scheme, timed, found.convergence_order or 0))
    return replace(found, reason=reason, checked=checked, timed=True)


def _of_fewer(scheme: Scheme, timed: TimedSplitting, general: int) -> Iterator[Prose]:
    """The order where fewer H are asked for, where it is a higher one."""
    for kinetic in Kinetic:
        order, _ = agreed_order(replace(timed, kinetic=kinetic), scheme.order)
        if order > general:
            yield prose(f"for every H = {kinetic.value} + V(q, t) the map has order {order}")


def _of_stages(scheme: Scheme, timed: ByConditions, least: int) -> EveryProof:
    found = replace(prove_by_conditions(scheme, timed, least), timed=True)
    agreed = found.convergence_order or 0
    if agreed < scheme.order or found.verdict is not Verdict.UNDECIDED:
        return found
    without = prove_every(scheme.name)  # t, which are some of these H
    if without.area_preserving is not False:
        return found
    order = agreed + 1  # at least: the flow, with which the map agrees, has det ≡ 1
    exact = without.order == order
    reason = read_prose(
        f"order {scheme.order}: every condition on the coefficients holds exactly; ΔJ is "
        f"O(`h^{order}`), and {'that coefficient is ' * exact}not 0 for an H without t"
    )
    found = replace(found, order=order, leading="") if exact else found
    return replace(found, verdict=Verdict.PROVED, reason=reason, area_preserving=False)
