"""nodepy's Runge–Kutta methods, by their coefficients: all that `loadRKM` loads.

The claimed order is that in the method's name: the first number of a pair such as Fehlberg's
RK5(4)6, the last digit of RK44 or SSPRK(10,4); for the one-stage and collocation methods it is the
p that nodepy's documentation lists. The results of nodepy's `order()` are compared with the proofs
for all methods together. It accepts conditions that hold up to its tolerance, and is not blamed for
methods whose rounding is larger.
"""

import contextlib
import io
import re
from collections.abc import Iterator, Sequence
from typing import Any

import sympy

from verify.audits.methods.driver import integrator_from_script
from verify.audits.methods.integrator import ExactTableau, LibraryComparison, ReleasedIntegrator
from verify.audits.methods.tableau_proofs import order_of
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.verdict import Verdict

TITLE = "nodepy"
LIBRARY = "nodepy"
LEFT_OUT = (
    ("multistep and two-step Runge–Kutta methods", "are no one-step maps"),
    ("splitting or partitioned methods", "nodepy has none"),
)
# The orders of methods whose names do not tell them.
_ORDERS = {
    "BE": 1, "FE": 1, "SSP22star": 2, "LobattoIIIA2": 2, "LobattoIIIA3": 4, "LobattoIIIC2": 2,
    "LobattoIIIC3": 4, "LobattoIIIC4": 6, "RadauIIA2": 3, "RadauIIA3": 5, "GL2": 4, "GL3": 6,
    "TR-BDF2": 2, "SDIRK23": 3, "SDIRK34": 4, "SDIRK54": 4, "NSSP32": 2, "NSSP33": 3,
}  # fmt: skip
_PAIR = re.compile(r"(\d)\((\d)\)")
_DRIVEN = "p**2/2 - cos(q) - q*cos(t)/4"
# It is larger than the rounding of a dozen floats, and far below the residuals of a wrong method.
_RESIDUAL_TOLERANCE = 1e-12
_STAGES_ORDER = re.compile(r"^[A-Za-z]+(\d+)(\d)$")


def integrators() -> Iterator[ReleasedIntegrator]:
    methods = _load_methods()
    for key, method in methods.items():
        order, embedded = claimed_orders(key, method.name)
        title = key if method.name in key else f"{key} ({method.name})"
        yield _by_weights(title, key, method, "b", _claim_source(key, method.name), order)
        if hasattr(method, "bhat") and embedded is not None:
            claim = f"its name, {method.name}"
            yield _by_weights(f"{key}, embedded", key, method, "bhat", claim, embedded)
    yield ReleasedIntegrator(
        "nodes",
        "c and A of each of these methods",
        "its documentation: it solves u' = f(t, u)",
        LibraryComparison(
            "The nodes c are the row sums of A, so that the order holds for f(t, u), too", _nodes
        ),
        reproduction=_NODES_SCRIPT,
    )
    yield integrator_from_script(
        "RK44 as a step, driven",
        "rk.loadRKM('RK44') called with an IVP from t to t + h and dt = h",
        "its documentation: it solves u' = f(t, u)",
        _DRIVEN,
        _STEP,
        4,
    )
    yield ReleasedIntegrator(
        "order()",
        "what it returns for each of these methods, by default",
        "its documentation: conditions are checked to within its tolerance, by default 1e-14",
        LibraryComparison(
            "order() returns the order of each method that loadRKM loads", _check_order_method
        ),
        reproduction=_ORDER_SCRIPT,
    )


def _by_weights(
    title: str, key: str, method: Any, weights: str, source: str, order: int | None
) -> ReleasedIntegrator:
    """Build the integrator of the method with those of its weights."""
    driven = f"the exact coefficients A and {weights} of rk.loadRKM('{key}')"
    table, script = tableau_of(method.A, getattr(method, weights)), _script(key, weights)
    return ReleasedIntegrator(title, driven, source, table, order, reproduction=script)


def claimed_orders(key: str, name: str) -> tuple[int | None, int | None]:
    """Return the order of the method that its names claim, and that of the embedded one."""
    pair = _PAIR.search(name)
    if pair:
        return int(pair[1]), int(pair[2])
    if key in _ORDERS:
        return _ORDERS[key], None
    stages = _STAGES_ORDER.match(key)
    return (int(stages[2]), None) if stages else (None, None)


def _claim_source(key: str, name: str) -> str:
    if _PAIR.search(name):
        return f"its name, {name}: the order of b, then that of bhat"
    if key in _ORDERS:
        return f"its name, {name}"
    return (
        f"its key, {key}, read as stages and order, as the documentation does where it says more: "
        "BuRK65, 6-stage, 5th-order"
    )


def _load_methods() -> dict[str, Any]:
    from nodepy import rk

    with contextlib.redirect_stdout(io.StringIO()):
        methods: dict[str, Any] = rk.loadRKM()
    # loadRKM names some methods twice: each is judged once, by its first name.
    unique: dict[int, str] = {}
    for key, method in methods.items():
        unique.setdefault(id(method), key)
    return {key: methods[key] for key in unique.values()}


