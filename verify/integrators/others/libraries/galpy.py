"""galpy's integrators of orbits in one dimension, with `dt` held at the length of the one step.

The potential is galpy's KGPotential, amp (K √(x² + D²) + F x²), of which galpy subtracts nothing.
Units are galpy's natural ones, so that H = v²/2 + amp (K √(x² + D²) + F x²).
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
)
_ORDERS = {"leapfrog_c": 2, "symplec4_c": 4, "symplec6_c": 6, "rk4_c": 4, "rk6_c": 6}
_HAMILTONIAN = "p**2/2 + sqrt(q**2 + 1) + q**2/4"
_POINTS: tuple[Point, ...] = ((Fraction(1, 3), Fraction(3, 5)),)
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
