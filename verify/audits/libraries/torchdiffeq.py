"""torchdiffeq's solvers: the tables of those that adapt, and single steps of the others."""

from collections.abc import Iterator
from typing import Any

from verify.audits.methods.driver import DRIVEN, HENON_HEILES, Driver, drive_problems
from verify.audits.methods.integrator import ReleasedIntegrator, table_integrator

TITLE = "torchdiffeq"
LIBRARY = "torchdiffeq"
EXTRA = "heavy-peers"
LEFT_OUT = (
    ("explicit_adams, implicit_adams", "are multistep methods: no one-step maps"),
    ("scipy_solver", "is scipy's"),
)
_STEP = Driver(
    """\
import numpy as np
import torch
from torchdiffeq import odeint
""",
    """\
def field(t, y):
    q, p = np.split(y.numpy(), 2)
    return torch.from_numpy(np.concatenate([p, force(float(t), q)]))
y = torch.from_numpy(np.hstack([q, p]))
times = torch.tensor([t, t + h], dtype=torch.float64)
q, p = np.split(odeint(field, y, times, method="{method}")[-1].numpy(), 2)
""",
    "odeint over [t, t + h], which is one step",
)
_ADAPTIVE = {"dopri8": 8, "dopri5": 5, "bosh3": 3, "fehlberg2": 2, "adaptive_heun": 2}
_FIXED = ("euler", "midpoint", "heun2", "heun3", "rk4")


def integrators() -> Iterator[ReleasedIntegrator]:
    from torchdiffeq._impl.odeint import SOLVERS

    for name, order in _ADAPTIVE.items():
        yield _table(name, SOLVERS[name], order)
    for name in _FIXED:
        order = int(SOLVERS[name].order)
        source = f"torchdiffeq, method='{name}', order = {order}"
        yield from drive_problems(name, _STEP, name, source, order, None, (DRIVEN, HENON_HEILES))


def _table(name: str, solver: Any, order: int) -> ReleasedIntegrator:
    """Build the table; c_error is the weights less those of the embedded method, of which no order
    is stated."""
    table = solver.tableau
    rows = [[], *([float(x) for x in row] for row in table.beta)]
    return table_integrator(
        name,
        "runge-kutta",
        "the solver's alpha, beta and c_sol",
        f"torchdiffeq, method='{name}': its name and order = {int(solver.order)}",
        order=order,
        a=rows,
        b=[float(x) for x in table.c_sol],
        c=[0.0, *(float(x) for x in table.alpha)],
    )
