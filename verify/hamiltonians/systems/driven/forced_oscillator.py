"""The harmonic oscillator with a force, q'' + ω₀² q = γ cos ωt, and its motion in closed form.

With w = ω₀, W = ω, g = γ and s = t − t₀ a particular solution is c cos Wt with c = g/(w² − W²), in
resonance g s sin(wt)/(2w), and for w = W = 0 g s²/2; the rest is free motion (Landau, Lifshitz,
Mechanics, section 22). It is evaluated in balls.
"""

from collections.abc import Mapping
from fractions import Fraction

import flint

from verify.arithmetic.arb import rational_ball
from verify.hamiltonians.named_system import System

Ball = flint.arb


def forced_oscillator(
    values: Mapping[str, Fraction], start: tuple[Fraction, Fraction, Fraction], time: Fraction
) -> tuple[Ball, Ball]:
    """Return p and q at `time` after `start`, which is p, q, t; in flint's current precision.

    `values`: omega0, gamma and omega, as `forced-oscillator` has them.
    """
    names = ("omega0", "gamma", "omega")
    w, g, drive = (rational_ball(values[name]) for name in names)
    p, q, t0 = map(rational_ball, start)
    s, t = rational_ball(time), rational_ball(start[2] + time)
    if values["omega0"] ** 2 != values["omega"] ** 2:
        c = g / (w**2 - drive**2)
        extra_q, extra_p = c * (drive * t).cos(), -c * drive * (drive * t).sin()
        first_q, first_p = c * (drive * t0).cos(), -c * drive * (drive * t0).sin()
    # Resonance at frequency 0: a constant force on a free particle.
    elif values["omega0"] == 0:
        extra_q, extra_p, first_q, first_p = g * s**2 / 2, g * s, Ball(0), Ball(0)
    else:
        # Resonance: the amplitude of the particular solution grows linearly in s.
        rate = g / (2 * w)
        extra_q, extra_p = rate * s * (w * t).sin(), rate * ((w * t).sin() + w * s * (w * t).cos())
        first_q, first_p = Ball(0), rate * (w * t0).sin()
    # The initial values without the particular solution's move freely; both are added at the end.
    free_q, free_p = q - first_q, p - first_p
    cosine, sine = (w * s).cos(), (w * s).sin()
    over = sine / w if values["omega0"] else s
    return extra_p - free_q * w * sine + free_p * cosine, extra_q + free_q * cosine + free_p * over


SYSTEM = System(
    name="forced-oscillator",
    title="forced oscillator",
    formula="p**2/2 + omega0**2*q**2/2 - gamma*q*cos(omega*t)",
    source="Landau, Lifshitz, Mechanics, section 22",
    parameters={
        "omega0": "angular frequency without the force",
        "gamma": "amplitude of the force",
        "omega": "its angular frequency",
    },
    flow_in_time=forced_oscillator,
    regimes={
        "forced": {"omega0": "1", "gamma": "1/2", "omega": "7/5", "p": "1/3", "q": "1"},
        "resonance": {"omega0": "3/2", "gamma": "1/2", "omega": "3/2", "p": "1/3", "q": "1"},
        "free": {"omega0": "0", "gamma": "1/2", "omega": "2", "p": "1/3", "q": "1"},
        "constant-force": {"omega0": "0", "gamma": "1/2", "omega": "0", "p": "1/3", "q": "1"},
    },
)
