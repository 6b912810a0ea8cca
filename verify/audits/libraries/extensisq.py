"""extensisq's solvers: the tables inside them, and their steps, of any error."""

from collections.abc import Iterator
from typing import Any

from verify.audits.methods.driver import DRIVEN, FIELD, HENON_HEILES, Driver, drive_problems
from verify.audits.methods.integrator import ReleasedIntegrator, full, table_integrator

TITLE = "extensisq"
LIBRARY = "extensisq"
_MAX_ORDER = 8
LEFT_OUT = (
    ("SWAG", "is a multistep method of variable order: no one-step map"),
    ("SSV2stab", "chooses the number of its stages by itself"),
    ("CKdisc", "chooses its order by itself; its table of order 5 is CK5's"),
    ("Ro…", "Rosenbrock methods: a Jacobian stands in their steps, which the tables do not take"),
    ("Pr9", f"is of order 9; orders above {_MAX_ORDER} are not looked at"),
    ("BS5, Ts5, Fi5N, Pr7 …, as steps", "their errors are too small in float64; their tables are"),
    ("ESDIRK methods, as steps", "solve their equations to a tolerance of their own"),
)
_STEP = Driver(
    """\
import numpy as np
from extensisq import {method}
""",
    FIELD
    + """\
solver = {method}(field, t, y, t + 2 * h, first_step=h, max_step=2 * h, rtol=1e6, atol=1e6,
                  nfev_stiff_detect=0)
solver.step()
assert abs(solver.t - t - h) < 1e-12
q, p = np.split(solver.y, 2)
""",
    "a single step of the solver, first_step = h, tolerances that accept any step",
)


def integrators() -> Iterator[ReleasedIntegrator]:
    for name, solver in _solvers():
        source = f"extensisq.{name}: order, order_secondary and its documentation"
        yield _table(name, solver, source)
    for name, order in (("CK5", 5), ("Me4", 4), ("Fi4N", 4), ("Mu5Nmb", 5)):
        claim = f"extensisq.{name}: order = {order}, fun(t, y)"
        problems = DRIVEN, HENON_HEILES
        yield from drive_problems(f"{name}, as a step", _STEP, name, claim, order, None, problems)


def _solvers() -> Iterator[tuple[str, Any]]:
    import extensisq
    from extensisq.common import ESDIRK, RungeKutta

    for name in sorted(dir(extensisq)):
        each = getattr(extensisq, name)
        if not isinstance(each, type) or not issubclass(each, RungeKutta | ESDIRK):
            continue
        order = getattr(each, "order", None)
        if isinstance(order, int) and order <= _MAX_ORDER and name == each.__name__ != "CKdisc":
            yield name, each


def _table(name: str, solver: Any, source: str) -> ReleasedIntegrator:
    stages = int(solver.n_stages)
    second = int(solver.order_secondary)
    rows = full(solver.A, stages)
    common: dict[str, Any] = {"order": int(solver.order), "c": list(map(float, solver.C[:stages]))}
    if hasattr(solver, "Bp"):
        return _nystrom(name, solver, source, rows, common)
    weights = [float(x) for x in solver.B][:stages]
    errors = [float(x) for x in solver.E]
    if len(errors) > stages and errors[stages]:  # the next step's first stage counts as well
        rows = [*([*row, 0.0] for row in rows), [*weights, 0.0]]
        common["c"] = [*common["c"], 1.0]
        weights = [*weights, 0.0]
    embedded = [x + e for x, e in zip(weights, errors, strict=False)]
    return table_integrator(
        name, "runge-kutta", "its class's A, B, C and E", source, _SCRIPT.replace("{method}", name),
        a=rows, b=weights, embedded=embedded, embedded_order=second, **common,
    )  # fmt: skip


def _nystrom(
    name: str, solver: Any, source: str, rows: list[list[float]], common: dict[str, Any]
) -> ReleasedIntegrator:
    driven = "its class's A, B, Bp and C, for q'' = f(t, q)"
    return table_integrator(
        name, "runge-kutta-nystrom", driven, source,
        a=rows, b=solver.Bp, b_bar=solver.B, row_sums=False, **common,
    )  # fmt: skip


_SCRIPT = """\
import numpy as np
from extensisq import {method} as m

n = m.n_stages
A, b, e = np.asarray(m.A, float)[:n, :n], np.asarray(m.B, float)[:n], np.asarray(m.E, float)[:n]
c = A.sum(axis=1)
# each is 0 for a method of that order; E holds the embedded weights less b
for w in (b, b + e):
    print("order 1:", w.sum() - 1)
    print("order 2:", w @ c - 1 / 2)
    print("order 3:", w @ c**2 - 1 / 3, w @ A @ c - 1 / 6)
"""
