"""Blanes and Moan's scheme of order 4 with six stages (their S₆), for H = T(p) + V(q).

The paper prints 15 or 16 digits of its coefficients, too few for order 4 to hold exactly. Here a₁,
a₂ and a₃ are exactly the printed decimals, and a₄ = 1 − 2 (a₁ + a₂ + a₃). A palindrome has order 4
if Σ a = Σ b = 1 and two conditions of order 3 hold: that of the word DDK is linear in b₁ and b₂,
that of DKK quadratic. With c_i = a₁ + … + a_i they read

    2 Σ b_i (c_i² − c_i) = −1/6,    2 Σ a_i (e_i² − e_i) + a₄ (¼ − ½) = −1/6,

over i = 1, 2, 3, with e_i = b₁ + … + b_(i−1), b₃ = ½ − b₁ − b₂. So b₁ and b₂
are in Q(√Δ) with a rational Δ. One solution is b₁ = 0.209515106613362089, b₂ =
−0.143851773179818115, which agrees with the printed 0.209515106613362 and −0.143851773179818 to 15
places. The other has b₁ = 0.238.
"""

from sympy import Expr, Rational, S, sqrt

from verify.schemes.splitting import palindrome, splitting

PRINTED = {
    "a": ("0.0792036964311957", "0.353172906049774", "-0.0420650803577195"),
    "b": ("0.209515106613362", "-0.143851773179818"),
}


def _kicks(a: tuple[Rational, ...]) -> tuple[Expr, Expr]:
    """Return b₁ and b₂ for a₁, a₂, a₃."""
    a1, a2, a3 = a
    a4 = 1 - 2 * (a1 + a2 + a3)
    f1, f2, f3 = (c * c - c for c in (a1, a1 + a2, a1 + a2 + a3))
    # b₁ (f₁ − f₃) + b₂ (f₂ − f₃) = −1/12 − f₃/2, so that b₂ = m + n b₁
    m, n = (-S(1) / 12 - f3 / 2) / (f2 - f3), -(f1 - f3) / (f2 - f3)
    # e₂ = b₁, e₃ = b₁ + b₂ = m + (n + 1) b₁ in the other condition: u b₁² + v b₁ + w = 0
    u = a2 + a3 * (n + 1) ** 2
    v = -a2 + a3 * (n + 1) * (2 * m - 1)
    w = a3 * (m * m - m) + (S(1) / 6 - a4 / 4) / 2
    first = (-v + sqrt(v * v - 4 * u * w)) / (2 * u)
    return first, m + n * first


_A = tuple(map(Rational, PRINTED["a"]))
_B = _kicks(_A)
_HALF = (
    _A[0], _B[0], _A[1], _B[1], _A[2], S.Half - _B[0] - _B[1], 1 - 2 * sum(_A, S.Zero),
)  # fmt: skip
SCHEME = splitting(
    "blanes-moan4",
    palindrome("drift", _HALF),
    order=4,
    symmetric=True,
    source="Blanes, Moan, J. Comput. Appl. Math. 142 (2002) 313–330",
)
