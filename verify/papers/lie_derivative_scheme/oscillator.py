"""The oscillator H = (p² + q²)/2 from (q, p) = (1, 0), whose exact solution is known.

With ζ = q + ip a step of lieη is ζ' = R ζ, R = Σ (−ih)ⁿ/n!, n = 0 … η, and the exact solution is
exp(−it). Balls (flint) enclose the error; everything else is exact.
"""

from fractions import Fraction

import flint

from verify.arithmetic.flint_precision import working_precision

PRECISION = 256


def factor(eta: int, h: Fraction) -> flint.acb:
    """R as a complex ball; in the caller's precision."""
    z = flint.acb(0, -flint.arb(flint.fmpq(h.numerator, h.denominator)))
    total = term = flint.acb(1)
    for n in range(1, eta + 1):
        term = term * z / n
        total += term
    return total


def errors(eta: int, h: Fraction, steps: int) -> list[flint.acb]:
    """The errors exp(−ikh) − Rᵏ, k = 0 … steps, of the run that starts on the exact solution.

    To be called in `working_precision`.
    """
    exact = flint.acb(0, -flint.arb(flint.fmpq(h.numerator, h.denominator))).exp()
    scheme = factor(eta, h)
    found, turned, stepped = [], flint.acb(1), flint.acb(1)
    for _ in range(steps + 1):
        found.append(turned - stepped)
        turned, stepped = turned * exact, stepped * scheme
    return found


def final_error(eta: int, steps: int) -> flint.arb:
    """The norm of the error at T = 1 after `steps` steps, a real ball."""
    with working_precision(PRECISION):
        return abs(errors(eta, Fraction(1, steps), steps)[-1])
