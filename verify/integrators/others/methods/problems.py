"""The systems on which steps of others are tried, each in a few lines of Python.

All are H = p²/2 + V(q, t), so that a step of any kind takes them. Of each kind there are two, as
what one problem does not show another may.
"""

from dataclasses import dataclass
from fractions import Fraction

from verify.hamiltonians.hamiltonian import Hamiltonian


@dataclass(frozen=True)
class Problem:
    """`said`: what it is, for people. `force`: its lines of Python, force(t, q) of an array q, with
    numpy as np. `tag`: what is appended to a method's name."""

    said: str
    hamiltonian: str
    force: str
    tag: str = ""

    @property
    def exact(self) -> Hamiltonian:
        """H."""
        return Hamiltonian.parse(self.hamiltonian)

    @property
    def timed(self) -> bool:
        """Whether the force depends on time."""
        return self.exact.time_dependent

    @property
    def degrees(self) -> int:
        """Of freedom."""
        return self.exact.degrees

    @property
    def arguments(self) -> str:
        """Of a step for it."""
        return "p, q, t, h" if self.timed else "p, q, h"


def _force(line: str) -> str:
    return f"def force(t, q):\n    return {line}\n"


PENDULUM = Problem("a pendulum", "p**2/2 - cos(q)", _force("-np.sin(q)"))
TWO_WAVES = Problem(
    "a particle in a potential of two waves",
    "p**2/2 - 2*cos(q) - sin(2*q)/2",
    _force("np.cos(2 * q) - 2 * np.sin(q)"),
)
DRIVEN = Problem(
    "a driven pendulum",
    "p**2/2 - cos(q) - q*cos(2*t)/2",
    _force("np.cos(2 * t) / 2 - np.sin(q)"),
    ", driven",
)
SWUNG = Problem(
    "an oscillator with a stiffness that depends on time",
    "p**2/2 + (1 + sin(t)/2)*(q**2/2 + q**4/4)",
    _force("-(1 + np.sin(t) / 2) * (q + q**3)"),
    ", driven",
)
HENON_HEILES = Problem(
    "Hénon and Heiles's system",
    "p1**2/2 + p2**2/2 + q1**2/2 + q2**2/2 + q1**2*q2 - q2**3/3",
    _force("np.array([-q[0] - 2 * q[0] * q[1], -q[1] - q[0] ** 2 + q[1] ** 2])"),
    ", two degrees",
)
COUPLED = Problem(
    "two coupled oscillators of degree 4",
    "p1**2/2 + p2**2/2 + q1**4/4 + q2**2 + q1**2*q2**2/2",
    _force("np.array([-(q[0] ** 3) - q[0] * q[1] ** 2, -2 * q[1] - q[0] ** 2 * q[1]])"),
    ", two degrees",
)
EACH = TWO_WAVES, DRIVEN, HENON_HEILES
AGAIN = {TWO_WAVES: PENDULUM, DRIVEN: SWUNG, HENON_HEILES: COUPLED}  # the second of a kind
# p, q of the points at which a step is tried where nothing else is said.
POINTS = tuple(
    (Fraction(p), Fraction(q))
    for p, q in (("1/3", "3/5"), ("-1/2", "7/8"), ("1/7", "6/5"), ("3/4", "-2/5"), ("-1/5", "-2/5"))
)
# Where a high order is seen in float64, between a step that is too large for it and rounding.
AWAY = (
    (Fraction(5, 4), Fraction(-1, 2)),
    (Fraction(-1, 3), Fraction(9, 8)),
)
LONG = tuple(Fraction(k, 64) for k in (*range(64, 16, -4), *range(16, 3, -1)))
USUAL = tuple(
    Fraction(x, 2**k) for k in range(3, 16) for x in ((4, 3) if k < 10 else (4,))
)  # fmt: skip
