"""heyoka's Taylor integrator held at one order η and one step: it is the scheme lieη.

The tolerance selects the order, max(2, ⌈1 − ln(tol)/2⌉); `max_delta_t` limits the step. A Taylor
step of order η of the variational equations is the exact Jacobian of that map. Both are held
against lieη, evaluated exactly at the same dyadic numbers.
"""

import math
from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from verify.algebra.enclosure import enclose_defined
from verify.arithmetic.arb import midpoint_and_radius
from verify.audits.methods.driver import integrator_from_script
from verify.audits.methods.integrator import LibraryComparison, ReleasedIntegrator
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.verdict import Verdict

TITLE = "heyoka"
LIBRARY = "heyoka"
LEFT_OUT = (("taylor_adaptive with its own steps", "chooses them by itself: no map of a fixed h"),)
_SOURCE = "the documentation of heyoka.taylor_adaptive"
_DRIVEN = "taylor_adaptive with tol = exp(3 − 2η) and step(max_delta_t = h)"
# Slow, since heyoka takes a shorter step than it is given where its tolerance asks for one.
_SLOW = "p**2/32 - cos(q)/16"
_SLOWLY_DRIVEN = "p**2/32 - cos(q)/16 - q*cos(t/4)/16"
_SLOW_IN_SPACE = "p1**2/32 + p2**2/32 - cos(q1)/16 - cos(q1 - q2)/16"
_ON_A_LINE = """\
import math
import heyoka as hy

p, q = hy.make_vars("p", "q")
t = hy.taylor_adaptive([(p, -hy.sin(q) / 16), (q, p / 16)], [0.0, 0.0], tol=math.exp(3 - 2 * {eta}))
assert t.order == {eta}


def step(p, q, h):
    t.time, t.state[:] = 0.0, (p, q)
    _, taken = t.step(max_delta_t=h)
    assert taken == h
    return tuple(t.state)
"""
_IN_TIME = """\
import math
import heyoka as hy

p, q = hy.make_vars("p", "q")
drive = hy.cos(hy.time / 4)
equations = [(p, (drive - hy.sin(q)) / 16), (q, p / 16)]
y = hy.taylor_adaptive(equations, [0.0, 0.0], tol=math.exp(3 - 2 * {eta}))
assert y.order == {eta}


def step(p, q, t, h):
    y.time, y.state[:] = t, (p, q)
    _, taken = y.step(max_delta_t=h)
    assert taken == h
    return tuple(y.state)
"""
_IN_SPACE = """\
import math

import heyoka as hy
import numpy as np

p1, p2, q1, q2 = hy.make_vars("p1", "p2", "q1", "q2")
pull = hy.sin(q1 - q2) / 16
equations = [(p1, -hy.sin(q1) / 16 - pull), (p2, pull), (q1, p1 / 16), (q2, p2 / 16)]
y = hy.taylor_adaptive(equations, [0.0] * 4, tol=math.exp(3 - 2 * {eta}))
assert y.order == {eta}


def step(p, q, h):
    y.time, y.state[:] = 0.0, (*p, *q)
    _, taken = y.step(max_delta_t=h)
    assert taken == h
    return np.array(y.state[:2]), np.array(y.state[2:])
"""
_SYSTEMS = {"pendulum": "p**2/2 - cos(q)", "not separable": "p**2/2 + q**2/2 + p**2*q/4 + p*q**3/8"}
_POINTS = [(Fraction(p, 8), Fraction(q, 8)) for p, q in ((4, 10), (-6, 3), (2, -12))]
_STEP = Fraction(1, 128)
_ORDERS = (2, 3, 4)
_UNIT = 2.0**-53
_SURE = 100  # units: more is no rounding
_ALLOWED = 2  # units: one rounding of z', and a few dozen in the increment, each smaller by h


