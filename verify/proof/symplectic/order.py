"""The order in h of S = JᵀΩJ − Ω for one H(p1 … pn, q1 … qn), and the order of the map itself.

In the plane S is ΔJ dp∧dq; in more degrees of freedom det J ≡ 1 is the weaker half, so both are
looked at. A map that does nothing is symplectic, so its order is proved beside.
"""

from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from verify.algebra.domain import EVERYWHERE, Domain
from verify.algebra.ring import Decision, Poly, Ring
from verify.hamiltonians.canonical_field import CanonicalField
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.claimed import IN_DEGREES, Claimed, Convergence, held_to
from verify.proof.expansion import series_of
from verify.proof.order import convergence_by, nearby_convergence, nearby_defect_of, with_nearby
from verify.proof.parameters import not_zero_for
from verify.proof.symplectic import closed_form
from verify.proof.symplectic.proof import SymplecticProof
from verify.proof.telescoping import telescopes_of_lie
from verify.schemes.degrees import map_in_degrees
from verify.schemes.degrees.canonical_map import CanonicalMap
from verify.schemes.degrees.defect import DefectSeries
from verify.schemes.degrees.two_form import Place, TwoForm
from verify.schemes.scheme import Scheme

_MOST = 8  # powers of h that are looked at; more where a scheme claims a higher order


@dataclass(frozen=True)
class _Defect:
    """The first coefficient of S that is not shown to vanish; `decision.zero` True where S ≡ 0.

    `power` None with `decision.zero` False: S is not 0, and its coefficients that were looked at
    are.
    """

    power: int | None
    decision: Decision
    form: TwoForm | None = None
    place: Place | None = None
    ring: Ring | None = None  # the form's


_NONE = _Defect(None, Decision(True))


def prove_symplectic(hamiltonian: Hamiltonian, scheme: Scheme) -> SymplecticProof:
    """The order of S and of the map by exact algebra, and whether the scheme's claims hold.

    Raises InputError for an H that the scheme does not take.
    """
    return prove_map(map_in_degrees(scheme, hamiltonian), Claimed.of(scheme), scheme)


def prove_map(
    step: CanonicalMap, claimed: Claimed, scheme: Scheme | None = None
) -> SymplecticProof:
    """The same of a map that is made, by a scheme if by one."""
    series = series_of(step, claimed.order + 1)
    most = max(_MOST, claimed.order + 1)
    printed = convergence_by(series, step.flow_up_to + 1, most)
    convergence, near = nearby_convergence(
        scheme, printed, step.hamiltonian, partial(_of_scheme, step, most)
    )
    defect = _within(step.domain, _defect(step, series, most))
    first = defect.power, defect.decision.zero
    without = nearby_defect_of(scheme, step.hamiltonian, defect.power)
    judged = held_to(claimed, convergence, first, most, IN_DEGREES)
    verdict, reason = with_nearby(judged, near, without, "S")
    found = _Rest(step, series, defect, most)
    return SymplecticProof(
        verdict=verdict,
        reason=reason,
        degrees=step.field.degrees,
        order=defect.power if defect.decision.zero is False else None,
        leading=defect.form,
        symplectic=defect.decision.zero,
        convergence_order=convergence.order,
        convergence_decided=convergence.decided,
        domain=step.domain & _parameters(defect),
        entry=defect.form.called(defect.place) if defect.form and defect.place else "",
        witness=defect.decision.witness,
        enclosure=defect.decision.enclosure,
        conditions=step.conditions,
        nearby=near,
        **found.volume(),
        **found.telescoping(),
    )


def _of_scheme(step: CanonicalMap, most: int, scheme: Scheme) -> Convergence:
    made = map_in_degrees(scheme, step.hamiltonian)
    return convergence_by(series_of(made, most), made.flow_up_to + 1, most, residues=True)


# -- S ---------------------------------------------------------------------------------------------


def _defect(step: CanonicalMap, series: DefectSeries[CanonicalField], most: int) -> _Defect:
    if step.symplectic_by_conditions:
        return _NONE
    highest = 2 * step.degree if step.degree is not None else most
    for m in range(highest + 1):
        form = series.form(m)
        decision, place = form.decide()
        if decision.zero is not True:
            return _Defect(m, decision, form, place, series.flow.ring)
    if step.degree is not None:  # S is a polynomial in h, all of whose coefficients vanish
        return _NONE
    if step.closed is None:
        return _Defect(None, Decision(None))
    form = closed_form.defect(step.ring, step.field.names, step.closed)
    decision, place = form.decide()
    shown = _Defect(None, decision, form, place, step.ring)
    return _NONE if decision.zero is True else shown


def _within(domain: Domain, defect: _Defect) -> _Defect:
    """With a witness in the domain; where it has no point nothing is said."""
    if defect.form is None or defect.ring is None or not domain.requirements:
        return defect
    if defect.decision.zero is not False:
        return defect
    decision, place = defect.form.decide(partial(domain.decide, defect.ring))
    return replace(defect, decision=decision, place=place)


def _parameters(defect: _Defect) -> Domain:
    """Those for which the entry that is shown is not the zero function."""
    if defect.form is None or defect.place is None or defect.ring is None:
        return EVERYWHERE
    if defect.decision.zero is not False:
        return EVERYWHERE
    x = defect.form.entries[defect.place]
    return not_zero_for(defect.ring, x, f"the entry {defect.form.called(defect.place)} of S")


# -- what goes with it ----------------------------------------------------------------------------


@dataclass(frozen=True)
class _Rest:
    step: CanonicalMap
    series: DefectSeries[CanonicalField]
    defect: _Defect
    most: int

    def volume(self) -> dict[str, Any]:
        """Whether det J ≡ 1, and the order of det J − 1 where it is not."""
        found: dict[str, Any] = {"volume_order": None, "volume_leading": "0"}
        if self.defect.decision.zero is not False:
            return {"area_preserving": self.defect.decision.zero, **found}
        first = self._first_of_delta_j()
        if first is None:
            own = self.step
            exact = closed_form.preserves_volume(own.ring, own.field.names, own.closed)
            return {"area_preserving": exact, **found}
        power, ring, x = first
        return {"area_preserving": False, "volume_order": power, "volume_leading": ring.text(x)}

    def _first_of_delta_j(self) -> tuple[int, Ring, Poly] | None:
        """The first coefficient of ΔJ that is shown not to vanish, before any that is undecided."""
        ring = self.series.flow.ring
        begin = self.defect.power or 0
        for most in range(begin, self.most + 1):
            x = self.series.delta_j(most)[most]
            zero = self.series.flow.ring.vanishes(x)
            if zero is not True:
                return (most, ring, x) if zero is False else None
        return None

    def telescoping(self) -> dict[str, Any]:
        """Of lieη; of other maps it is not known."""
        eta, defect = self.step.flow_up_to, self.defect
        if eta < 1 or defect.power != eta + 1 or defect.form is None:
            known = True if defect.decision.zero is True else None  # 0 is the derivative of 0
            return {"telescopes": known, "potential": "0" if known else ""}
        holds, potential = telescopes_of_lie(self.series.flow, eta, defect.form)
        return {"telescopes": holds, "potential": potential}
