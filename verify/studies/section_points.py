"""Sections of orbits, at periods or on a surface, and the number of points that are certain.

An orbit in a chaotic sea loses a digit in every few turns, whatever the arithmetic. So each is
computed more than once, and after two computations part, the points are no longer those of the
orbit. At multiples of a period a scheme is followed with the requested digits, with more of them,
and in float64; to a surface with the requested digits and with more of them, and the exact flow
with extrapolations of two orders (`verify.studies.surface_passes`).
"""

import contextlib
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from verify import arithmetic as number_systems
from verify.arithmetic.exact import decimal, fraction, text, upper
from verify.arithmetic.number_system import UnsupportedError
from verify.arithmetic.systems import float64, mpfr
from verify.flows.compiled_functions import energies_at
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun, RunOutcome
from verify.runs.digits_on_demand import choose
from verify.scenes.results import orbit_points
from verify.scenes.results.regions import EXACT_FLOW
from verify.studies.surface_passes import (
    Passes,
    Surface,
    count_agreeing,
    find_passes_of_exact_flow,
    find_passes_of_scheme,
    long_double_digits,
)

_EXTRA_DIGITS = 20  # the digits that the second, finer computation has more
_FLOAT_DIGITS = 17
_COLUMNS = 8, 7  # the columns of the two extrapolations that the exact flow is computed by
# Two computations have the same point if they differ by at most this, relative to 1 + the greatest
# |coordinate| of the orbit's points; in a picture a greater difference is not seen.
_POINT_TOLERANCE = Fraction(1, 10**6)
_PICTURE_TOLERANCE = Fraction(1, 10**3)
_POINT_DIGITS = 7  # printed digits of a point
_ENERGY_DIGITS, _ENERGY_GUARD_DIGITS = 10, 20
Start = Mapping[str, Fraction]


def sections_at_periods(
    hamiltonian: Hamiltonian,
    scheme: str,
    starts: Sequence[Mapping[str, Fraction]],
    *,
    steps: int,
    periods: int,
    digits: int,
) -> orbit_points.SchemeSections:
    """Return the states after 0, 1, … periods of so many steps, from each start.

    A start has p, q, h, and t if H depends on it.
    """
    start_time = time.perf_counter()
    observables = frozenset[str]()
    runs = [
        KernelRun(
            hamiltonian, scheme, dict(start), steps * periods, observables, 0,
            sections=periods, shares_kernel=len(starts) > 1,
        )
        for start in starts
    ]  # fmt: skip
    names = {choose(run, digits + _EXTRA_DIGITS) for run in runs}
    # One arithmetic for all orbits, so that they share a kernel, and the result names one.
    name = names.pop() if len(names) == 1 else _last_system()
    orbits = []
    for run in runs:
        passes, finer_passes = (
            _follow_by_periods(run, name, d, steps) for d in (digits, digits + _EXTRA_DIGITS)
        )
        float_passes = _follow_by_periods(run, float64.NAME, _FLOAT_DIGITS, steps)
        orbits.append(_build_stroboscopic_orbit(passes, finer_passes, float_passes))
    return orbit_points.SchemeSections(
        scheme=scheme,
        orbits=tuple(orbits),
        arithmetic=name,
        digits=digits,
        seconds=time.perf_counter() - start_time,
    )


def _follow_by_periods(run: KernelRun, name: str, digits: int, steps: int) -> Passes:
    """Return the states at the start and after each period."""
    outcome: RunOutcome | None = None
    with contextlib.suppress(UnsupportedError):
        outcome = run.run(number_systems.get(name, digits))
    if outcome is None or (outcome.done < run.steps and name != float64.NAME):
        outcome = run.run(number_systems.get(_last_system(), digits))
    finished_periods = outcome.done // steps
    return Passes((run.start, *outcome.trail[:finished_periods]), left=outcome.done < run.steps)


def _last_system() -> str:
    """Return the name of the number system that has every range and function."""
    return number_systems.automatic()[-1].name


