"""The classical Runge–Kutta scheme, four stages, order 4."""

from fractions import Fraction

from verify.schemes.conditions.every_hamiltonian import RungeKutta
from verify.schemes.scheme import Scheme

_ZERO, _HALF, _ONE = Fraction(0), Fraction(1, 2), Fraction(1)
_TABLEAU = RungeKutta(
    rows=((), (_HALF,), (_ZERO, _HALF), (_ZERO, _ZERO, _ONE)),
    weights=(_ONE / 6, _ONE / 3, _ONE / 3, _ONE / 6),
)
ALIASES = ("runge-kutta", "runge-kutta4", "runge-kutta-4")
SCHEME = Scheme(
    "rk4",
    order=4,
    source="Hairer, Lubich, Wanner, Geometric Numerical Integration, II.1.1",
    every_h=_TABLEAU,
)
