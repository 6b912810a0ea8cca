"""Passes of a surface by the orbit of a scheme.

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
from verify.lockstep import run_alone
from verify.studies.orbits.passes import Passes, State, Surface

_BLOCK = 1000  # steps between looks at them
_MOST_TRIES = 200  # of θ: regula falsi with Illinois's halving takes some twelve
_SPARE = 3  # of the digits, beyond which θ is not looked for


class OutOfRangeError(Exception):
    """A step that leaves the domain of H."""


def find_passes(
    hamiltonian: Hamiltonian,
    scheme: str,
    start: Mapping[str, Fraction],
    surface: Surface,
    *,
    step_size: Fraction,
    steps: int,
    digits: int,
) -> Passes:
    """Find all passes within so many steps from the start, p1 … qn by names, with these digits."""
    by = _Steps(hamiltonian, scheme, step_size, digits)
    arithmetic = by.arithmetic
    z = [arithmetic.number(start[name]) for name in surface.names]
    value, states, done = arithmetic.number(surface.value), [], 0
    with arithmetic.context(), contextlib.suppress(OutOfRangeError):
        for before, after in pairwise(chain([z], by.walk(z, steps))):
            done += 1
            # A state on the surface itself counts with the step that ends there, not with the next
            # one.
            if surface.height(before, value) < 0 <= surface.height(after, value):
                state = by.solve_on_surface(before, surface, value)
                states.append(
                    {n: arithmetic.exact(x) for n, x in zip(surface.names, state, strict=True)}
                )
    return Passes(states, left=done < steps)


class _Steps:
    """Steps of a scheme from any state, in mpfr, which has every range."""

    def __init__(self, hamiltonian: Hamiltonian, scheme: str, h: Fraction, digits: int) -> None:
        self.arithmetic, self.digits = mpfr.make(digits), digits
        start_values = {"h": h} | dict.fromkeys(hamiltonian.coordinates, Fraction(0))
        run = KernelRun(hamiltonian, scheme, start_values, 1, frozenset(), 0)
        self.kernel = kernel_for(run.hamiltonian, scheme, self.arithmetic, frozenset())
        self.inputs = [self.arithmetic.number(x) for x in run.inputs(self.kernel, 0).values()]

    def walk(self, z: State, steps: int) -> Iterator[State]:
        """Yield the states after 1, 2, … steps; fewer where one leaves the domain of H."""
        while steps > 0:
            count = min(_BLOCK, steps)
            states = run_alone(
                self.arithmetic.states(self.kernel.function, 1, count, self.inputs, tuple(z))
            )
            yield from states
            if len(states) < count:
                return
            z, steps = states[-1], steps - count

    def step_from(self, z: State, time: Any) -> State:
        """Return Φ_time(z). Raises OutOfRangeError."""
        arguments = [time, *self.inputs[1:]]
        states = run_alone(self.arithmetic.states(self.kernel.function, 1, 1, arguments, tuple(z)))
        if not states:
            raise OutOfRangeError
        return states[0]

    def solve_on_surface(self, z: State, surface: Surface, value: Any) -> State:
        """Return Φ_θ(z) on the surface, which lies between z and the end of its step."""
        low, high = self.arithmetic.number(Fraction(0)), self.inputs[0]
        near = high * self.arithmetic.number(Fraction(1, 10 ** (self.digits - _SPARE)))
        end = self.step_from(z, high)
        below, above = surface.height(z, value), surface.height(end, value)
        last_side = (
            0  # the end that has stayed: its height is halved (Illinois), lest it stay for ever
        )
        for _ in range(_MOST_TRIES):
            time = high - above * (high - low) / (above - below)
            state = self.step_from(z, time)
            height = surface.height(state, value)
            if height < 0:
                low, below, above = time, height, above / 2 if last_side > 0 else above
                last_side = 1
            else:
                high, above, below, end = time, height, below / 2 if last_side < 0 else below, state
                last_side = -1
            if height == 0 or high - low <= near:
                return state
        return end
