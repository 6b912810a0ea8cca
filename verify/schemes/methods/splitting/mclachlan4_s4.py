"""McLachlan's symmetric scheme of order 4 with four stages, for H = T(p) + V(q), in Q(√471).

Drifts (642 + √471)/3924, 121(12 − √471)/3924 and the remainder to 1 in the middle, with kicks 6/11
and −1/22. The table satisfies all conditions of order 4 exactly; per stage `mclachlan4`, of five,
has the smaller error.
"""

from sympy import Rational, sqrt

from verify.schemes.splitting import palindrome, splitting

_FIRST, _SECOND = (642 + sqrt(471)) / 3924, 121 * (12 - sqrt(471)) / 3924
_HALF = _FIRST, Rational(6, 11), _SECOND, Rational(-1, 22), 1 - 2 * (_FIRST + _SECOND)
SCHEME = splitting(
    "mclachlan4-s4",
    palindrome("drift", _HALF),
    order=4,
    symmetric=True,
    source="McLachlan, SIAM J. Sci. Comput. 16 (1995) 151–168",
)
