"""Proofs for every smooth H in n degrees of freedom: the order of S, of the map, telescoping.

What is zero is a polynomial in H's derivatives that is the zero polynomial. Beside it stands the
argument of `verify.proof.symplectic.telescoping`, for any η and any n: the exact flow preserves Ω,
and lieη shares its terms up to h^η, so that S begins with −h^(η+1)/(η+1)! ([η+1, 0] + [0, η+1]).

A splitting's order and that of a Gauss method follow from conditions on their coefficients. They
suffice in any number of degrees of freedom; and H1(p1, q1) + H2(p2, q2) + … are such H, so that
what is needed in the plane is needed in n.
"""

import math
from dataclasses import replace
from fractions import Fraction
from typing import Any

from verify.algebra.domain import EVERYWHERE, Domain
from verify.algebra.generator import Poly
from verify.errors import LimitError
from verify.hamiltonians.coordinates import check_degrees
from verify.hamiltonians.jet_flow import JetFlow
from verify.proof.by_conditions import first_wrong, told_nearby
from verify.proof.every import missed, prove_every
from verify.proof.every_in_time import prove_every_in_time
from verify.proof.symplectic.proof import MOST_TERMS, SymplecticProof
from verify.proof.symplectic.telescoping import potential_of_lie
from verify.prose import Formula, Prose, prose, read_prose
from verify.schemes import get
from verify.schemes.conditions import Condition
from verify.schemes.degrees import kind_of
from verify.schemes.degrees.canonical_map import SOLVABLE
from verify.schemes.degrees.defect import DefectSeries
from verify.schemes.degrees.two_form import TwoForm, lie_derivative, wedge
from verify.schemes.every_hamiltonian import TaylorSeries
from verify.schemes.scheme import Scheme
from verify.schemes.step_algebra import series_of
from verify.schemes.tree_conditions import TreeConditions, all_trees_hold
from verify.verdict import Verdict

_MORE = 2  # orders beyond the claimed one that are looked at
_MOST_TERMS = 5000  # (2n)^order, which is about the number of terms of X^order z


def prove_every_in_degrees(
    name: str, degrees: int, *, separable: bool = False, timed: bool = False
) -> SymplecticProof:
    """Of the scheme of that name, for every H(p1 … pn, q1 … qn) that it takes.

    `separable`: only for every H = T(p) + V(q); `timed`: for every such H that depends on t. Raises
    InputError for a scheme that is known for one H or in the plane only, LimitError for polynomials
    that are too long.
    """
    check_degrees(degrees)
    scheme = get(name)
    kind = kind_of(scheme)
    separable = separable or scheme.needs_separable
    size = 2 * degrees + timed
    if size**scheme.order > _MOST_TERMS and hasattr(kind, "step"):
        problem = f"are too many for {scheme.name}: its polynomials are too long"
        raise LimitError("degrees", degrees, problem)
    if hasattr(kind, "step"):
        return _by_series(scheme, kind, degrees, separable, timed)
    return _by_conditions(scheme, kind, degrees, separable, timed)


def quantifier(scheme: Scheme, degrees: int, *, separable: bool, timed: bool) -> str:
    """For which H it is proved, in words."""
    t = ", t" * timed
    both = f"H = T(p{t}) + V(q{t})" if separable or scheme.needs_separable else f"H(p, q{t})"
    return f"every smooth {both} in {degrees} degrees of freedom"


# -- by conditions --------------------------------------------------------------------------------


def _by_conditions(
    scheme: Scheme, kind: Any, degrees: int, separable: bool, timed: bool
) -> SymplecticProof:
    """What the plane's proof says of the order, and the conditions that suffice for S ≡ 0."""
    planar = prove_every_in_time(scheme.name) if timed else prove_every(scheme.name, separable)
    own = kind.conditions(scheme.every_h)
    wrong = first_wrong(own)
    verdict, reason, agreed = planar.verdict, planar.reason, planar.convergence_order
    symplectic = True if wrong is None and own else None
    if planar.nearby is not None and verdict is planar.nearby.verdict and symplectic:
        reason = prose("symplectic, and ", told_nearby(planar.nearby))
    elif verdict is Verdict.PROVED:
        verdict = Verdict.PROVED if symplectic else Verdict.UNDECIDED
        held = "every condition on the coefficients holds exactly"
        reason = prose(f"symplectic, and of order {scheme.order}: {held}")
        if not symplectic:
            reason = prose("of what suffices for a symplectic map one condition does not hold")
        elif not _suffices(scheme.every_h, scheme.order):
            verdict = Verdict.UNDECIDED
            reason = prose("symplectic; its order is known in the plane, where fewer trees count")
    return replace(
        _blank(scheme, degrees, agreed if agreed is not None else -1),
        verdict=verdict,
        reason=reason,
        symplectic=symplectic,
        area_preserving=symplectic,
        conditions=(*(c for c in planar.conditions if c.order), *own),
        checked=planar.checked,
        telescopes=True if symplectic else None,
        potential="0" if symplectic else "",
        convergence_decided=planar.convergence_decided,
        nearby=planar.nearby,
    )


def _suffices(every_h: object, order: int) -> bool:
    """Whether the conditions that hold in the plane are those of n degrees of freedom."""
    return not isinstance(every_h, TreeConditions) or all_trees_hold(every_h.tableau, order)


def _domain(scheme: Scheme) -> Domain:
    return EVERYWHERE if scheme.explicit else Domain.of((), SOLVABLE)


# -- by series ------------------------------------------------------------------------------------


