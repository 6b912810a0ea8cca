"""Two bodies in their plane: H = |p|²/2 − μ/|q|. It is smooth where they do not collide.

From the pericentre an orbit of eccentricity e starts at q = (1 − e, 0) and
p = (0, √((1 + e)/(1 − e))), for μ = 1 and a semi-major axis of 1; with e = (k² − 1)/(k² + 1) that
root is k.

Its ellipses are known in closed form, here to any number of digits. With a = −μ/(2H), n = √(μ/a³),
x the change of the eccentric anomaly in the time t, r₀ = |q₀|:

n t = x − C sin x + S (1 − cos x), C = 1 − r₀/a, S = q₀·p₀/√(μ a), C² + S² = e²

(Danby, Fundamentals of Celestial Mechanics, 6.7–6.8). The right side has a slope of 1 − e at least,
so that a number near its root with the residual F is within |F|/(1 − e) of it.
"""

from collections.abc import Sequence
from fractions import Fraction

from flint import arb

from verify.arithmetic.arb import rational_ball
from verify.hamiltonians.named_system import System

Vector = tuple[Fraction, Fraction]
_MAX_NEWTON_STEPS = 200  # Newton steps


def is_ellipse(mu: Fraction, q: Vector, p: Vector) -> bool:
    """Return True if the orbit from there is bound, and does not run into the centre."""
    # Without angular momentum the orbit is a line through the centre.
    turn = q[0] * p[1] - q[1] * p[0]
    if mu <= 0 or not turn or not any(q):
        return False
    speed = p[0] * p[0] + p[1] * p[1]
    square = q[0] * q[0] + q[1] * q[1]
    return speed * speed * square < 4 * mu * mu  # |p|²/2 < μ/|q|


def state_on_ellipse(mu: Fraction, q: Vector, p: Vector, time: Fraction) -> Sequence[arb]:
    """Return p1, p2, q1, q2 at that time, of an ellipse, within flint's precision."""
    (q1, q2), (p1, p2) = (tuple(map(rational_ball, x)) for x in (q, p))
    strength, t = rational_ball(mu), rational_ball(time)
    r0 = rational_ball(q[0] * q[0] + q[1] * q[1]).sqrt()
    speed = rational_ball(p[0] * p[0] + p[1] * p[1])
    a = strength / (2 * strength / r0 - speed)
    rate = (strength / a**3).sqrt()
    c = 1 - r0 / a
    s = rational_ball(q[0] * p[0] + q[1] * p[1]) / (strength * a).sqrt()
    x = _anomaly(rate * t, c, s, (c * c + s * s).sqrt())
    sin, cos = x.sin(), x.cos()
    r = a * (1 - c * cos + s * sin)
    # Gauss's f and g series: q(t) = f q₀ + g p₀ and p(t) = f' q₀ + g' p₀.
    f = 1 - a / r0 * (1 - cos)
    g = t + (sin - x) / rate
    f_dot = -(strength * a).sqrt() / (r * r0) * sin
    g_dot = 1 - a / r * (1 - cos)
    return [f_dot * q1 + g_dot * p1, f_dot * q2 + g_dot * p2, f * q1 + g * p1, f * q2 + g * p2]


def _anomaly(mean: arb, c: arb, s: arb, e: arb) -> arb:
    """Return the root x of x − C sin x + S (1 − cos x) = mean; not finite where e may be 1."""

    def residual_at(x: arb) -> arb:
        return x - c * x.sin() + s * (1 - x.cos()) - mean

    x, low, high = mean.mid(), (mean - 2).lower().mid(), (mean + 2).upper().mid()
    for _ in range(
        _MAX_NEWTON_STEPS
    ):  # Newton's method, held between the ends of where the root is
        residual = residual_at(x)
        if residual > 0:
            high = x
        elif residual < 0:
            low = x
        else:
            break
        step_end = (x - residual / (1 - c * x.cos() + s * x.sin())).mid()
        x = step_end if low < step_end < high else ((low + high) / 2).mid()
    # The mean value theorem with the least slope 1 − e encloses the root, whatever Newton reached.
    distance = abs(residual_at(x)) / (1 - e)
    return x + distance * arb(0, 1) if 1 - e > 0 else arb.nan()


SYSTEM = System(
    name="kepler",
    title="Kepler problem in the plane",
    formula="(p1**2 + p2**2)/2 - mu/sqrt(q1**2 + q2**2)",
    source="Hairer, Lubich, Wanner, Geometric Numerical Integration, I.2.1",
    parameters={"mu": "the strength of the attraction"},
    regimes={
        "circle": {"mu": "1", "p": "0, 1", "q": "1, 0"},
        "e=0.6": {"mu": "1", "p": "0, 2", "q": "2/5, 0"},
        "e=0.999": {"mu": "1", "p": "0, 45", "q": "1/1013, 0"},
    },
)
