"""The implicit midpoint rule: z' = z + h f((z + z')/2), Gauss's method of one stage, for any H.

For a quadratic H it is written in closed form, with the denominator 1 + (h²/4) det Hess H.
"""

from fractions import Fraction

import sympy

from verify.schemes.conditions.every_hamiltonian import Stage, StageEquations
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.maps.kinds.implicit_runge_kutta import implicit_map
from verify.schemes.scheme import Scheme

TABLEAU = ImplicitTableau.from_numbers(rows=((sympy.Rational(1, 2),),), weights=(1,))
_ONE = Fraction(1)
ALIASES = ("gauss2",)
SCHEME = Scheme(
    "implicit-midpoint",
    order=2,
    area_preserving=True,
    explicit=False,
    symmetric=True,
    build=lambda hamiltonian: implicit_map(hamiltonian, TABLEAU),
    every_h=StageEquations((Stage(kick=_ONE, drift=_ONE, at_p=_ONE / 2, at_q=_ONE / 2),)),
    source="Hairer, Lubich, Wanner, Geometric Numerical Integration, I.1.2 and VI.4",
)