def _by_series(
    scheme: Scheme, kind: Any, degrees: int, separable: bool, timed: bool
) -> SymplecticProof:
    every_h, most = scheme.every_h, scheme.order + 1
    flow = JetFlow.of_degrees(degrees, most + 2, separable=separable, timed=timed)
    series = DefectSeries(lambda n: (flow, series_of(flow, kind.step(every_h), n)), most)
    agreed = next((n - 1 for n in range(most + 1) if series.agrees(n)[0] is not True), most)
    own = kind.conditions(every_h)
    if own and first_wrong(own) is None:
        found = _symplectic(scheme, degrees, agreed, own)
        return replace(found, convergence_decided=agreed < most)
    order = next((m for m in range(most + 1) if series.form(m).entries), None)
    if order is None:
        found = _undecided(scheme, degrees, agreed, most)
        return replace(found, convergence_decided=agreed < most)
    leading = series.form(order)
    volume = series.delta_j(order)[order]
    found = SymplecticProof(
        verdict=Verdict.PROVED,
        reason=read_prose(
            f"the coefficients of S below `h^{order}` vanish for every H, that of `h^{order}` "
            "does not"
        ),
        degrees=degrees,
        order=order,
        leading=leading,
        symplectic=False,
        area_preserving=False if not volume.is_zero() else None,
        volume_order=order if not volume.is_zero() else None,
        volume_leading=flow.ring.text(volume),
        convergence_order=agreed,
        convergence_decided=agreed < most,
        domain=_domain(scheme),
        entry=leading.called(next(iter(leading.entries))),
        checked=(read_prose(f"the entries of S up to `h^{order - 1}` are zero polynomials"),),
    )
    if isinstance(every_h, TaylorSeries):
        found = _telescoping(found, flow, every_h.eta, leading)
    return _held_to(scheme, found)


def _telescoping(
    found: SymplecticProof, flow: JetFlow, eta: int, leading: TwoForm
) -> SymplecticProof:
    """What is known of lieη, each identity checked."""
    by = "D" if flow.timed else "X"
    own = f"−1/{eta + 1}! Σ_i (d({by}^{eta + 1} p_i)∧dq_i + dp_i∧d({by}^{eta + 1} q_i))"
    checked, size = [*found.checked], len(flow.names) + flow.timed
    if size ** (eta + 1) <= _MOST_TERMS and not (_of_flow(flow, eta) - leading).entries:
        found = replace(found, formula=own)
        checked.append(prose(read_prose(f"that of `h^{eta + 1}` is "), Formula(own)))
    if eta % 2 == 0:
        potential = potential_of_lie(flow, eta)
        if (lie_derivative(flow, potential) - leading).entries:
            return replace(found, checked=tuple(checked))
        checked.append(prose("the Lie derivative of β is that coefficient"))
        terms = f"Σ_k (−1)^k Σ_i d({by}^({eta}−k) p_i)∧d({by}^k q_i), k = 0 … {eta}"
        why = f"β = −1/{eta + 1}! {terms}"
        written = potential.text if potential.length <= MOST_TERMS else why
        return replace(found, telescopes=True, potential=written, why=why, checked=tuple(checked))
    at_rest = leading.divergence.subs(flow.at_rest)
    if at_rest.is_zero():
        return replace(found, checked=tuple(checked))
    why = "where f vanishes a Lie derivative has no divergence, and this has one"
    return replace(found, telescopes=False, why=why, checked=tuple(checked))


def _of_flow(flow: JetFlow, eta: int) -> TwoForm:
    """−1/(η+1)! ([η+1, 0] + [0, η+1])."""
    n, ring = flow.degrees, flow.ring
    last = [flow.gradient(x) for x in flow.power(eta + 1)]
    first = [flow.gradient(x) for x in flow.start]
    share = ring.constant(Fraction(-1, math.factorial(eta + 1)))

    def entry(a: int, b: int) -> Poly:
        total = ring.zero
        for i in range(n):
            total += wedge(last[i], first[n + i], a, b) + wedge(first[i], last[n + i], a, b)
        return share * total

    return TwoForm.of(ring, flow.names, entry)


# -- the verdict ----------------------------------------------------------------------------------


def _held_to(scheme: Scheme, found: SymplecticProof) -> SymplecticProof:
    """REFUTED where the scheme claims more."""
    agreed = found.convergence_order
    if agreed is not None and agreed < scheme.order:
        return replace(found, verdict=Verdict.REFUTED, reason=missed(scheme, agreed))
    if scheme.area_preserving and found.symplectic is False:
        reason = prose(f"{scheme.name} claims to be symplectic; S has order {found.order}")
        return replace(found, verdict=Verdict.REFUTED, reason=reason)
    return found


def _symplectic(
    scheme: Scheme, degrees: int, agreed: int, own: tuple[Condition, ...]
) -> SymplecticProof:
    """Of stages that are solved for: S ≡ 0 by what their coefficients fulfil."""
    return _held_to(
        scheme,
        replace(
            _blank(scheme, degrees, agreed),
            verdict=Verdict.PROVED,
            reason=prose("S is the zero form for every H: the map is symplectic, stage by stage"),
            symplectic=True,
            area_preserving=True,
            telescopes=True,
            potential="0",
            conditions=own,
        ),
    )


def _undecided(scheme: Scheme, degrees: int, agreed: int, most: int) -> SymplecticProof:
    said = f"the coefficients of S up to `h^{most}` vanish; whether all do is not decided"
    return replace(_blank(scheme, degrees, agreed), reason=read_prose(said))


def _blank(scheme: Scheme, degrees: int, agreed: int) -> SymplecticProof:
    return SymplecticProof(
        verdict=Verdict.UNDECIDED, reason=Prose(), degrees=degrees, order=None, leading=None,
        symplectic=None, area_preserving=None, volume_order=None, volume_leading="0",
        convergence_order=agreed, domain=_domain(scheme),
    )  # fmt: skip