def _build_stroboscopic_orbit(
    passes: Passes, finer_passes: Passes, float_passes: Passes
) -> orbit_points.StroboscopicOrbit:
    size = 1 + max(abs(z[name]) for z in passes.states for name in ("p", "q"))
    start = passes.states[0]
    return orbit_points.StroboscopicOrbit(
        q=text(start["q"]),
        p=text(start["p"]),
        points=tuple(
            (decimal(z["q"], _POINT_DIGITS), decimal(z["p"], _POINT_DIGITS)) for z in passes.states
        ),
        known=count_agreeing(passes.states, finer_passes.states, _POINT_TOLERANCE * size)[0] - 1,
        in_float64=count_agreeing(
            finer_passes.states, float_passes.states, _PICTURE_TOLERANCE * size
        )[0]
        - 1,
        left=passes.left,
    )


@dataclass(frozen=True)
class SectionRequest:
    """A request for passes of this surface within so many steps, and the two axes to draw."""

    hamiltonian: Hamiltonian
    surface: Surface
    draw: tuple[str, str]
    step_size: Fraction
    steps: int
    digits: int


def sections_at_surface(
    request: SectionRequest, name: str, starts: Sequence[Start]
) -> orbit_points.MapSections:
    """Return the passes of orbits by the scheme of this name, or by EXACT_FLOW, from each start.

    A start has p1 … qn by their names.
    """
    start_time, by_exact_flow = time.perf_counter(), name == EXACT_FLOW
    pairs_of_passes = (
        _follow_exact_flow(request, starts)
        if by_exact_flow
        else [_follow_scheme(request, name, z) for z in starts]
    )
    return orbit_points.MapSections(
        map=name,
        orbits=tuple(
            _build_poincare_orbit(request, z, *passes)
            for z, passes in zip(starts, pairs_of_passes, strict=True)
        ),
        arithmetic="long double" if by_exact_flow else mpfr.NAME,
        digits=long_double_digits() if by_exact_flow else request.digits,
        seconds=time.perf_counter() - start_time,
    )


def _follow_exact_flow(
    request: SectionRequest, starts: Sequence[Start]
) -> list[tuple[Passes, Passes]]:
    time = request.step_size * request.steps
    extrapolations = (
        find_passes_of_exact_flow(request.hamiltonian, starts, request.surface, time, columns)
        for columns in _COLUMNS
    )
    return list(zip(*extrapolations, strict=True))


def _follow_scheme(request: SectionRequest, name: str, start: Start) -> tuple[Passes, Passes]:
    passes, finer_passes = (
        find_passes_of_scheme(
            request.hamiltonian, name, start, request.surface,
            step_size=request.step_size, steps=request.steps, digits=request.digits + extra_digits,
        )
        for extra_digits in (0, _EXTRA_DIGITS)
    )  # fmt: skip
    return passes, finer_passes


def _build_poincare_orbit(
    request: SectionRequest, start: Start, passes: Passes, second_passes: Passes
) -> orbit_points.PoincareOrbit:
    # Points count as one where they agree to a part of the picture's extent.
    size = 1 + max((abs(z[n]) for z in passes.states for n in request.draw), default=Fraction(0))
    agreeing, error = count_agreeing(passes.states, second_passes.states, _POINT_TOLERANCE * size)
    return orbit_points.PoincareOrbit(
        q=tuple(text(x) for name, x in start.items() if name[0] == "q"),
        p=tuple(text(x) for name, x in start.items() if name[0] == "p"),
        energy=_energy(request.hamiltonian, start),
        points=tuple(_format_point(z, request.draw) for z in passes.states),
        known=agreeing,
        error=upper(error),
        left=passes.left,
    )


def _format_point(z: Start, draw: tuple[str, str]) -> tuple[str, str]:
    x, y = (decimal(z[name], _POINT_DIGITS) for name in draw)
    return x, y


def _energy(hamiltonian: Hamiltonian, start: Start) -> str:
    """Return H at the start, rounded for display."""
    columns = [[start[name]] for name in hamiltonian.coordinates]
    (energy,) = energies_at(hamiltonian, _ENERGY_DIGITS + _ENERGY_GUARD_DIGITS, columns)
    return decimal(fraction(energy), _ENERGY_DIGITS)
