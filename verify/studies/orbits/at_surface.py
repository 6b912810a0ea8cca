"""A map's orbits where they pass a surface, and how far they are known.

An orbit in a chaotic sea loses a digit in every few turns, whatever the arithmetic. So each is
followed twice: by a scheme with the digits that are asked for and with more of them, by the exact
flow with extrapolations of two orders. Where the two part, the points are no more the orbit's own.
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
from verify.studies.orbits.passes import Passes, Surface, together

_MORE = 20  # digits
_COLUMNS = 8, 7  # of the exact flow's two extrapolations
_SAME = Fraction(1, 10**6)  # of 1 + the farthest that the points are from 0: one point
_SHOWN = 7  # digits of a point
_OF_ENERGY, _SPARE = 10, 20  # digits
Start = Mapping[str, Fraction]


@dataclass(frozen=True)
class Asked:
    """What is asked of a map: passes of this surface within so many steps, and what is drawn."""

    hamiltonian: Hamiltonian
    surface: Surface
    draw: tuple[str, str]
    step_size: Fraction
    steps: int
    digits: int


def sections_of(asked: Asked, name: str, starts: Sequence[Start]) -> MapSections:
    """Orbits by the scheme of this name, or by EXACT_FLOW, from each start, p1 … qn by their
    names."""
    begun, exact = time.perf_counter(), name == EXACT_FLOW
    pairs = _exact(asked, starts) if exact else [_by_scheme(asked, name, z) for z in starts]
    return MapSections(
        map=name,
        orbits=tuple(_orbit(asked, z, *pair) for z, pair in zip(starts, pairs, strict=True)),
        arithmetic="long double" if exact else mpfr.NAME,
        digits=by_exact_flow.digits() if exact else asked.digits,
        seconds=time.perf_counter() - begun,
    )


def _exact(asked: Asked, starts: Sequence[Start]) -> list[tuple[Passes, Passes]]:
    time = asked.step_size * asked.steps
    both = (
        by_exact_flow.passes_together(asked.hamiltonian, starts, asked.surface, time, columns)
        for columns in _COLUMNS
    )
    return list(zip(*both, strict=True))


def _by_scheme(asked: Asked, name: str, start: Start) -> tuple[Passes, Passes]:
    one, other = (
        by_scheme.passes(
            asked.hamiltonian, name, start, asked.surface,
            step_size=asked.step_size, steps=asked.steps, digits=asked.digits + more,
        )
        for more in (0, _MORE)
    )  # fmt: skip
    return one, other


def _orbit(asked: Asked, start: Start, found: Passes, again: Passes) -> PoincareOrbit:
    size = 1 + max((abs(z[n]) for z in found.states for n in asked.draw), default=Fraction(0))
    known, error = together(found.states, again.states, _SAME * size)
    return PoincareOrbit(
        q=tuple(text(x) for name, x in start.items() if name[0] == "q"),
        p=tuple(text(x) for name, x in start.items() if name[0] == "p"),
        energy=_energy(asked.hamiltonian, start),
        points=tuple(_drawn(z, asked.draw) for z in found.states),
        known=known,
        error=upper(error),
        left=found.left,
    )


def _drawn(z: Start, draw: tuple[str, str]) -> tuple[str, str]:
    x, y = (decimal(z[name], _SHOWN) for name in draw)
    return x, y


def _energy(hamiltonian: Hamiltonian, start: Start) -> str:
    """H there, to so many digits."""
    at = [[start[name]] for name in hamiltonian.coordinates]
    (found,) = energies_at(hamiltonian, _OF_ENERGY + _SPARE, at)
    return decimal(fraction(found), _OF_ENERGY)