def integrators() -> Iterator[ReleasedIntegrator]:
    for tag, more, source, formula, text in (
        ("", "", _SOURCE, _SLOW, _ON_A_LINE),
        (", driven", ", with heyoka.time in the equations",
         "the documentation of heyoka.py, Non-autonomous systems", _SLOWLY_DRIVEN, _IN_TIME),
        (", two degrees", "", _SOURCE, _SLOW_IN_SPACE, _IN_SPACE),
    ):  # fmt: skip
        for eta in _ORDERS:
            name, driven = f"Taylor, order {eta}{tag}", f"{_DRIVEN}{more}"
            yield integrator_from_script(name, driven, source, formula, text.format(eta=eta), eta)
    yield ReleasedIntegrator(
        "Taylor and lieη",
        f"{_DRIVEN}, with the variational equations",
        "both are the Taylor series of the flow, cut off after h^η",
        LibraryComparison("One step and its Jacobian are those of lieη, to rounding", _agreement),
    )


def _integrator(formula: str, eta: int) -> Any:
    """Build a Taylor integrator of the system's variational equations."""
    import heyoka as hy

    p, q = hy.make_vars("p", "q")
    h = {
        _SYSTEMS["pendulum"]: lambda: p**2 / 2 - hy.cos(q),
        _SYSTEMS["not separable"]: lambda: p**2 / 2 + q**2 / 2 + p**2 * q / 4 + p * q**3 / 8,
    }[formula]()
    equations: Any = [(p, -hy.diff(h, q)), (q, hy.diff(h, p))]
    varied = hy.var_ode_sys(equations, hy.var_args.vars, order=1)
    integrator = hy.taylor_adaptive(varied, [0.5, 0.5], tol=math.exp(3 - 2 * eta))
    if integrator.order != eta:
        raise RuntimeError(f"heyoka took order {integrator.order}")
    return integrator


def _agreement() -> tuple[Verdict, str, tuple[tuple[str, ...], ...]]:
    rows = [("H", "η", "p′, q′", "Jacobian")]
    worst = 0.0
    for name, formula in _SYSTEMS.items():
        for eta in _ORDERS:
            state, tangent = _distance(formula, eta)
            worst = max(worst, state, tangent)
            rows.append((name, str(eta), f"{state:.2f} u", f"{tangent:.2f} u"))
    verdict = _verdict(worst)
    evidence = (
        f"the largest difference from lieη, evaluated exactly, is {worst:.2f} u max(1, |x|), "
        f"u = 2⁻⁵³, over {len(_SYSTEMS)} Hamiltonians, η = 2, 3, 4 and {len(_POINTS)} points, "
        f"h = {_STEP}; {_ALLOWED} are what rounding may make"
    )
    return verdict, evidence, tuple(rows)


def _verdict(worst: float) -> Verdict:
    """Judge a distance in units of rounding; other machines may round a little worse, which is no
    other method: one term more than order 4 has is h⁵/120, some 2,000 units."""
    if worst <= _ALLOWED:
        return Verdict.MEASURED
    return Verdict.UNDECIDED if worst <= _SURE else Verdict.REFUTED


def _distance(formula: str, eta: int) -> tuple[float, float]:
    """Return the largest differences of the state and of the Jacobian, in units of rounding."""
    from verify.schemes import get

    taylor = _integrator(formula, eta)
    step_map = get(f"lie{eta}").step_map(Hamiltonian.parse(formula)).flat
    largest = [0.0, 0.0]
    for p, q in _POINTS:
        for k, x in enumerate((p, q, 1, 0, 0, 1)):
            taylor.state[k] = float(x)
        taylor.step(max_delta_t=float(_STEP))
        # The state first, then the Jacobian by rows, as heyoka's variational state has them.
        elements = (*step_map.elements, *(x for row in step_map.jacobian for x in row))
        for k, element in enumerate(elements):
            ball = enclose_defined(step_map.ring, element, {"p": p, "q": q, "h": _STEP}, 400)
            middle, _ = midpoint_and_radius(ball)
            gap = abs(Fraction(float(taylor.state[k])) - middle)
            units = float(gap) / (_UNIT * max(1.0, abs(float(middle))))
            largest[k >= 2] = max(largest[k >= 2], units)
    return largest[0], largest[1]
