"""The explicit midpoint rule, Runge's scheme of order 2: z' = z + h f(z + (h/2) f(z))."""

from fractions import Fraction

from verify.schemes.conditions.every_hamiltonian import RungeKutta
from verify.schemes.scheme import Scheme

SCHEME = Scheme(
    "explicit-midpoint",
    order=2,
    source="Hairer, Lubich, Wanner, Geometric Numerical Integration, II.1.1",
    every_h=RungeKutta(rows=((), (Fraction(1, 2),)), weights=(Fraction(0), Fraction(1))),
)
