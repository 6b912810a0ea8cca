"""Closed forms of sums over the steps of a run, for every number of steps.

F(N) is the sum of the first N terms f(0) … f(N − 1) where F(0) = 0 and F(N + 1) − F(N) = f(N).
"""

from collections.abc import Callable

from verify.papers.checks.check import Check, vanishes
from verify.papers.checks.differential import Poly, free_variables

Of = Callable[[Poly], Poly]


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
    rest = total(n) - n**5 / fifth
    check = vanishes(
        "Σ k⁴ − (N − 1)N(2N − 1)(3N² − 3N − 1)/30, which is N⁵/5 and lower powers of N",
        *_sum_gaps(lambda k: k**4, total),
    )
    # Only the leading power of N counts for the limit of the mean.
    lower = rest.total_degree() < 5
    return Check(check.what, check.holds and lower, check.value if lower else "N⁵ is left")


def compensated_changes(double: int = 2) -> Check:
    """Check Σ h(1/2 − kh) = h/2, h = 1/N; `double` stands for the first 2."""
    (n,) = free_variables("N")
    total = n * n / double - n * (n - 1) / 2  # times N²; Σ k is checked beside it
    return vanishes(
        "Σ h(1/2 − kh) − h/2, h = 1/N, times N²",
        *_sum_gaps(lambda k: k, lambda k: k * (k - 1) / 2),
        total - n / 2,
    )


def _sum_gaps(term: Of, total: Of) -> list[Poly]:
    """Return polynomials that vanish if `total` is the sum of the terms before it.

    They are F(N + 1) − F(N) − f(N) and F(0).
    """
    (n,) = free_variables("N")
    return [total(n + 1) - total(n) - term(n), total(0 * n)]
