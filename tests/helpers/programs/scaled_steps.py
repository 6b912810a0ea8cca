"""Steps and maps of users in units, shapes and states of their own: right ones, and wrong ones."""

import math
from collections import namedtuple
from collections.abc import Callable
from typing import Any

import numpy as np

Step = Callable[..., Any]
FAR = 1e300  # a comparison with it keeps symbols out, and nothing comes so far

# -- units ----------------------------------------------------------------------------------------

GM = 398600.4418  # of the Earth, in kilometres and seconds
EARTH = "(p1**2 + p2**2)/2 - 398600.4418/sqrt(q1**2 + q2**2)"


def pull(q: Any, gm: float = GM) -> Any:
    r = (q[0] ** 2 + q[1] ** 2) ** 1.5
    return [-gm * q[0] / r, -gm * q[1] / r]


def euler_of_earth(p: Any, q: Any, h: Any) -> Any:
    if q[0] > FAR:
        return p, q
    f = pull(q)
    return [x + h * y for x, y in zip(p, f, strict=True)], [
        x + h * y for x, y in zip(q, p, strict=True)
    ]


def verlet_of_earth(p: Any, q: Any, h: Any) -> Any:
    if q[0] > FAR:
        return p, q
    p = [x + h / 2 * y for x, y in zip(p, pull(q), strict=True)]
    q = [x + h * y for x, y in zip(q, p, strict=True)]
    return [x + h / 2 * y for x, y in zip(p, pull(q), strict=True)], q


def verlet_in_units(unit: float, mistake: float) -> Step:
    """Verlet of Kepler's problem in that unit of length, with a force `mistake` · q1 too much."""

    def step(p: Any, q: Any, h: Any) -> Any:
        if q[0] > FAR:
            return p, q
        p = [x + h / 2 * y for x, y in zip(p, pull(q, unit**3), strict=True)]
        q = [x + h * y for x, y in zip(q, p, strict=True)]
        p = [x + h / 2 * y for x, y in zip(p, pull(q, unit**3), strict=True)]
        return [p[0] + mistake * h * q[0], p[1]], q

    return step


EULER_OF_EARTH = """
#include <math.h>
void step(int n, double t, double h, double *p, double *q)
{
    double r = pow(q[0]*q[0] + q[1]*q[1], 1.5), a = -398600.4418*q[0]/r, b = -398600.4418*q[1]/r;
    q[0] += h*p[0]; q[1] += h*p[1];
    p[0] += h*a; p[1] += h*b;
}
"""


def molecule(sigma: float, cutoff: float, power: int = 6) -> Step:
    """Velocity Verlet in Lennard-Jones's potential with ε = 1, cut off; `power` is 6."""

    def force(r: Any) -> Any:
        if r > cutoff:
            return 0.0
        s = (sigma / r) ** power
        return 4 * power * (2 * s * s - s) / r

    def step(p: Any, q: Any, h: Any) -> Any:
        p = p + h / 2 * force(q)
        q = q + h * p
        return p + h / 2 * force(q), q

    return step


def stiff(rate: int) -> Step:
    def step(p: Any, q: Any, h: Any) -> Any:
        if q > FAR:
            return p, q
        p = p - h / 2 * rate * q
        q = q + h * p
        return p - h / 2 * rate * q, q

    return step


# -- tolerances -----------------------------------------------------------------------------------


def midpoint(force: Step, tolerance: float) -> Step:
    """The implicit midpoint rule by a loop that ends at the tolerance."""

    def step(p: Any, q: Any, h: Any) -> Any:
        u, v = p, q
        for _ in range(300):
            a, b = p + h * force((q + v) / 2), q + h * (p + u) / 2
            near = abs(a - u) + abs(b - v) < tolerance
            u, v = a, b
            if near:
                break
        return u, v

    return step


def losing(share: float) -> Step:
    """A turn that loses that share of area, behind a comparison."""

    def turn(p: Any, q: Any) -> Any:
        if q > 1000:
            return p, q
        p = p - 0.1 * math.sin(q)
        return p * (1 - share), q + 0.1 * p

    return turn


