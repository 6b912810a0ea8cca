"""galpy's integrators of orbits in one dimension, with `dt` held at the length of the one step.

The potential is galpy's KGPotential, amp (K √(x² + D²) + F x²), of which galpy subtracts nothing.
Units are galpy's natural ones, so that H = v²/2 + amp (K √(x² + D²) + F x²).

An amplitude that depends on time is taken in the plane: an orbit on an axis is of one degree of
freedom, as long as it does not pass the centre: H = v²/2 + A(t) log(x² + 1/4)/2, with a Gaussian A.
"""

from collections.abc import Iterator
from fractions import Fraction
from functools import partial

from verify.integrators.others.methods.integrator import (
    FINE,
    FloatStep,
    Map,
    Point,
    ReleasedIntegrator,
)
from verify.integrators.others.methods.problems import LONG, USUAL
from verify.integrators.others.methods.scripted import Script

TITLE = "galpy"
LIBRARY = "galpy"
LEFT_OUT = (
    (
        "odeint, dop853, dop853_c, ias15_c",
        "choose their steps by themselves: no map of a fixed h",
    ),
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
    2: USUAL[:16],
    4: USUAL[:14],
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
_SOURCE = "the documentation of galpy.orbit.Orbit.integrate"


def integrators() -> Iterator[ReleasedIntegrator]:
    for name, order in _ORDERS.items():
        where = (_POINTS, FINE) if order > 4 else ()
        yield ReleasedIntegrator(
            name,
            "Orbit([q, p]).integrate([0, h], KGPotential, dt=h), one step",
            _SOURCE,
            FloatStep(_HAMILTONIAN, partial(_step, name), *where),
            order,
            None if name.startswith("rk") else True,
            _script(name),
        )

    for name, order in _ORDERS.items():
        text = _IN_THE_PLANE.replace("{method}", name)
        yield ReleasedIntegrator(
            f"{name}, two degrees",
            "Orbit in the plane, its R, v_R, v_T, φ from x and y, integrate([0, h], …, dt=h)",
            _SOURCE,
            FloatStep(_HALO, Script(text).step, (), LONG if order > 4 else USUAL),
            order,
            None if name.startswith("rk") else True,
            text,
        )
    for name, order in _ORDERS.items():
        yield ReleasedIntegrator(
            f"{name}, driven",
            "Orbit([q, p, 0, 0]).integrate([t, t + h], …, dt=h), one step in the plane, along its "
            "axis, with the amplitude exp(−(t − 1/2)²/2)",
            f"{_SOURCE}, and of GaussianAmplitudeWrapperPotential",
            FloatStep(_DRIVEN, partial(_in_time, name), _AHEAD, _STEPS[order]),
            order,
            None,
            _script_in_time(name),
        )


def _step(name: str) -> Map:
    import numpy as np
    from galpy.orbit import Orbit
    from galpy.potential import KGPotential

    potential = KGPotential(amp=1.0, K=1.0, F=0.25, D=1.0)

    def step(p: float, q: float, h: float) -> tuple[float, float]:
        orbit = Orbit([q, p])
        orbit.integrate(np.array([0.0, h]), potential, method=name, dt=h, progressbar=False)
        return float(orbit.vx(h)), float(orbit.x(h))

    return step


def _in_time(name: str) -> Map:
    import warnings

    import numpy as np
    from galpy.orbit import Orbit
    from galpy.potential import GaussianAmplitudeWrapperPotential, LogarithmicHaloPotential

    halo = LogarithmicHaloPotential(amp=2.0, q=1.0, core=0.5).toPlanar()
    potential = GaussianAmplitudeWrapperPotential(pot=halo, to=0.5, sigma=1.0)

    def step(p: float, q: float, t: float, h: float) -> tuple[float, float]:
        orbit = Orbit([q, p, 0.0, 0.0])
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # it says of each orbit that C is used
            orbit.integrate(np.array([t, t + h]), potential, method=name, dt=h, progressbar=False)
        return float(orbit.vx(t + h)), float(orbit.x(t + h))

    return step


def _script(name: str) -> str:
    return f"""\
import numpy as np
from galpy.orbit import Orbit
from galpy.potential import KGPotential

pot = KGPotential(amp=1.0, K=1.0, F=0.25, D=1.0)


def step(p, q, h):
    o = Orbit([q, p])
    o.integrate(np.array([0.0, h]), pot, method={name!r}, dt=h, progressbar=False)
    return float(o.vx(h)), float(o.x(h))
"""


def _script_in_time(name: str) -> str:
    return f"""\
import numpy as np
from galpy.orbit import Orbit
from galpy.potential import GaussianAmplitudeWrapperPotential, LogarithmicHaloPotential

halo = LogarithmicHaloPotential(amp=2.0, q=1.0, core=0.5).toPlanar()
pot = GaussianAmplitudeWrapperPotential(pot=halo, to=0.5, sigma=1.0)


def step(p, q, t, h):
    o = Orbit([q, p, 0.0, 0.0])
    o.integrate(np.array([t, t + h]), pot, method={name!r}, dt=h, progressbar=False)
    return float(o.vx(t + h)), float(o.x(t + h))
"""
