"""gala's integrators of orbits in Python, which take any F(t, w), and those in C."""

from collections.abc import Iterator

from verify.audits.methods.driver import Driver, drive_problems
from verify.audits.methods.integrator import LibraryComparison, ReleasedIntegrator, text
from verify.verdict import Verdict

TITLE = "gala"
LIBRARY = "gala"
LEFT_OUT = (
    ("DOPRI853Integrator", "chooses its steps by itself: no map of a fixed h"),
    ("the same in C", "take gala's potentials alone, and are by the same formulas"),
)
_IN_PYTHON = Driver(
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
    for method, order, symplectic, claim in (
        ("LeapfrogIntegrator", 2, True, "“second-order”, “Symplectic”"),
        ("Ruth4Integrator", 4, True, "“Fourth-order accuracy”, “Symplectic”; func(t, w)"),
        ("RK5Integrator", 5, None, "“Fifth-order accuracy for smooth problems”; func(t, w)"),
    ):
        source = f"the documentation of gala.integrate.{method}: {claim}"
        yield from drive_problems(method, _IN_PYTHON, method, source, order, symplectic)
    yield ReleasedIntegrator(
        "RK5Integrator's coefficients",
        "A and C of gala.integrate.pyintegrators.rk5",
        "its documentation: “using the Dormand-Prince coefficients”",
        LibraryComparison("its nodes are those of Dormand and Prince", _nodes, "documentation"),
        reproduction=_NODES,
    )


def _nodes() -> tuple[Verdict, str, tuple[tuple[str, ...], ...]]:
    """Compare its nodes with those of Dormand and Prince, and of Cash and Karp."""
    from gala.integrate.pyintegrators import rk5

    nodes_of_gala = [text(float(x)) for x in rk5.A]
    rows: tuple[tuple[str, ...], ...] = (
        ("of", *(f"c{k + 1}" for k in range(len(nodes_of_gala)))),
        ("gala", *nodes_of_gala),
    )
    published = {"Dormand and Prince": _DORMAND_PRINCE, "Cash and Karp": _CASH_KARP}
    rows += tuple((name, *nodes) for name, nodes in published.items())
    if nodes_of_gala == [*_DORMAND_PRINCE]:
        return Verdict.PROVED, "they are", rows
    alike = " and are those of Cash and Karp" if nodes_of_gala == [*_CASH_KARP] else ""
    return Verdict.REFUTED, f"they are {', '.join(nodes_of_gala)}{alike}", rows


_DORMAND_PRINCE = ("0", "1/5", "3/10", "4/5", "8/9", "1")
_CASH_KARP = ("0", "1/5", "3/10", "3/5", "1", "7/8")
_NODES = """\
from gala.integrate.pyintegrators import rk5

print("gala              ", [float(x) for x in rk5.A])
print("Dormand and Prince", [0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1])
print("Cash and Karp     ", [0, 1 / 5, 3 / 10, 3 / 5, 1, 7 / 8])
"""
