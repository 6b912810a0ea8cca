"""diffrax's Runge–Kutta solvers by their tableaux, and its symplectic one as a step."""

import re
from collections.abc import Iterator
from typing import Any

from verify.audits.methods.driver import PROBLEMS, Driver, drive_problems
from verify.audits.methods.integrator import ReleasedIntegrator, full, table_integrator

TITLE = "diffrax"
LIBRARY = "diffrax"
EXTRA = "heavy-peers"
LEFT_OUT = (
    ("ReversibleHeun, LeapfrogMidpoint", "keep a second state from step to step"),
    ("Euler, ImplicitEuler", "have no tableau that can be read"),
    (
        "KenCarp3 … KenCarp5, Sil3",
        "their pairs of tableaux are SUNDIALS's ARK tables, or like them",
    ),
    ("solvers of stochastic equations", "have no deterministic step"),
)
_STEP = Driver(
    """\
import jax
import jax.numpy as jnp
import numpy as np
from diffrax import ODETerm, {method}

jax.config.update("jax_enable_x64", True)
""",
    """\
drift = ODETerm(lambda t, p, args: p)
kick = ODETerm(lambda t, q, args: jnp.asarray(force(np.float64(t), np.asarray(q))))
y = jnp.atleast_1d(jnp.asarray(q)), jnp.atleast_1d(jnp.asarray(p))
(q, p), *_ = {method}().step((drift, kick), t, t + h, y, None, None, False)
""",
    "one call of the solver's step from t to t + h",
)
_NAMES = ("Midpoint", "Heun", "Ralston", "Bosh3", "Tsit5", "Dopri5", "Dopri8",
          "Kvaerno3", "Kvaerno4", "Kvaerno5")  # fmt: skip
_EMBEDDED = re.compile(r"embedded (\d)(?:st|nd|rd|th)[ -]order", re.IGNORECASE)


def integrators() -> Iterator[ReleasedIntegrator]:
    import diffrax

    for name in _NAMES:
        yield _table(name, getattr(diffrax, name))
    claim = "its documentation, “Symplectic method”, and order(terms) = 1"
    yield from drive_problems(
        "SemiImplicitEuler", _STEP, "SemiImplicitEuler", claim, 1, True, PROBLEMS
    )


def _table(name: str, solver: Any) -> ReleasedIntegrator:
    table, order = solver.tableau, int(solver().order(None))
    diagonal = [0.0] * (len(table.c) + 1) if table.a_diagonal is None else table.a_diagonal
    lower = [[], *table.a_lower]
    rows = [[*map(float, row), float(x)] for row, x in zip(lower, diagonal, strict=True)]
    embedded_match = _EMBEDDED.search(solver.__doc__ or "")
    weights = [float(x) for x in table.b_sol]
    # b_error holds the differences of the weights from the embedded ones.
    embedded = [b - float(e) for b, e in zip(weights, table.b_error, strict=True)]
    stages = len(weights)
    return table_integrator(
        name,
        "runge-kutta",
        "the solver's tableau: a_lower, a_diagonal, b_sol and b_sol − b_error",
        f"diffrax.{name}: order(terms) = {order}"
        + (f", “{embedded_match[0]}”" if embedded_match else ""),
        order=order,
        embedded_order=int(embedded_match[1]) if embedded_match else None,
        a=full(rows, stages),
        b=weights,
        c=[float(table.c1), *map(float, table.c)],
        embedded=embedded if embedded_match else None,
    )
