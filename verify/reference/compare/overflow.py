"""Whether a program in doubles may leave their range on a run, where the reference data do not.

It does where the toolkit's own step does in doubles; and another program may where a number of the
run, or a product of its determinants, is not far from the largest double.
"""

from dataclasses import replace
from fractions import Fraction
from functools import lru_cache

import numpy as np

from verify.arithmetic.float_context import FLOAT
from verify.flows.extrapolation_of_many import arrays
from verify.kernels.kernel import kernel_for
from verify.kernels.orbit import Orbit
from verify.reference.compare.allowance import products
from verify.reference.compare.scatter import inputs_of, run_of
from verify.reference.make.orbit_points import Bounded

_LARGE = Fraction(10) ** 250  # what is summed up or multiplied on the way to it may be larger
_MOST_STEPS = 20_000  # stepped


def may_overflow(orbit: Orbit, step: int, known: dict[str, Bounded]) -> bool:
    """Within so many steps and the next; `known` are the run's numbers then, the state among them
    unless it has left the reference data's range, too."""
    if any(name not in known for name in orbit.hamiltonian.coordinates):
        return _overflows(orbit, step)
    if any(abs(value) > _LARGE for value, _ in known.values()):
        return True
    return products(orbit, step, known) > _LARGE or _overflows(orbit, step)


@lru_cache(maxsize=4096)
def _overflows(orbit: Orbit, step: int) -> bool:
    run = run_of(orbit)
    if run.implicit:
        return False
    arithmetic = replace(arrays(), bits=FLOAT.prec, number=FLOAT.rational)
    try:
        kernel = kernel_for(run.hamiltonian, orbit.scheme, arithmetic, run.observables, False)
        given = [FLOAT.rational(x) for x in inputs_of(run, kernel, arithmetic)]
        begun = [orbit.start[name] for name in kernel.coordinates]
        state = [FLOAT.rational(Fraction(x)) for x in (*begun, *kernel.start)]
    except OverflowError:  # what is given is no double
        return True
    with np.errstate(all="ignore"):
        _, *after = kernel.function(min(step, _MOST_STEPS) + 1, *given, *state)
    return not np.isfinite(np.array(after, dtype=float)).all()
