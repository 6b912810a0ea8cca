"""A map's orbits where they pass a surface, and the number of passes that are certain.

An orbit in a chaotic sea loses a digit in every few turns, whatever the arithmetic. So each is
followed twice: by a scheme with the requested digits and with more of them, by the exact flow with
extrapolations of two orders. After the two part, the points are no longer those of the orbit.
"""

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from verify.arithmetic.exact import decimal, fraction, text, upper
from verify.arithmetic.systems import mpfr
from verify.flows.functions import energies_at
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.results.orbit_sections import MapSections, PoincareOrbit
from verify.scenes.results.regions import EXACT_FLOW
from verify.studies.orbits import by_exact_flow, by_scheme
from verify.studies.orbits.passes import Passes, Surface, count_agreeing

_MORE = 20  # digits
_COLUMNS = 8, 7  # of the exact flow's two extrapolations
_SAME = Fraction(1, 10**6)  # of 1 + the farthest that the points are from 0: one point
_SHOWN = 7  # digits of a point
_OF_ENERGY, _SPARE = 10, 20  # digits
Start = Mapping[str, Fraction]


@dataclass(frozen=True)
class SectionRequest:
    """A request to a map: passes of this surface within so many steps, and the axes to draw."""

    hamiltonian: Hamiltonian
    surface: Surface
    draw: tuple[str, str]
    step_size: Fraction
    steps: int
    digits: int


def sections_of(request: SectionRequest, name: str, starts: Sequence[Start]) -> MapSections:
    """Return the passes of orbits by the scheme of this name, or by EXACT_FLOW, from each start.

    A start has p1 … qn by their names.
    """
    start_time, exact = time.perf_counter(), name == EXACT_FLOW
    pairs = (
        _follow_exact_flow(request, starts)
        if exact
        else [_follow_scheme(request, name, z) for z in starts]
    )
    return MapSections(
        map=name,
        orbits=tuple(
            _build_orbit(request, z, *pair) for z, pair in zip(starts, pairs, strict=True)
        ),
        arithmetic="long double" if exact else mpfr.NAME,
        digits=by_exact_flow.digits() if exact else request.digits,
        seconds=time.perf_counter() - start_time,
    )


def _follow_exact_flow(
    request: SectionRequest, starts: Sequence[Start]
) -> list[tuple[Passes, Passes]]:
    time = request.step_size * request.steps
    both = (
        by_exact_flow.find_all_passes(request.hamiltonian, starts, request.surface, time, columns)
        for columns in _COLUMNS
    )
    return list(zip(*both, strict=True))


def _follow_scheme(request: SectionRequest, name: str, start: Start) -> tuple[Passes, Passes]:
    one, other = (
        by_scheme.find_passes(
            request.hamiltonian, name, start, request.surface,
            step_size=request.step_size, steps=request.steps, digits=request.digits + more,
        )
        for more in (0, _MORE)
    )  # fmt: skip
    return one, other


def _build_orbit(
    request: SectionRequest, start: Start, passes: Passes, again: Passes
) -> PoincareOrbit:
    # Points count as one where they agree to a part of the picture's extent.
    size = 1 + max((abs(z[n]) for z in passes.states for n in request.draw), default=Fraction(0))
    agreeing, error = count_agreeing(passes.states, again.states, _SAME * size)
    return PoincareOrbit(
        q=tuple(text(x) for name, x in start.items() if name[0] == "q"),
        p=tuple(text(x) for name, x in start.items() if name[0] == "p"),
        energy=_energy(request.hamiltonian, start),
        points=tuple(_format_point(z, request.draw) for z in passes.states),
        known=agreeing,
        error=upper(error),
        left=passes.left,
    )


def _format_point(z: Start, draw: tuple[str, str]) -> tuple[str, str]:
    x, y = (decimal(z[name], _SHOWN) for name in draw)
    return x, y


def _energy(hamiltonian: Hamiltonian, start: Start) -> str:
    """Return H at the start, rounded for display."""
    columns = [[start[name]] for name in hamiltonian.coordinates]
    (energy,) = energies_at(hamiltonian, _OF_ENERGY + _SPARE, columns)
    return decimal(fraction(energy), _OF_ENERGY)
