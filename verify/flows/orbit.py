"""How the exact orbit runs over a time: how far it goes, how stiff it is, whether it leaves.

What a stability verdict needs to know of the exact solution, before any scheme is looked at. The
flow is followed with few digits until it closes (in phase space, or up to a period of H in p or q),
or until the time is over. Lengths are measured in each coordinate by the orbit's own reach, so that
neither the size of an orbit nor the units of p and q matter.

Where H depends on time nothing closes, and nothing rests: the orbit is followed to its end.
"""

from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from typing import NamedTuple

from verify.errors import InputError
from verify.flows.extrapolation import NoFlowError
from verify.flows.orbit_search import ExactOrbit as ExactOrbit
from verify.flows.orbit_search import OrbitSearch
from verify.flows.solution import NOT_KNOWN, leaves_by_algebra
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import prose


# The maps of several schemes have the same orbits, some hundreds.
@lru_cache(maxsize=4096)
def exact_orbit(
    hamiltonian: Hamiltonian, p: Fraction, q: Fraction, time: Fraction, t0: Fraction = Fraction(0)
) -> ExactOrbit:
    """The orbit through (p, q), at t0 where H depends on it, for the length `time`."""
    known = _closed_orbit(hamiltonian, p, q)
    if known and time >= known[0].least_time:
        return known[0].orbit
    search = OrbitSearch(hamiltonian, (p, q), time, t0)
    orbit = search.orbit()
    if search.least_time is not None:
        known[:] = [_ClosedOrbit(orbit, search.least_time)]
    if hamiltonian.time_dependent or orbit.kind not in ("escapes", "open"):
        return orbit
    exactly = _by_algebra(hamiltonian, p, q, time)
    if exactly is None:
        return orbit
    return replace(
        orbit,
        summary=prose(exactly) if orbit.kind == "escapes" else prose(orbit.summary, "; ", exactly),
    )


class _ClosedOrbit(NamedTuple):
    """An orbit that a search has followed until it closed, as one over any time from `least_time`
    on does, by the same steps."""

    orbit: ExactOrbit
    least_time: Fraction


@lru_cache(maxsize=4096)
def _closed_orbit(hamiltonian: Hamiltonian, p: Fraction, q: Fraction) -> list[_ClosedOrbit]:
    """That through a point, once one is known."""
    return []


def _by_algebra(hamiltonian: Hamiltonian, p: Fraction, q: Fraction, time: Fraction) -> str | None:
    """How it leaves, of an orbit for which that is known so."""
    try:
        summary = leaves_by_algebra(hamiltonian, p=p, q=q, time=time)
    except (InputError, NoFlowError):
        return None
    return None if summary is None or summary == NOT_KNOWN else summary.removeprefix("it ")
