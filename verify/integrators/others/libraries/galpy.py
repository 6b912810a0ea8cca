"""galpy's integrators of orbits in one dimension, with `dt` held at the length of the one step.

The potential is galpy's KGPotential, amp (K √(x² + D²) + F x²), of which galpy subtracts nothing.
Units are galpy's natural ones, so that H = v²/2 + amp (K √(x² + D²) + F x²).

A potential in one dimension takes no amplitude that depends on time in galpy's C code; one in the
plane does, and an orbit on its axis is of one degree of freedom, as long as it does not pass the
centre: H = v²/2 + A(t) log(x² + 1/4)/2.
"""

from collections.abc import Iterator
from fractions import Fraction
from functools import partial

from verify.integrators.others.integrator import FINE, FloatStep, Map, Point, ReleasedIntegrator

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
    (
        "an amplitude that depends on time, in one dimension",
        "is not taken by its C code; it is tried in the plane, along an axis",
    ),
)
_ORDERS = {"leapfrog_c": 2, "symplec4_c": 4, "symplec6_c": 6, "rk4_c": 4, "rk6_c": 6}
_HAMILTONIAN = "p**2/2 + sqrt(q**2 + 1) + q**2/4"
_POINTS: tuple[Point, ...] = ((Fraction(1, 3), Fraction(3, 5)),)
_DRIVEN = "p**2/2 + (2 + cos(6*t/5))*log(q**2 + 1/4)/2"
_AHEAD: tuple[Point, ...] = ((Fraction(1, 3), Fraction(3, 2)),)  # one, as each call takes long
_STEPS = {  # of _DRIVEN, by the order
    2: [Fraction(x, 2**k) for k in (5, 6, 7, 8) for x in (3, 2)],
    4: [Fraction(x, 2**k) for k in (3, 4, 5, 6) for x in (3, 2)],
    6: [Fraction(x, 64) for x in (16, 14, 12, 10, 8, 7, 6, 5)],
}
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
        yield ReleasedIntegrator(
            f"{name}, driven",
            "Orbit([q, p, 0, 0]).integrate([t, t + h], …, dt=h), one step in the plane, along its "
            "axis, with the amplitude 2 + cos(6 t/5)",
            f"{_SOURCE}, and of TimeDependentAmplitudeWrapperPotential",
            FloatStep(_DRIVEN, partial(_in_time, name), _AHEAD, tuple(_STEPS[order])),
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
    from galpy.potential import LogarithmicHaloPotential, TimeDependentAmplitudeWrapperPotential

    halo = LogarithmicHaloPotential(amp=1.0, q=1.0, core=0.5).toPlanar()
    potential = TimeDependentAmplitudeWrapperPotential(
        A=lambda t: 2.0 + float(np.cos(1.2 * t)), pot=halo
    )

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
from galpy.potential import LogarithmicHaloPotential, TimeDependentAmplitudeWrapperPotential

halo = LogarithmicHaloPotential(amp=1.0, q=1.0, core=0.5).toPlanar()
pot = TimeDependentAmplitudeWrapperPotential(A=lambda t: 2.0 + float(np.cos(1.2 * t)), pot=halo)


def step(p, q, t, h):
    o = Orbit([q, p, 0.0, 0.0])
    o.integrate(np.array([t, t + h]), pot, method={name!r}, dt=h, progressbar=False)
    return float(o.vx(t + h)), float(o.x(t + h))
"""
