"""A scheme's orbits once in each period, and the number of points that are certain.

An orbit in a chaotic sea loses a digit in every few periods, whatever the arithmetic. So each is
followed three times: with the requested digits, with more of them, and in float64. After the first
two part, the points are no longer those of the orbit.
"""

import contextlib
import time
from collections.abc import Mapping, Sequence
from fractions import Fraction

from verify import arithmetic as number_systems
from verify.arithmetic.exact import decimal, text
from verify.arithmetic.number_system import UnsupportedError
from verify.arithmetic.systems import float64
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun, RunOutcome
from verify.runs.digits_on_demand import choose
from verify.scenes.results.orbit_sections import SchemeSections, StroboscopicOrbit
from verify.studies.orbits.passes import Passes, count_agreeing

_MORE = 20  # digits
_SAME = Fraction(1, 10**6)  # of 1 + the farthest that the orbit is from 0: one point
_SEEN = Fraction(1, 10**3)  # of the same: one place in a picture
_SHOWN = 7  # digits of a point
_FLOAT_DIGITS = 17


def sections_of(
    hamiltonian: Hamiltonian,
    scheme: str,
    starts: Sequence[Mapping[str, Fraction]],
    *,
    steps: int,
    periods: int,
    digits: int,
) -> SchemeSections:
    """Return the states after 0, 1, … periods of so many steps, from each start.

    A start has p, q, h, and t where H depends on it.
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
    names = {choose(run, digits + _MORE) for run in runs}
    # One arithmetic for all orbits, so that they share a kernel, and the result names one.
    name = names.pop() if len(names) == 1 else _last_system()
    orbits = []
    for run in runs:
        exact, finer = (_follow(run, name, d, steps) for d in (digits, digits + _MORE))
        floats = _follow(run, float64.NAME, _FLOAT_DIGITS, steps)
        orbits.append(_build_orbit(exact, finer, floats))
    return SchemeSections(
        scheme=scheme,
        orbits=tuple(orbits),
        arithmetic=name,
        digits=digits,
        seconds=time.perf_counter() - start_time,
    )


def _follow(run: KernelRun, name: str, digits: int, steps: int) -> Passes:
    """Return the states at the start and after each period."""
    outcome: RunOutcome | None = None
    with contextlib.suppress(UnsupportedError):
        outcome = run.run(number_systems.get(name, digits))
    if outcome is None or (outcome.done < run.steps and name != float64.NAME):
        outcome = run.run(number_systems.get(_last_system(), digits))  # which has every range
    whole = outcome.done // steps
    return Passes((run.start, *outcome.trail[:whole]), left=outcome.done < run.steps)


def _last_system() -> str:
    return number_systems.automatic()[-1].name


def _build_orbit(exact: Passes, finer: Passes, floats: Passes) -> StroboscopicOrbit:
    size = 1 + max(abs(z[name]) for z in exact.states for name in ("p", "q"))
    start = exact.states[0]
    return StroboscopicOrbit(
        q=text(start["q"]),
        p=text(start["p"]),
        points=tuple((decimal(z["q"], _SHOWN), decimal(z["p"], _SHOWN)) for z in exact.states),
        known=count_agreeing(exact.states, finer.states, _SAME * size)[0] - 1,
        in_float64=count_agreeing(finer.states, floats.states, _SEEN * size)[0] - 1,
        left=exact.left,
    )
