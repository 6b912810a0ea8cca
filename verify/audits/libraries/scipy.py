"""scipy's one-step methods: single steps of solve_ivp's solvers, and the tables inside them.

A solver is given `first_step` = h and tolerances so loose that it keeps the step. Radau solves its
equations by Newton's method to a tolerance that depends on those, so that its step is driven below
the solver: by the function it calls itself, with Newton's method run to rounding.
"""

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import sympy

from verify.audits.methods import driver
from verify.audits.methods.integrator import (
    FINE,
    ExactTableau,
    FloatStep,
    Map,
    Point,
    ReleasedIntegrator,
    full,
    quotient,
)
from verify.schemes.conditions.implicit_tableau import ImplicitTableau

TITLE = "scipy"
LIBRARY = "scipy"
LEFT_OUT = (
    ("BDF, LSODA", "are multistep methods of variable order: no one-step map"),
    (
        "DOP853, as a step",
        "its error is rounding in float64 before a power of h shows; its table is verified instead",
    ),
    ("odeint, ode", "choose steps and orders by themselves: no map of a fixed h"),
)
_PENDULUM = "p**2/2 - cos(q)"
_DRIVEN = "p**2/2 - cos(q) - q*cos(t)/4"
# The coefficient of h⁶ in the error of RK45 is small: at most points h⁷ hides it, but not here.
_POINTS: tuple[Point, ...] = ((Fraction(1, 2), Fraction(-3, 2)),)
# For Radau h⁷ hides h⁶ at most points, but not here.
_POINT_OF_RADAU: tuple[Point, ...] = ((Fraction(1, 7), Fraction(6, 5)),)
_SOURCE = "the documentation of scipy.integrate.{}"
_IN_SPACE = driver.Driver(
    """\
import numpy as np
from scipy.integrate import {method}
""",
    driver.FIELD
    + """\
s = {method}(field, t, y, t + 2 * h, first_step=h, max_step=2 * h, rtol=1e6, atol=1e6)
s.step()
assert abs(s.t - t - h) < 1e-12
q, p = np.split(s.y, 2)
""",
    "a single step of the solver, first_step = h, tolerances that accept any step",
)
_ON_A_LINE = """\
import numpy as np
from scipy.integrate import {method}


def step(p, q, h):
    f = lambda t, z: np.array([-np.sin(z[1]), z[0]])
    s = {method}(f, 0.0, [p, q], h, first_step=h, max_step=h, rtol=1e6, atol=1e6)
    s.step()
    assert s.t == h
    return s.y
"""
_IN_TIME = """\
import numpy as np
from scipy.integrate import {method}


def step(p, q, t, h):
    f = lambda s, z: np.array([np.cos(s) / 4 - np.sin(z[1]), z[0]])
    s = {method}(f, t, [p, q], t + h, first_step=h, max_step=2 * h, rtol=1e6, atol=1e6)
    s.step()
    assert s.t == t + h
    return s.y
"""
_LOOSE = "a single step of scipy.integrate.{}, first_step = h, tolerances that accept any step"


def integrators() -> Iterator[ReleasedIntegrator]:
    for tag, more, formula, lines in (
        ("", "", _PENDULUM, _ON_A_LINE), (", driven", ": y' = f(t, y)", _DRIVEN, _IN_TIME),
    ):  # fmt: skip
        for name, order in (("RK23", 3), ("RK45", 5)):
            source, text = f"{_SOURCE.format(name)}{more}", lines.replace("{method}", name)
            samples = (_POINTS, FINE) if order > 4 else ()
            yield driver.integrator_from_script(
                f"{name}, as a step{tag}", _LOOSE.format(name), source, formula, text, order, None,
                *samples,
            )  # fmt: skip
    for name, order in (("RK23", 3), ("RK45", 5)):
        source_text, title = _SOURCE.format(name), f"{name}, as a step"
        yield from driver.drive_problems(
            title, _IN_SPACE, name, source_text, order, None, (driver.HENON_HEILES,)
        )
    source_text = _SOURCE.format("Radau")
    driven = "the collocation equations of scipy's Radau, by its own solver, to rounding"
    autonomous = FloatStep(_PENDULUM, lambda: _without_time(_radau(_field)))
    moving = FloatStep(_DRIVEN, lambda: _radau(_driven), _POINT_OF_RADAU)
    yield ReleasedIntegrator("Radau, as a step", driven, source_text, autonomous, 5)
    yield ReleasedIntegrator(
        "Radau, as a step, driven", driven, f"{source_text}: y' = f(t, y)", moving, 5
    )
    for name, order, pair in (("RK23", 3, 2), ("RK45", 5, 4), ("DOP853", 8, None)):
        yield from _tables(name, order, pair)
    nodes = "the collocation method of scipy's nodes, (4 ∓ √6)/10 and 1"
    yield ReleasedIntegrator(
        "Radau, its table", nodes, source_text, ExactTableau(_radau_tableau()), 5
    )


