"""A scheme's orbits once in each period, and how far they are known.

An orbit in a chaotic sea loses a digit in every few periods, whatever the arithmetic. So each is
followed three times: with the digits that are asked for, with more of them, and in float64; where
the first two part, the points after it are no more the orbit's own.
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
from verify.kernels.stepping import KernelRun, Outcome
from verify.runs.digits_on_demand import choose
from verify.scenes.results.orbit_sections import SchemeSections, StroboscopicOrbit
from verify.studies.orbits.passes import Passes, together

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
    """States after 0, 1, … periods of so many steps, from each start: p, q, h, and t where H
    depends on it."""
    begun = time.perf_counter()
    asked = frozenset[str]()
    runs = [
        KernelRun(
            hamiltonian, scheme, dict(start), steps * periods, asked, 0,
            sections=periods, shares_kernel=len(starts) > 1,
        )
        for start in starts
    ]  # fmt: skip
    names = {choose(run, digits + _MORE) for run in runs}
    name = names.pop() if len(names) == 1 else _last()
    found = []
    for run in runs:
        exact, finer = (_followed(run, name, d, steps) for d in (digits, digits + _MORE))
        floats = _followed(run, float64.NAME, _FLOAT_DIGITS, steps)
        found.append(_orbit(exact, finer, floats))
    return SchemeSections(
        scheme=scheme,
        orbits=tuple(found),
        arithmetic=name,
        digits=digits,
        seconds=time.perf_counter() - begun,
    )


def _followed(run: KernelRun, name: str, digits: int, steps: int) -> Passes:
    """The states at the start and after each period."""
    outcome: Outcome | None = None
    with contextlib.suppress(UnsupportedError):
        outcome = run.run(number_systems.get(name, digits))
    if outcome is None or (outcome.done < run.steps and name != float64.NAME):
        outcome = run.run(number_systems.get(_last(), digits))  # which has every range
    whole = outcome.done // steps
    return Passes((run.start, *outcome.trail[:whole]), left=outcome.done < run.steps)


def _last() -> str:
    return number_systems.automatic()[-1].name


def _orbit(exact: Passes, finer: Passes, floats: Passes) -> StroboscopicOrbit:
    size = 1 + max(abs(z[name]) for z in exact.states for name in ("p", "q"))
    start = exact.states[0]
    return StroboscopicOrbit(
        q=text(start["q"]),
        p=text(start["p"]),
        points=tuple((decimal(z["q"], _SHOWN), decimal(z["p"], _SHOWN)) for z in exact.states),
        known=together(exact.states, finer.states, _SAME * size)[0] - 1,
        in_float64=together(finer.states, floats.states, _SEEN * size)[0] - 1,
        left=exact.left,
    )
