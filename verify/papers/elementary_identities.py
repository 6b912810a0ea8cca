"""Identities on which several arguments rest; a parameter of each spoils it, as a control.

Of sums over the steps of a run: F(N) is the sum of the first N terms f(0) … f(N − 1) if F(0) = 0
and F(N + 1) − F(N) = f(N).

Of distances: in each order of three numbers a, b, c these are sums of the two gaps x, y ≥ 0 between
neighbours. An inequality between sums of distances holds if the right side less the left one has no
negative coefficient of x or y; equal numbers are those with x = 0 or y = 0.

Of matrices of the plane: determinants of products, and the derivative of a field.
"""

from collections.abc import Callable, Iterator, Sequence
from itertools import permutations, product

import sympy

from verify.papers.argument import Check, same, vanishes
from verify.papers.differential_polynomials import Poly, flow_of_every_hamiltonian, free_variables

Term = Callable[[Poly], Poly]  # f(k), or F(N)
Gaps = tuple[int, int]  # the coefficients of x and y
_NAMES = "abc"
PlaneMatrix = tuple[tuple[Poly, Poly], tuple[Poly, Poly]]


# -- sums over the steps of a run ------------------------------------------------------------------


def geometric(offset: int = 0) -> Check:
    """Check G_(k+1) = r G_k + 1 and G_0 = 0 for G_k = (r^k − 1)/(r − 1).

    `offset` is added to G_k, as a control.
    """
    r, w = free_variables("r w")  # w = r^k

    def times_denominator(power: Poly) -> Poly:
        """Return (r − 1) G for r^k = power."""
        return power - 1 + offset * (r - 1)

    return vanishes(
        "`G_{k+1}` − r `G_k` − 1 and `G_0` for `G_k` = (`r^k` − 1)/(r − 1), times r − 1",
        times_denominator(r * w) - r * times_denominator(w) - (r - 1),
        times_denominator(w**0),
    )


def bound_of_eq_11(extra: int = 1) -> Check:
    """Check h^(n+1) (E + (E − 1)/(hL)) = h^n ((E − 1)/L + h E); `extra`: factor of the last E."""
    h, rate, e, w = free_variables("h L E w")  # w = h^n
    left_side = w * (h * rate * e + e - 1)  # times L
    return vanishes(
        "`h^(n+1)` (E + (E − 1)/(hL)) − `h^n` ((E − 1)/L + hE), times L, with E = `e^(LT)`",
        left_side - w * (e - 1 + extra * rate * h * e),
    )


def squares_of_times(factor: int = 1) -> Check:
    """Check Σ (kh)² = (N − 1)(2N − 1)/(6N), h = 1/N, which exceeds N/8 by (5N − 2)(N − 2)/(24N).

    `factor`: of the summands, 1 as it should be.
    """
    (n,) = free_variables("N")
    above = 4 * (n - 1) * (2 * n - 1) - 3 * n * n - (5 * n - 2) * (n - 2)  # times 24 N
    return vanishes(
        "Σ (kh)² − (N − 1)(2N − 1)/(6N), and that less N/8 − (5N − 2)(N − 2)/(24N), h = 1/N",
        *_sum_gaps(lambda k: factor * k**2, lambda k: (k - 1) * k * (2 * k - 1) / 6),
        above,
    )


def mean_of_fourth_powers(fifth: int = 5) -> Check:
    """Check that (1/N) Σ (kh)⁴, h = 1/N, tends to 1/5, or to 1/`fifth`: Σ k⁴ = N⁵/5 + …."""

    def total(k: Poly) -> Poly:
        return (k - 1) * k * (2 * k - 1) * (3 * k * k - 3 * k - 1) / 30

    (n,) = free_variables("N")
    remainder = total(n) - n**5 / fifth
    check = vanishes(
        "Σ k⁴ − (N − 1)N(2N − 1)(3N² − 3N − 1)/30, which is N⁵/5 and lower powers of N",
        *_sum_gaps(lambda k: k**4, total),
    )
    # Only the leading power of N counts for the limit of the mean.
    lower = remainder.total_degree() < 5
    return Check(check.statement, check.holds and lower, check.value if lower else "N⁵ is left")


def compensated_changes(double: int = 2) -> Check:
    """Check Σ h(1/2 − kh) = h/2, h = 1/N; `double` stands for the first 2."""
    (n,) = free_variables("N")
    total = n * n / double - n * (n - 1) / 2  # times N²; Σ k is checked beside it
    return vanishes(
        "Σ h(1/2 − kh) − h/2, h = 1/N, times N²",
        *_sum_gaps(lambda k: k, lambda k: k * (k - 1) / 2),
        total - n / 2,
    )


def _sum_gaps(term: Term, total: Term) -> list[Poly]:
    """Return polynomials that vanish if `total` is the sum of the terms before it.

    They are F(N + 1) − F(N) − f(N) and F(0).
    """
    (n,) = free_variables("N")
    return [total(n + 1) - total(n) - term(n), total(0 * n)]


# -- the triangle inequality ----------------------------------------------------------------------


def triangle(middle: int = 1) -> Check:
    """Check |a − c| ≤ |a − b| + |b − c|; `middle`: the factor of the last distance."""
    holds = [_less(order, [("ac", 1)], [("ab", 1), ("bc", middle)]) for order in _orders()]
    return _check_of_orders("|a − c| ≤ |a − b| + |b − c|", holds)