# -- shapes ---------------------------------------------------------------------------------------


def pendulum(p: Any, q: Any, h: Any) -> Any:
    p = p - h / 2 * np.sin(q)
    q = q + h * p
    return p - h / 2 * np.sin(q), q


def words(pos: Any, vel: Any, timestep: Any) -> Any:
    vel, pos = pendulum(vel, pos, timestep)
    return pos, vel


def eps_last(q: Any, p: Any, eps: Any) -> Any:
    p, q = pendulum(p, q, eps)
    return q, p


def size_first(epsilon: Any, momentum: Any, theta: Any) -> Any:
    return pendulum(momentum, theta, epsilon)


def unknown_names(a: Any, b: Any, c: Any) -> Any:
    p, q = pendulum(b, c, a)
    return p, q


def state_of_q_p(y: Any, dt: Any) -> Any:
    q, p = y
    p, q = pendulum(p, q, dt)
    return np.array([q, p])


def state_of_p_q(y: Any, dt: Any) -> Any:
    p, q = pendulum(y[0], y[1], dt)
    return p, q


def by_attributes(state: Any, h: Any) -> Any:
    p, q = pendulum(state.momentum, state.position, h)
    return state._replace(position=q, momentum=p)


Phase = namedtuple("Phase", ["q", "p"])


def annotated(state: Phase, h: Any) -> Phase:
    p, q = pendulum(state.p, state.q, h)
    return Phase(q, p)


TWO_BODIES = (
    "(p1**2 + p2**2 + p3**2 + p4**2 + p5**2 + p6**2)/2"
    " - 1/sqrt((q1 - q4)**2 + (q2 - q5)**2 + (q3 - q6)**2)"
)


def bodies(p: Any, q: Any, h: Any) -> Any:
    """Arrays of shape (2, 3)."""

    def force(q: Any) -> Any:
        d = q[1] - q[0]
        f = d / np.sqrt((d * d).sum()) ** 3
        return np.array([f, -f])

    p = p + h / 2 * force(q)
    q = q + h * p
    return p + h / 2 * force(q), q


# -- other forms ----------------------------------------------------------------------------------

MASSES = np.array([1.0, 3.0])
UNLIKE = "p1**2/2 + p2**2/6 - cos(q2 - q1)"


def in_velocities(v: Any, x: Any, h: Any = 0.1) -> Any:
    def acceleration(x: Any) -> Any:
        f = np.sin(x[1] - x[0])
        return np.array([f, -f]) / MASSES

    v = v + h / 2 * acceleration(x)
    x = x + h * v
    return v + h / 2 * acceleration(x), x


def boris(v: Any, x: Any, dt: float = 0.1) -> Any:
    """It keeps volume, and not Ω."""
    e = np.array([-x[0], -2 * x[1], 0.5 * x[2]])
    t = dt / 2 * np.array([0.3 * x[1], 0.2 * x[0] * x[2], 1.0 + 0.1 * (x[0] ** 2 - x[2] ** 2)])
    v = v + dt / 2 * e
    w = v + np.cross(v, t)
    v = v + np.cross(w, 2 * t / (1 + np.dot(t, t))) + dt / 2 * e
    return v, x + dt * v


# -- branches -------------------------------------------------------------------------------------


def faulty(where: Callable[[Any, Any], Any]) -> Step:
    """Verlet of the pendulum, with a friction of 10⁻³ h where that holds."""

    def step(p: Any, q: Any, h: Any) -> Any:
        rub = 1 - h / 1000 if where(p, q) else 1
        p, q = pendulum(p, q, h)
        return p * rub, q

    return step


def clipped(p: Any, q: Any, h: Any) -> Any:
    p, q = pendulum(p, q, h)
    return min(p, 1.0), q


def cut_off(distance: float) -> Step:
    def force(q: Any) -> Any:
        return -math.sin(q) if abs(q) < distance else 0.0

    def step(p: Any, q: Any, h: Any) -> Any:
        p = p + h / 2 * force(q)
        q = q + h * p
        return p + h / 2 * force(q), q

    return step


# -- implicit, and long ---------------------------------------------------------------------------

