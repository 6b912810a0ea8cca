"""Ruth's scheme of order 3, for H = T(p) + V(q): kicks 7/24, 3/4, −1/24, drifts 2/3, −2/3, 1."""

from sympy import Rational

from verify.schemes.splitting import alternating, splitting

_SIZES = (
    Rational(7, 24), Rational(2, 3), Rational(3, 4), Rational(-2, 3), Rational(-1, 24), Rational(1),
)  # fmt: skip
SCHEME = splitting(
    "ruth3",
    alternating("kick", _SIZES),
    order=3,
    symmetric=False,
    source="Ruth, IEEE Trans. Nucl. Sci. 30 (1983) 2669–2671; Hairer, Lubich, Wanner, "
    "Geometric Numerical Integration, II.5",
)
