"""Ruth's scheme of order 3, for H = T(p) + V(q): kicks 7/24, 3/4, −1/24, drifts 2/3, −2/3, 1."""

from fractions import Fraction

from verify.schemes.splitting import alternating, splitting

_SIZES = (
    Fraction(7, 24), Fraction(2, 3), Fraction(3, 4), Fraction(-2, 3), Fraction(-1, 24), Fraction(1),
)  # fmt: skip
SCHEME = splitting(
    "ruth3",
    alternating("kick", _SIZES),
    order=3,
    symmetric=False,
    source="Ruth, IEEE Trans. Nucl. Sci. 30 (1983) 2669–2671; Hairer, Lubich, Wanner, "
    "Geometric Numerical Integration, II.5",
)
