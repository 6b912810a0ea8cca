"""gala's integrators of orbits in Python, which take any F(t, w), and those in C."""

from collections.abc import Iterator

from verify.integrators.others.integrator import ReleasedIntegrator
from verify.integrators.others.scripted import Driven, scripted

TITLE = "gala"
LIBRARY = "gala"
LEFT_OUT = (
    ("DOPRI853Integrator", "chooses its steps by itself: no map of a fixed h"),
    ("the same in C", "take gala's potentials alone, and are by the same formulas"),
)
_IN_PYTHON = Driven(
    """\
import numpy as np
from gala.integrate import {method}
""",
    """\
def field(t, w):
    q, p = np.split(w, 2)
    return np.concatenate([p, force(t, q)])
w0 = np.hstack([q, p])[:, None]
orbit = {method}(field)(w0, t1=t, dt=h, n_steps=1)
q, p = np.split(orbit.w()[:, -1], 2)
""",
    "one step from t, dt = h",
)


def integrators() -> Iterator[ReleasedIntegrator]:
    for method, order, symplectic, said in (
        ("LeapfrogIntegrator", 2, True, "“second-order”, “Symplectic”"),
        ("Ruth4Integrator", 4, True, "“Fourth-order accuracy”, “Symplectic”; func(t, w)"),
        ("RK5Integrator", 5, None, "“Fifth-order accuracy for smooth problems”; func(t, w)"),
    ):
        source = f"the documentation of gala.integrate.{method}: {said}"
        yield from scripted(method, _IN_PYTHON, method, source, order, symplectic)