def tableau_of(a: Any, b: Any) -> ExactTableau:
    """Read nodepy's arrays, which hold sympy's numbers or floats."""
    count = len(b)
    rows = [[_number(a[i, j]) for j in range(count)] for i in range(count)]
    weights = [_number(x) for x in b]
    rounded = any(was for row in (*rows, weights) for _, was in row)
    tableau = ImplicitTableau.from_numbers(
        [[x for x, _ in row] for row in rows], [x for x, _ in weights]
    )
    return ExactTableau(tableau, rounded)


def _number(x: Any) -> tuple[sympy.Expr, bool]:
    """Return the exact number, and whether it was a float that is no short binary fraction."""
    if isinstance(x, sympy.Basic) and not x.has(sympy.Float):
        return sympy.radsimp(x) if not x.is_Rational else x, False
    numerator, denominator = float(x).as_integer_ratio()
    return sympy.Rational(numerator, denominator), denominator > 2**10


def _nodes() -> tuple[Verdict, str, tuple[tuple[str, ...], ...]]:
    """Check that each stage reads f at the time that its place is for; the rest of f(t, u) is then
    that of an autonomous system with one more unknown."""
    wrong, rounded = [], 0
    methods = _load_methods()
    for key, method in methods.items():
        count = len(method.b)
        gaps = [_number(method.c[i])[0] - sum(_number(method.A[i, j])[0] for j in range(count))
               for i in range(count)]  # fmt: skip
        agreements = [sympy.radsimp(sympy.expand(x)) == 0 for x in gaps]
        if not all(agreements):
            close = all(abs(float(x)) <= _RESIDUAL_TOLERANCE for x in gaps)
            rounded += close
            wrong += [] if close else [key]
    if wrong:
        return Verdict.REFUTED, f"not of {', '.join(wrong)}", ()
    if rounded:
        prefix = f"exactly for {len(methods) - rounded} of {len(methods)} methods, of the others, "
        return (
            Verdict.MEASURED,
            f"{prefix}whose coefficients are floats, but for their rounding",
            (),
        )
    return Verdict.PROVED, f"exactly, for all {len(methods)} methods", ()


def _check_order_method() -> tuple[Verdict, str, tuple[tuple[str, ...], ...]]:
    rows = [("method", "order() returns", "proved or measured")]
    wrong, coarse = [], []
    methods = _load_methods()
    for key, method in methods.items():
        returned = _order_by_nodepy(method)
        table = tableau_of(method.A, method.b)
        order = order_of(table.tableau, returned + 1, table.rounded).order
        rows.append((key, str(returned), str(order)))
        if returned == order:
            continue
        sentence = f"{key}: {returned}, and it is {order}"
        # The default tolerance is below the rounding of these floats: that is no mistake of the
        # method's order.
        if table.rounded and _order_by_nodepy(method, tol=_RESIDUAL_TOLERANCE) == order:
            coarse.append(f"{sentence}, which order(tol={_RESIDUAL_TOLERANCE}) returns")
        else:
            wrong.append(sentence)
    return _order_method(len(methods), wrong, coarse, tuple(rows))


def _order_method(
    count: int, wrong: Sequence[str], coarse: Sequence[str], rows: tuple[tuple[str, ...], ...]
) -> tuple[Verdict, str, tuple[tuple[str, ...], ...]]:
    """Judge order(). `coarse`: where its floats' rounding exceeds the default tolerance, and a
    larger one does."""
    if wrong:
        return Verdict.REFUTED, f"of {count} methods, {'; '.join(wrong)}", rows
    if coarse:
        evidence = (
            f"it is right for {count - len(coarse)} of {count} methods by default; for floats "
        )
        evidence += f"whose rounding exceeds that tolerance it is not: {'; '.join(coarse)}"
        return Verdict.MEASURED, evidence, rows
    return Verdict.PROVED, f"it is right for all {count} methods", rows


def _order_by_nodepy(method: Any, **options: float) -> int:
    with contextlib.redirect_stdout(io.StringIO()):
        return int(method.order(**options))


def _script(key: str, weights: str) -> str:
    return f"""\
from nodepy import rk

m = rk.loadRKM({key!r})
A, b = m.A, m.{weights}
c = A.sum(axis=1)
# each is 0 for a method of that order
print("order 1:", sum(b) - 1)
print("order 2:", b.dot(c) - 1 / 2)
print("order 3:", b.dot(c**2) - 1 / 3, b.dot(A.dot(c)) - 1 / 6)
"""


_NODES_SCRIPT = """\
from nodepy import rk

for key, m in rk.loadRKM().items():
    print(key, max(abs(float(x)) for x in m.A.sum(axis=1) - m.c))
"""
_STEP = """\
import numpy as np
from nodepy import ivp, rk

m = rk.loadRKM("RK44")


def step(p, q, t, h):
    f = lambda s, u: np.array([np.cos(s) / 4 - np.sin(u[1]), u[0]])
    times, states = m(ivp.IVP(f=f, u0=np.array([p, q]), T=t + h), t0=t, dt=h)
    assert len(times) == 2 and times[-1] == t + h
    return states[-1]
"""
_ORDER_SCRIPT = """\
from nodepy import rk

m = rk.loadRKM("Tsit5")
print(m.name, m.order(), m.order(tol=1e-12))
"""
