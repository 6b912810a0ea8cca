"""The exact orbit over a time: its reach, its stiffness, and whether it leaves every bound.

A stability verdict needs these facts of the exact solution before it looks at any scheme. The
flow is followed with some 20 digits until the orbit closes (in phase space, or up to a period of H
in p or q), leaves, or the time is over. Lengths are measured in each coordinate by the orbit's own
reach, so that neither the size of an orbit nor the units of p and q matter.

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


# The stability maps of several schemes ask for the same orbits, some hundreds of them.
@lru_cache(maxsize=4096)
def exact_orbit(
    hamiltonian: Hamiltonian, p: Fraction, q: Fraction, time: Fraction, t0: Fraction = Fraction(0)
) -> ExactOrbit:
    """Return the orbit through (p, q) over `time`, from t0 on where H depends on t."""
    # The cache is a list that is filled in place, since `lru_cache` cannot store a value later.
    cache = _orbit_cache(hamiltonian, p, q)
    if cache and time >= cache[0].least_time:
        return cache[0].orbit
    search = OrbitSearch(hamiltonian, (p, q), time, t0)
    orbit = search.find_orbit()
    if search.least_time is not None:
        cache[:] = [_CachedOrbit(orbit, search.least_time)]
    if hamiltonian.time_dependent or orbit.kind not in ("escapes", "open"):
        return orbit
    statement = _describe_departure(hamiltonian, p, q, time)
    if statement is None:
        return orbit
    return replace(
        orbit,
        summary=prose(statement)
        if orbit.kind == "escapes"
        else prose(orbit.summary, "; ", statement),
    )


class _CachedOrbit(NamedTuple):
    """An orbit that was followed until it closed.

    A search over any time ≥ `least_time` takes the same steps and finds the same orbit.
    """

    orbit: ExactOrbit
    least_time: Fraction


@lru_cache(maxsize=4096)
def _orbit_cache(hamiltonian: Hamiltonian, p: Fraction, q: Fraction) -> list[_CachedOrbit]:
    """Return a list for the closed orbit through a point: empty until a search fills it."""
    return []


def _describe_departure(
    hamiltonian: Hamiltonian, p: Fraction, q: Fraction, time: Fraction
) -> str | None:
    """Describe how the orbit leaves every bound; None if algebra does not decide it."""
    try:
        summary = leaves_by_algebra(hamiltonian, p=p, q=q, time=time)
    except (InputError, NoFlowError):
        return None
    return None if summary is None or summary == NOT_KNOWN else summary.removeprefix("it ")
