"""The systems used as examples in arguments: the paper's two, and the oscillator.

The oscillator H = (p² + q²)/2 from (q, p) = (1, 0) has an exact solution. With ζ = q + ip a step of
lieη is ζ' = R ζ, R = Σ (−ih)ⁿ/n!, n = 0 … η, and the exact solution is exp(−it). Balls (flint)
enclose the error; everything else is exact.
"""

from contextlib import AbstractContextManager
from fractions import Fraction

import flint

from verify.arithmetic.arb import rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.maps.step_map import StepMap
from verify.schemes.methods.taylor.lie import lie_map

SYSTEMS = ("duffing", "pendulum")


def with_symbols(name: str) -> Hamiltonian:
    """Return the H of that system, its parameters symbols."""
    return Hamiltonian(systems.get(name).hamiltonian().expression)


def duffing() -> Hamiltonian:
    """Return the Duffing oscillator with δ = 1."""
    return systems.get("duffing").hamiltonian().with_values({"delta": 1})


def duffing_step() -> StepMap:
    """Return the map of lie2 for the Duffing oscillator with δ = 1."""
    return lie_map(duffing(), 2)


# -- the oscillator -------------------------------------------------------------------------------


def oscillator() -> Hamiltonian:
    """Return H = (p² + q²)/2."""
    return systems.get("harmonic").hamiltonian().with_values({"omega": 1})


def enclosures() -> AbstractContextManager[None]:
    """Return the context in which balls have 256 bits."""
    return working_precision(256)


def factor(eta: int, h: Fraction) -> flint.acb:
    """Return R as a complex ball, in the caller's precision."""
    # z = −ih, and R is the exponential series of it up to zⁿ/n!.
    z = flint.acb(0, -rational_ball(h))
    total = term = flint.acb(1)
    for n in range(1, eta + 1):
        term = term * z / n
        total += term
    return total


def errors(eta: int, h: Fraction, steps: int) -> list[flint.acb]:
    """Return the errors exp(−ikh) − Rᵏ, k = 0 … steps, of the run from the exact solution.

    To be called in `enclosures()`.
    """
    # The exact solution turns by exp(−ih) in each step, the scheme multiplies by R.
    exact = flint.acb(0, -rational_ball(h)).exp()
    scheme = factor(eta, h)
    differences, rotation, image = [], flint.acb(1), flint.acb(1)
    for _ in range(steps + 1):
        differences.append(rotation - image)
        rotation, image = rotation * exact, image * scheme
    return differences


def final_error(eta: int, steps: int) -> flint.arb:
    """Return the norm of the error at T = 1 after `steps` steps, a real ball."""
    with enclosures():
        return abs(errors(eta, Fraction(1, steps), steps)[-1])