def _field(_: float, z: Any) -> Any:
    import numpy as np

    return np.array([-np.sin(z[1]), z[0]])


def _driven(t: float, z: Any) -> Any:
    import numpy as np

    return np.array([np.cos(t) / 4 - np.sin(z[1]), z[0]])


def _without_time(step: Map) -> Map:
    return lambda p, q, h: step(p, q, 0.0, h)


def _radau(field: Any) -> Map:
    import numpy as np
    from scipy.integrate._ivp.radau import MU_COMPLEX, MU_REAL, solve_collocation_system
    from scipy.linalg import lu_factor, lu_solve

    def step(p: float, q: float, t: float, h: float) -> tuple[float, float]:
        z = np.array([p, q])
        jacobian = np.array([[0.0, -np.cos(q)], [1.0, 0.0]])
        real = lu_factor(MU_REAL / h * np.eye(2) - jacobian)
        complex_ = lu_factor(MU_COMPLEX / h * np.eye(2) - jacobian)
        stages = np.zeros((3, 2))
        for _ in range(12):  # it ends after six turns at most; each call goes on from the last
            _, _, stages, _ = solve_collocation_system(
                field, t, z, h, stages, np.full(2, 1e-14), 1e-3, real, complex_, lu_solve
            )
        return float(p + stages[-1][0]), float(q + stages[-1][1])

    return step


def _tables(name: str, order: int, pair: int | None) -> Iterator[ReleasedIntegrator]:
    """Read the coefficients inside the solver: of RK23 and RK45 quotients, which round to its
    floats; of DOP853 decimals, taken as floats."""
    from scipy import integrate

    solver = getattr(integrate, name)
    stages = len(solver.B)
    rows = full(solver.A, stages)
    weights = [float(x) for x in solver.B]
    quotients = pair is not None
    driven = f"scipy.integrate.{name}'s A and B, as the quotients that round to them"
    if not quotients:
        driven = f"scipy.integrate.{name}'s A and B, floats taken by their exact binary values"
    table = _tableau(rows, weights, quotients)
    source = _SOURCE.format(name)
    yield ReleasedIntegrator(
        f"{name}, its table", driven, source, ExactTableau(table, not quotients), order
    )
    if pair is not None:
        # E holds the differences of the embedded weights from B, with one more stage for the next
        # step's first.
        estimate = [x + e for x, e in zip([*weights, 0.0], map(float, solver.E), strict=True)]
        whole = [*([*row, 0.0] for row in rows), [*weights, 0.0]]
        embedded = ExactTableau(_tableau(whole, estimate, quotients))
        yield ReleasedIntegrator(f"{name}, its error estimator", driven, source, embedded, pair)


def _tableau(rows: Any, weights: Any, quotients: bool) -> ImplicitTableau:
    convert = _quotient if quotients else _binary
    return ImplicitTableau.from_numbers(
        [[convert(x) for x in row] for row in rows], [convert(x) for x in weights]
    )


def _quotient(x: float) -> sympy.Rational:
    short = quotient(x, digits=6)
    return _binary(x) if short is None else sympy.Rational(short.numerator, short.denominator)


def _binary(x: float) -> sympy.Rational:
    return sympy.Rational(*x.as_integer_ratio())


def _radau_tableau() -> ImplicitTableau:
    root = sympy.sqrt(6)
    nodes = [(4 - root) / 10, (4 + root) / 10, sympy.S.One]
    x = sympy.Symbol("x")
    basis = []
    for i, c in enumerate(nodes):
        other_nodes = [d for j, d in enumerate(nodes) if j != i]
        basis.append(sympy.expand(sympy.prod([(x - d) / (c - d) for d in other_nodes])))
    # The weights are the last row, as the last node is 1.
    rows = [[sympy.radsimp(sympy.integrate(b, (x, 0, c))) for b in basis] for c in nodes]
    return ImplicitTableau.from_numbers(rows, rows[-1])
