"""McLachlan's symmetric schemes of order 4, for H = T(p) + V(q): five stages, and four.

`mclachlan4`, in Q(√19): drifts (14 − √19)/108, (20 − 7√19)/108, (5 + 2√19)/27 with kicks 2/5,
−1/10, 2/5 between them. `mclachlan4-s4`, in Q(√471): drifts (642 + √471)/3924,
121(12 − √471)/3924 and what is left to 1 in the middle, with kicks 6/11 and −1/22. Both tables
satisfy all conditions of order 4 exactly; per stage the one of five has the smaller error.
"""

from collections.abc import Sequence

from sympy import Expr, Rational, sqrt

from verify.schemes.scheme import Scheme
from verify.schemes.splitting import palindrome, splitting

EXAMPLES = ("mclachlan4", "mclachlan4-s4")


def _five() -> Sequence[Expr]:
    first, second = (14 - sqrt(19)) / 108, (20 - 7 * sqrt(19)) / 108
    outer, inner = Rational(2, 5), Rational(-1, 10)
    return first, outer, second, inner, Rational(1, 2) - first - second, Rational(2, 5)


def _four() -> Sequence[Expr]:
    first, second = (642 + sqrt(471)) / 3924, 121 * (12 - sqrt(471)) / 3924
    return first, Rational(6, 11), second, Rational(-1, 22), 1 - 2 * (first + second)


_HALVES = dict(zip(EXAMPLES, (_five(), _four()), strict=True))


def make(name: str) -> Scheme | None:
    if name not in _HALVES:
        return None
    return splitting(
        name,
        palindrome("drift", _HALVES[name]),
        order=4,
        symmetric=True,
        source="McLachlan, SIAM J. Sci. Comput. 16 (1995) 151–168",
    )
