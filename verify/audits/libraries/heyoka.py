"""heyoka's Taylor integrator with a fixed order η and step size: it is the scheme lieη.

lieη is the Lie-derivative scheme of the paper: p and q become their Taylor series in h, up to h^η.
heyoka's tolerance selects its order, max(2, ⌈1 − ln(tol)/2⌉): with tol = exp(3 − 2η) this is
⌈η − 1/2⌉ = η for η ≥ 2, so that rounding of tol does not change it. `max_delta_t` limits the step.
A Taylor step of the variational equations, of the same order, gives the Jacobian of that map.
The state and the Jacobian are compared with those of lieη, which are evaluated in balls of 400 bits
at the same dyadic numbers.
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
_SOURCE_WITH_TIME = "the documentation of heyoka.py, Non-autonomous systems"
_DESCRIPTION = "taylor_adaptive with tol = exp(3 − 2η) and step(max_delta_t = h)"
# The systems are slow, since heyoka shortens a step if its tolerance needs this.
_SLOW_FORMULA = "p**2/32 - cos(q)/16"
_SLOW_FORMULA_WITH_TIME = "p**2/32 - cos(q)/16 - q*cos(t/4)/16"
_SLOW_FORMULA_TWO_DEGREES = "p1**2/32 + p2**2/32 - cos(q1)/16 - cos(q1 - q2)/16"
_SCRIPT = """\
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
_SCRIPT_WITH_TIME = """\
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
_SCRIPT_TWO_DEGREES = """\
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
_UNIT_ROUNDOFF = 2.0**-53
_BALL_BITS = 400  # the radius of a ball is then far below a unit roundoff
# Differences in unit roundoffs. Up to 2 are rounding: one of z', and a few dozen in the increment,
# each smaller by the factor h. More than 100 are no rounding.
_MEASURED_UP_TO = 2
_REFUTED_ABOVE = 100


def integrators() -> Iterator[ReleasedIntegrator]:
    for tag, more, source, formula, script in (
        ("", "", _SOURCE, _SLOW_FORMULA, _SCRIPT),
        (", driven", ", with heyoka.time in the equations", _SOURCE_WITH_TIME,
         _SLOW_FORMULA_WITH_TIME, _SCRIPT_WITH_TIME),
        (", two degrees", "", _SOURCE, _SLOW_FORMULA_TWO_DEGREES, _SCRIPT_TWO_DEGREES),
    ):  # fmt: skip
        for eta in _ORDERS:
            name, driven = f"Taylor, order {eta}{tag}", f"{_DESCRIPTION}{more}"
            yield integrator_from_script(name, driven, source, formula, script.format(eta=eta), eta)
    yield ReleasedIntegrator(
        "Taylor and lieη",
        f"{_DESCRIPTION}, with the variational equations",
        "both are the Taylor series of the flow, cut off after h^η",
        LibraryComparison(
            "One step and its Jacobian are those of lieη, to rounding", _compare_with_lie
        ),
    )


def _build_integrator(formula: str, eta: int) -> Any:
    """Build a Taylor integrator of the system's variational equations."""
    import heyoka as hy

    p, q = hy.make_vars("p", "q")
    hamiltonian = {
        _SYSTEMS["pendulum"]: lambda: p**2 / 2 - hy.cos(q),
        _SYSTEMS["not separable"]: lambda: p**2 / 2 + q**2 / 2 + p**2 * q / 4 + p * q**3 / 8,
    }[formula]()
    equations: Any = [(p, -hy.diff(hamiltonian, q)), (q, hy.diff(hamiltonian, p))]
    varied = hy.var_ode_sys(equations, hy.var_args.vars, order=1)
    integrator = hy.taylor_adaptive(varied, [0.5, 0.5], tol=math.exp(3 - 2 * eta))
    if integrator.order != eta:
        raise RuntimeError(f"heyoka took order {integrator.order}")
    return integrator


def _compare_with_lie() -> tuple[Verdict, str, tuple[tuple[str, ...], ...]]:
    """Return the verdict, the evidence, and a table with one row for each H and η."""
    rows = [("H", "η", "p′, q′", "Jacobian")]
    worst = 0.0
    for name, formula in _SYSTEMS.items():
        for eta in _ORDERS:
            state, tangent = _largest_differences(formula, eta)
            worst = max(worst, state, tangent)
            rows.append((name, str(eta), f"{state:.2f} u", f"{tangent:.2f} u"))
    verdict = _verdict(worst)
    evidence = (
        f"the largest difference from lieη, evaluated exactly, is {worst:.2f} u max(1, |x|), "
        f"u = 2⁻⁵³, over {len(_SYSTEMS)} Hamiltonians, η = 2, 3, 4 and {len(_POINTS)} points, "
        f"h = {_STEP}; {_MEASURED_UP_TO} are what rounding may make"
    )
    return verdict, evidence, tuple(rows)


def _verdict(worst: float) -> Verdict:
    """Judge the largest difference, in unit roundoffs.

    Between the limits it is UNDECIDED: another machine may round a little worse. A Taylor series
    with one term more would differ by more: after order 4 the next term is of the size h⁵/120,
    some 2,000 units.
    """
    if worst <= _MEASURED_UP_TO:
        return Verdict.MEASURED
    return Verdict.UNDECIDED if worst <= _REFUTED_ABOVE else Verdict.REFUTED


def _largest_differences(formula: str, eta: int) -> tuple[float, float]:
    """Return the largest differences of the state and of the Jacobian, in unit roundoffs, relative
    to the value if it is larger than 1."""
    from verify.schemes import get

    taylor = _build_integrator(formula, eta)
    step_map = get(f"lie{eta}").step_map(Hamiltonian.parse(formula)).flat
    largest = [0.0, 0.0]
    for p, q in _POINTS:
        for k, x in enumerate((p, q, 1, 0, 0, 1)):
            taylor.state[k] = float(x)
        taylor.step(max_delta_t=float(_STEP))
        # heyoka's variational state has the state first, then the Jacobian by rows.
        elements = (*step_map.elements, *(x for row in step_map.jacobian for x in row))
        for k, element in enumerate(elements):
            point = {"p": p, "q": q, "h": _STEP}
            ball = enclose_defined(step_map.ring, element, point, _BALL_BITS)
            midpoint, _ = midpoint_and_radius(ball)
            difference = abs(Fraction(float(taylor.state[k])) - midpoint)
            units = float(difference) / (_UNIT_ROUNDOFF * max(1.0, abs(float(midpoint))))
            is_jacobian = k >= 2
            largest[is_jacobian] = max(largest[is_jacobian], units)
    return largest[0], largest[1]
