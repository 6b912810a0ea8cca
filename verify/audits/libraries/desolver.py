"""desolver's methods: Runge–Kutta tables by their coefficients, symplectic ones as steps."""

import re
from collections.abc import Iterator
from typing import Any

from verify.audits.methods.driver import FIELD, HENON_HEILES, TWO_WAVES, Driver, drive_problems
from verify.audits.methods.integrator import ReleasedIntegrator, table_integrator

TITLE = "desolver"
LIBRARY = "desolver"
_MAX_ORDER = 8
LEFT_OUT = (
    ("RK1412Solver, RK108Solver", f"are of orders that are not looked at, above {_MAX_ORDER}"),
    ("RadauIIA19", "is of order 19, and its numbers are floats"),
    ("generate_richardson_integrator", "makes methods of variable order"),
)
_SOURCE = "desolver.integrators.{}.__order__: “{}”"
_STEP = Driver(
    """\
import numpy as np
from desolver.integrators import {method}
""",
    FIELD
    + """\
method = {method}(y.shape, y.dtype)
_, (_, change) = method(field, np.float64(t), y, {}, np.float64(h))
q, p = np.split(y + change, 2)
""",
    "one call of the method with y = (q, p) and the step h",
)
_PAIR = re.compile(r"(\d+)\s*\((\d+)\)")


def integrators() -> Iterator[ReleasedIntegrator]:
    for method in _methods():
        name, order = method.__name__, int(method.__order__)
        source = _SOURCE.format(name, order)
        if not hasattr(method, "tableau_final"):
            yield _splitting(method, name, order, source)
            plain = TWO_WAVES, HENON_HEILES
            yield from drive_problems(f"{name}, as a step", _STEP, name, source, order, True, plain)
        elif order <= _MAX_ORDER:
            yield _tableau(method, name, order, source)


def _methods() -> Iterator[Any]:
    import desolver.integrators as library
    from desolver.integrators.integrator_types import TableauIntegrator

    for name in dir(library):
        member: Any = getattr(library, name)
        if isinstance(member, type) and issubclass(member, TableauIntegrator):
            yield from [member] if getattr(member, "__order__", None) else []


def _splitting(method: Any, name: str, order: int, source: str) -> ReleasedIntegrator:
    """Read each row as a kick by its last number; if that is 0, as a drift by the one before."""
    rows = [(float(drift), float(kick)) for _, drift, kick in method.tableau_intermediate]
    parts = [("kick", kick) if kick else ("drift", drift) for drift, kick in rows]
    driven = "its class's tableau_intermediate: columns 1 and 2, of drifts and kicks"
    return table_integrator(
        name, "splitting", driven, source,
        order=order, first=parts[0][0], sizes=[size for _, size in parts], symplectic=True,
    )  # fmt: skip


def _tableau(method: Any, name: str, order: int, source: str) -> ReleasedIntegrator:
    table, weights = method.tableau_intermediate, method.tableau_final
    pair = _PAIR.search(method.__doc__ or "")
    embedded = int(pair[2]) if pair and int(pair[1]) == order and len(weights) > 1 else None
    return table_integrator(
        name,
        "runge-kutta",
        "its class's tableau_intermediate and tableau_final, of which the first row is the method",
        source,
        _SCRIPT.replace("{method}", name),
        order=order,
        embedded_order=embedded,
        a=table[:, 1:],
        c=table[:, 0],
        b=weights[0, 1:],
        embedded=weights[1, 1:] if embedded else None,
        symplectic=bool(method.symplectic),
    )


_SCRIPT = """\
import numpy as np
from desolver.integrators import {method} as m

A, b = m.tableau_intermediate[:, 1:], m.tableau_final[0, 1:]
c = A.sum(axis=1)
# each is 0 for a method of that order
print("order 1:", b.sum() - 1)
print("order 2:", b @ c - 1 / 2)
print("order 3:", b @ c**2 - 1 / 3, b @ A @ c - 1 / 6)
print("order 4:", b @ c**3 - 1 / 4, b @ (c * (A @ c)) - 1 / 8, b @ A @ c**2 - 1 / 12,
      b @ A @ A @ c - 1 / 24)
"""
