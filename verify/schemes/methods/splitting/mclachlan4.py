"""McLachlan's symmetric scheme of order 4 with five stages, for H = T(p) + V(q), in Q(√19).

Drifts (14 − √19)/108, (20 − 7√19)/108, (5 + 2√19)/27 with kicks 2/5, −1/10, 2/5 between them. The
table satisfies all conditions of order 4 exactly.
"""

from sympy import Rational, sqrt

from verify.schemes.splitting import palindrome, splitting

_FIRST, _SECOND = (14 - sqrt(19)) / 108, (20 - 7 * sqrt(19)) / 108
_KICK = Rational(2, 5)
_HALF = _FIRST, _KICK, _SECOND, Rational(-1, 10), Rational(1, 2) - _FIRST - _SECOND, _KICK
SCHEME = splitting(
    "mclachlan4",
    palindrome("drift", _HALF),
    order=4,
    symmetric=True,
    source="McLachlan, SIAM J. Sci. Comput. 16 (1995) 151–168",
)
