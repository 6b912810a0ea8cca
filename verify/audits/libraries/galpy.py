"""galpy's integrators of orbits in one dimension, with `dt` equal to the length of the one step.

The potential is galpy's KGPotential, amp (K √(x² + D²) + F x²), from which galpy subtracts nothing.
The units are galpy's natural ones, so that H = v²/2 + amp (K √(x² + D²) + F x²).

For an amplitude A(t) that depends on time, an orbit in galpy's plane is used: on an axis it has one
degree of freedom as long as it does not pass the centre, with H = v²/2 + A(t) log(x² + 1/4)/2 and a
Gaussian A.
"""

from collections.abc import Iterator
from fractions import Fraction

from verify.audits.methods.driver import LONG_LADDER, USUAL_LADDER, integrator_from_script
from verify.audits.methods.integrator import FINE, Point, ReleasedIntegrator

TITLE = "galpy"
LIBRARY = "galpy"
LEFT_OUT = (
    ("odeint, dop853, dop853_c, ias15_c", "choose their steps by themselves: no map of a fixed h"),
    (
        "leapfrog (in Python)",
        "finds its own step from a tolerance of 10⁻¹² that Orbit.integrate does not let one set",
    ),
)
_ORDERS = {"leapfrog_c": 2, "symplec4_c": 4, "symplec6_c": 6, "rk4_c": 4, "rk6_c": 6}
_HAMILTONIAN = "p**2/2 + sqrt(q**2 + 1) + q**2/4"
_POINTS: tuple[Point, ...] = ((Fraction(1, 3), Fraction(3, 5)),)
_DRIVEN = "p**2/2 + exp(-(t - 1/2)**2/2)*log(q**2 + 1/4)"
_AHEAD: tuple[Point, ...] = ((Fraction(1, 3), Fraction(3, 2)), (Fraction(1, 2), Fraction(7, 4)))
_STEPS = {
    2: USUAL_LADDER[:16],
    4: USUAL_LADDER[:14],
    6: tuple(Fraction(x, 64) for x in (64, 56, 48, 40, 32, 28, 24, 20, 16, 14, 12, 10, 8, 7, 6)),
}
_HALO = "p1**2/2 + p2**2/2 + log(q1**2 + q2**2/(4/5)**2 + 1/4)"
_IN_THE_PLANE = """\
import warnings

import numpy as np
from galpy.orbit import Orbit
from galpy.potential import LogarithmicHaloPotential

pot = LogarithmicHaloPotential(amp=2.0, q=1.0, b=0.8, core=0.5).toPlanar()


def step(p, q, h):
    r, angle = np.hypot(*q), np.arctan2(q[1], q[0])
    ahead, aside = q / r, np.array([-q[1], q[0]]) / r
    o = Orbit([r, p @ ahead, p @ aside, angle])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it says of each orbit that C is used
        o.integrate(np.array([0.0, h]), pot, method="{method}", dt=h, progressbar=False)
    return np.array([o.vx(h), o.vy(h)]), np.array([o.x(h), o.y(h)])
"""
_ON_A_LINE = """\
import numpy as np
from galpy.orbit import Orbit
from galpy.potential import KGPotential

pot = KGPotential(amp=1.0, K=1.0, F=0.25, D=1.0)


def step(p, q, h):
    o = Orbit([q, p])
    o.integrate(np.array([0.0, h]), pot, method='{method}', dt=h, progressbar=False)
    return float(o.vx(h)), float(o.x(h))
"""
_IN_TIME = """\
import numpy as np
from galpy.orbit import Orbit
from galpy.potential import GaussianAmplitudeWrapperPotential, LogarithmicHaloPotential

halo = LogarithmicHaloPotential(amp=2.0, q=1.0, core=0.5).toPlanar()
pot = GaussianAmplitudeWrapperPotential(pot=halo, to=0.5, sigma=1.0)


def step(p, q, t, h):
    o = Orbit([q, p, 0.0, 0.0])
    o.integrate(np.array([t, t + h]), pot, method='{method}', dt=h, progressbar=False)
    return float(o.vx(t + h)), float(o.x(t + h))
"""
_SOURCE = "the documentation of galpy.orbit.Orbit.integrate"
# Points and step sizes by the claimed order; () for the usual ones.
_SAMPLES = {2: ((), ()), 4: ((), ()), 6: (_POINTS, FINE)}
_SAMPLES_IN_THE_PLANE = {2: ((), USUAL_LADDER), 4: ((), USUAL_LADDER), 6: ((), LONG_LADDER)}
_SAMPLES_IN_TIME = {order: (_AHEAD, sizes) for order, sizes in _STEPS.items()}
_PROBLEMS = (
    ("", "Orbit([q, p]).integrate([0, h], KGPotential, dt=h), one step", _SOURCE, _HAMILTONIAN,
     _ON_A_LINE, _SAMPLES),
    (", two degrees",
     "Orbit in the plane, its R, v_R, v_T, φ from x and y, integrate([0, h], …, dt=h)", _SOURCE,
     _HALO, _IN_THE_PLANE, _SAMPLES_IN_THE_PLANE),
    (", driven",
     "Orbit([q, p, 0, 0]).integrate([t, t + h], …, dt=h), one step in the plane, along its axis, "
     "with the amplitude exp(−(t − 1/2)²/2)",
     f"{_SOURCE}, and of GaussianAmplitudeWrapperPotential", _DRIVEN, _IN_TIME, _SAMPLES_IN_TIME),
)  # fmt: skip


def integrators() -> Iterator[ReleasedIntegrator]:
    for tag, driven, source, formula, lines, samples in _PROBLEMS:
        for name, order in _ORDERS.items():
            text = lines.replace("{method}", name)
            # Only the integrators whose names say so are claimed to be symplectic, and of driven
            # ones det J is not looked at again.
            symplectic = None if name.startswith("rk") or tag == ", driven" else True
            yield integrator_from_script(
                f"{name}{tag}", driven, source, formula, text, order, symplectic, *samples[order]
            )
