"""Gauss's collocation method of three stages, order 6; its nodes are 1/2 ∓ √15/10 and 1/2."""

import sympy

from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.conditions.tree_conditions import TreeConditions
from verify.schemes.scheme import Scheme

_OUTER, _INNER, _ROOT = sympy.Rational(5, 36), sympy.Rational(2, 9), sympy.sqrt(15)
TABLEAU = ImplicitTableau.from_numbers(
    rows=(
        (_OUTER, _INNER - _ROOT / 15, _OUTER - _ROOT / 30),
        (_OUTER + _ROOT / 24, _INNER, _OUTER - _ROOT / 24),
        (_OUTER + _ROOT / 30, _INNER + _ROOT / 15, _OUTER),
    ),
    weights=(2 * _OUTER, 2 * _INNER, 2 * _OUTER),
)
ALIASES = ("gauss-legendre6", "gauss-legendre-6")
SCHEME = Scheme(
    "gauss6",
    order=6,
    area_preserving=True,
    explicit=False,
    symmetric=True,
    every_h=TreeConditions(TABLEAU),
    source="Hairer, Lubich, Wanner, Geometric Numerical Integration, II.1.3 and VI.4",
)
