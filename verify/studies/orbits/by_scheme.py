"""Where the orbit of a scheme passes a surface.

Its states are z_0, z_1, …; where the surface lies between z_k and z_(k+1) = Φ_h(z_k) the orbit is
taken to pass it at Φ_θ(z_k), the scheme's own step of length θ ≤ h that ends on it. For the exact
flow that is the true place. θ is found to all digits, so that nothing is interpolated; a pass that
begins and ends within one step, by an orbit that touches the surface, is not seen.
"""

import contextlib
from collections.abc import Iterator, Mapping
from fractions import Fraction
from itertools import chain, pairwise
from typing import Any

from verify.arithmetic.systems import mpfr
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import kernel_for
from verify.kernels.stepping import KernelRun
from verify.lockstep import alone
from verify.studies.orbits.passes import Passes, State, Surface

_BLOCK = 1000  # steps between looks at them
_MOST_TRIES = 200  # of θ: regula falsi with Illinois's halving takes some twelve
_SPARE = 3  # of the digits, beyond which θ is not looked for


class OutOfRangeError(Exception):
    """A step leaves where H is defined."""


def passes(
    hamiltonian: Hamiltonian,
    scheme: str,
    start: Mapping[str, Fraction],
    surface: Surface,
    *,
    step_size: Fraction,
    steps: int,
    digits: int,
) -> Passes:
    """All passes within so many steps from the start, p1 … qn by their names, with these digits."""
    by = _Steps(hamiltonian, scheme, step_size, digits)
    own = by.own
    z = [own.number(start[name]) for name in surface.names]
    value, found, done = own.number(surface.value), [], 0
    with own.context(), contextlib.suppress(OutOfRangeError):
        for before, after in pairwise(chain([z], by.walk(z, steps))):
            done += 1
            if surface.height(before, value) < 0 <= surface.height(after, value):
                at = by.on_surface(before, surface, value)
                found.append({n: own.exact(x) for n, x in zip(surface.names, at, strict=True)})
    return Passes(found, left=done < steps)


class _Steps:
    """Steps of a scheme from any state, in mpfr, which has every range."""

    def __init__(self, hamiltonian: Hamiltonian, scheme: str, h: Fraction, digits: int) -> None:
        self.own, self.digits = mpfr.make(digits), digits
        given = {"h": h} | dict.fromkeys(hamiltonian.coordinates, Fraction(0))
        run = KernelRun(hamiltonian, scheme, given, 1, frozenset(), 0)
        self.kernel = kernel_for(run.hamiltonian, scheme, self.own, frozenset())
        self.inputs = [self.own.number(x) for x in run.inputs(self.kernel, 0).values()]

    def walk(self, z: State, steps: int) -> Iterator[State]:
        """The states after 1, 2, … steps; fewer where one leaves where H is defined."""
        while steps > 0:
            count = min(_BLOCK, steps)
            found = alone(self.own.states(self.kernel.function, 1, count, self.inputs, tuple(z)))
            yield from found
            if len(found) < count:
                return
            z, steps = found[-1], steps - count

    def after(self, z: State, time: Any) -> State:
        """Φ_time(z). Raises OutOfRangeError."""
        given = [time, *self.inputs[1:]]
        found = alone(self.own.states(self.kernel.function, 1, 1, given, tuple(z)))
        if not found:
            raise OutOfRangeError
        return found[0]

    def on_surface(self, z: State, surface: Surface, value: Any) -> State:
        """Φ_θ(z) on the surface, which lies between z and the end of its step."""
        low, high = self.own.number(Fraction(0)), self.inputs[0]
        near = high * self.own.number(Fraction(1, 10 ** (self.digits - _SPARE)))
        end = self.after(z, high)
        below, above = surface.height(z, value), surface.height(end, value)
        kept = 0  # which end has stayed
        for _ in range(_MOST_TRIES):
            time = high - above * (high - low) / (above - below)
            at = self.after(z, time)
            height = surface.height(at, value)
            if height < 0:
                low, below, above = time, height, above / 2 if kept > 0 else above
                kept = 1
            else:
                high, above, below, end = time, height, below / 2 if kept < 0 else below, at
                kept = -1
            if height == 0 or high - low <= near:
                return at
        return end
