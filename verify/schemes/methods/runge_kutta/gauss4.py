"""Gauss's collocation method of two stages, order 4; its nodes are 1/2 ∓ √3/6."""

import sympy

from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.conditions.tree_conditions import TreeConditions
from verify.schemes.scheme import Scheme

_QUARTER, _HALF, _ROOT = sympy.Rational(1, 4), sympy.Rational(1, 2), sympy.sqrt(3)
TABLEAU = ImplicitTableau.from_numbers(
    rows=((_QUARTER, _QUARTER - _ROOT / 6), (_QUARTER + _ROOT / 6, _QUARTER)),
    weights=(_HALF, _HALF),
)
ALIASES = ("gauss-legendre4", "gauss-legendre-4")
SCHEME = Scheme(
    "gauss4",
    order=4,
    area_preserving=True,
    explicit=False,
    symmetric=True,
    every_h=TreeConditions(TABLEAU),
    source="Hairer, Lubich, Wanner, Geometric Numerical Integration, II.1.3 and VI.4",
)