RIEMANNIAN = "p**2/(2*(1 + q**2)) + log(1 + q**2)/2 + q**2/2"


def generalised_leapfrog(tolerance: float) -> Step:
    """Of an H whose mass depends on q, both half-steps by loops that end at the tolerance."""

    def slope(p: Any, q: Any) -> Any:
        mass = 1 + q * q
        return -p * p * q / mass**2 + q / mass + q

    def solved(advance: Callable[[Any], Any], x: Any) -> Any:
        for _ in range(100):
            new = advance(x)
            done = abs(new - x) < tolerance
            x = new
            if done:
                break
        return x

    def step(p: Any, q: Any, h: Any) -> Any:
        half = solved(lambda x: p - h / 2 * slope(x, q), p)
        end = solved(lambda x: q + h / 2 * (half / (1 + q * q) + half / (1 + x * x)), q)
        return half - h / 2 * slope(half, end), end

    return step


DOUBLED = (
    "(q1**2 + 1)*(p2**2 + 1)/2 + (q2**2 + 1)*(p1**2 + 1)/2 + 20*((q1 - q2)**2 + (p1 - p2)**2)/2"
)


def doubled(z: Any, h: Any) -> Any:
    """Two copies of a phase space, bound to each other by a rotation with ω = 20."""
    p, q = z[:2], z[2:]
    c, s = math.cos(40 * h), math.sin(40 * h)

    def first(p: Any, q: Any) -> Any:
        a, b = q[0], p[1]
        return [p[0] - h / 2 * a * (b * b + 1), b], [a, q[1] + h / 2 * b * (a * a + 1)]

    def second(p: Any, q: Any) -> Any:
        a, b = p[0], q[1]
        return [a, p[1] - h / 2 * b * (a * a + 1)], [q[0] + h / 2 * a * (b * b + 1), b]

    p, q = second(*first(p, q))
    dp, dq = p[0] - p[1], q[0] - q[1]
    tp, tq = c * dp - s * dq, c * dq + s * dp
    mp, mq = p[0] + p[1], q[0] + q[1]
    p, q = [(mp + tp) / 2, (mp - tp) / 2], [(mq + tq) / 2, (mq - tq) / 2]
    p, q = first(*second(p, q))
    return [*p, *q]


STAR = (
    "(p1**2 + p2**2)/0.002 + (p3**2 + p4**2)/0.001 + ((p1 + p3)**2 + (p2 + p4)**2)/2"
    " - 0.001/sqrt(q1**2 + q2**2) - 0.0005/sqrt(q3**2 + q4**2)"
    " - 0.0000005/sqrt((q1 - q3)**2 + (q2 - q4)**2)"
)


def planets(strength: float = 1.0) -> Step:
    """A star and two light planets, in democratic heliocentric coordinates."""
    one, two = 1e-3, 5e-4

    def force(q: Any) -> Any:
        a, b = (q[0] ** 2 + q[1] ** 2) ** 1.5, (q[2] ** 2 + q[3] ** 2) ** 1.5
        x, y = q[0] - q[2], q[1] - q[3]
        k = strength * one * two / (x * x + y * y) ** 1.5
        return np.array([-one * q[0] / a - k * x, -one * q[1] / a - k * y,
                         -two * q[2] / b + k * x, -two * q[3] / b + k * y])  # fmt: skip

    def jump(p: Any) -> Any:
        x, y = p[0] + p[2], p[1] + p[3]
        return np.array([x, y, x, y])

    def step(p: Any, q: Any, h: Any) -> Any:
        q = q + h / 2 * jump(p)
        p = p + h / 2 * force(q)
        q = q + h * p / np.array([one, one, two, two])
        p = p + h / 2 * force(q)
        return p, q + h / 2 * jump(p)

    return step


FAST_KEPLER = """
#include <math.h>
void step(int n, double t, double h, double *p, double *q)
{
    double r = pow(q[0]*q[0] + q[1]*q[1], 1.5), a = -100*q[0]/r, b = -100*q[1]/r;
    q[0] += h*p[0]; q[1] += h*p[1];
    p[0] += h*a; p[1] += h*b;
}
"""