def difference(distance: str = "ab") -> Check:
    """Check | |b − c| − |a − c| | ≤ |a − b|; `distance`: the one on its right."""
    holds = [
        _less(order, [("bc", sign), ("ac", -sign)], [(distance, 1)])
        for order, sign in product(_orders(), (1, -1))
    ]
    return _check_of_orders("| |b − c| − |a − c| | ≤ |a − b|", holds)


def _orders() -> Iterator[str]:
    return map("".join, permutations(_NAMES))


def _less(
    order: str, lesser: Sequence[tuple[str, int]], greater: Sequence[tuple[str, int]]
) -> bool:
    """Return True if Σ n·|u − v| over the left is at most that over the right, in that order."""
    terms = [*greater, *((pair, -n) for pair, n in lesser)]
    gap = [sum(n * _distance(order, pair)[k] for pair, n in terms) for k in (0, 1)]
    # A linear form in x, y ≥ 0 without negative coefficients is never negative.
    return min(gap) >= 0


def _distance(order: str, pair: str) -> Gaps:
    # Neighbours in the order are x or y apart; the outer two are x + y apart.
    first, last = sorted(order.index(name) for name in pair)
    return int(first == 0), int(last == 2)


def _check_of_orders(inequality: str, holds: Sequence[bool]) -> Check:
    method = "the difference is a sum of gaps between neighbours, none with a minus"
    return Check(
        f"{inequality} in each of the {len([*_orders()])} orders of a, b, c", all(holds), method
    )


# -- matrices of the plane -------------------------------------------------------------------------


def product_of_determinants(sign: int = 1) -> Check:
    """Check det (AB) = det A det B, all entries free; `sign` is that of one entry of AB."""
    a, b, c, d, e, f, g, h = free_variables("a b c d e f g h")
    product = ((a * e + sign * b * g, a * f + b * h), (c * e + d * g, c * f + d * h))
    return vanishes(
        "det (AB) − det A det B, all entries free",
        _det(product) - _det(((a, b), (c, d))) * _det(((e, f), (g, h))),
    )


def derivative_of_the_field(trace: int = 0) -> Check:
    """Check A² = −D and det (x + yA) = x² + y² D for A = f' of a generic H.

    `trace` is added to an entry of A, as a control.
    """
    x, y, pp, pq, qq = free_variables("x y H2_0 H1_1 H0_2")
    (a, b), (c, d) = field = ((-pq + trace, -qq), (pp, pq))
    det = pp * qq - pq * pq
    # The Cayley–Hamilton identity A² − (tr A) A + det A = 0 with tr A = 0.
    square = (a * a + b * c + det, a * b + b * d, c * a + d * c, c * b + d * d + det)
    return vanishes(
        "A² + D and det (x + yA) − (x² + y² D) for A = f' of a generic H, D = det Hess H",
        *square,
        _det(((x + y * a, y * b), (y * c, x + y * d))) - (x * x + y * y * _det(field)),
        _det(field) - det,
    )


def derivative_at_rest(weight: int = 1) -> Check:
    """Check (X g)' = g'A at points where f = 0, for generic g and H; `weight`: of one term."""
    flow = flow_of_every_hamiltonian(2, ["g", "g_p", "g_q", "g_pp", "g_pq", "g_qq"])
    ring = flow.ring
    ring.set_gradient("g", p=ring["g_p"], q=ring["g_q"])
    ring.set_gradient("g_p", p=ring["g_pp"], q=ring["g_pq"])
    ring.set_gradient("g_q", p=ring["g_pq"], q=ring["g_qq"])
    derivative = flow.derive(ring["g"])
    pp, pq, qq = flow.hessian
    expected = {
        "p": -ring["g_p"] * pq + weight * ring["g_q"] * pp,
        "q": -ring["g_p"] * qq + ring["g_q"] * pq,
    }
    # At an equilibrium the terms with second derivatives of g vanish: each has a factor H_p or H_q.
    rests: dict[str | int, int] = {"H1_0": 0, "H0_1": 0}
    gaps = [(ring.diff(derivative, by) - expected[by]).subs(rests) for by in expected]
    return vanishes("(X g)' − g'A where `H_p` = `H_q` = 0, g and H generic", *gaps)


def stretching(factor: int = 1) -> Check:
    """Check that the square of the symmetric part of f' is s² = H_pq² + (H_pp − H_qq)²/4.

    `factor`: of H_pq² in s², 1 as it should be.
    """
    pp, pq, qq = sympy.symbols("H_pp H_pq H_qq")
    field = sympy.Matrix([[-pq, -qq], [pp, pq]])
    part = (field + field.T) / 2
    square = factor * pq**2 + (pp - qq) ** 2 / 4
    statement = (
        "the symmetric part of f' squared is s² times the unit matrix, s² = `H_pq²` + (`H_pp` − "
        "`H_qq`)²/4"
    )
    gap = part * part - square * sympy.eye(2)
    return same(statement, list(gap), ("H_pp", "H_pq", "H_qq"), "exactly")


def _det(matrix: PlaneMatrix) -> Poly:
    (a, b), (c, d) = matrix
    return a * d - b * c
