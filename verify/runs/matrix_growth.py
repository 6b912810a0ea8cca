"""The growth of a run's tangent maps M, and the bound of W that follows from it.

A bound of the inverse of a tangent map follows from the records of M in float64. For
2 × 2, ‖M⁻¹‖ = ‖M‖/|det M|. In n degrees of freedom M⁻¹ = B⁻¹ MᵀΩ with B = MᵀΩM, which is
antisymmetric: its singular values come in pairs, |Pf B| is the product of one of each, and det M is
Pf B/Pf Ω. So ‖M⁻¹‖ ≤ ‖M‖ ‖B‖ⁿ⁻¹/|det M|, and ‖B‖² is at most the sum of the squares of its entries
above the diagonal. Where the map is nearly symplectic B stays near Ω, however large M grows.

Of m coordinates that are no p and q, ‖M⁻¹‖ is at most the product of the m − 1 greatest singular
values over |det M|, and by the inequality of the means (F²/(m − 1))^((m−1)/2)/|det M|, F the norm
of Frobenius. As ‖M‖ ≥ F/√m, ‖M‖/‖M⁻¹‖ ≥ |det M| (m − 1)^((m−1)/2) m^(−1/2) F^(2−m).

W is the symplectic defect of a whole run in n degrees of freedom. Let J_k be the exact Jacobian of
the first k steps along the exact orbit, Ĵ_k the computed one, and M_k the matrices that were
carried in float64 (see `verify.runs.a_posteriori_bound`, whose e_k, A_k, d, Q and S these are).
With B a bound of the second derivatives of a step, ‖A(ẑ_k) − A(z_k)‖ ≤ B ‖e_k‖.

1. D_k = M_k − J_k obeys D_{k+1} = A(ẑ_k) D_k + (A(ẑ_k) − A(z_k)) J_k + R_k. As long as
   ‖J_k‖ ≤ 2 max ‖M‖, D_k = M_k Y_k has ‖Y_k‖ ≤ Y = e^Q (2 max ‖M‖² B Σ‖e_k‖/d + Q). Where Y ≤ 1
   that gives ‖J_{k+1}‖ ≤ 2 max ‖M‖ again, so that it holds for all k.
2. E_k = Ĵ_k − J_k obeys the same with the rounding ρ of a step of Ĵ in place of R_k:
   ‖E_k‖ ≤ E = max ‖M‖ e^Q (2 max ‖M‖² B Σ‖e_k‖ + S ρ)/d.
3. W = Σ J_kᵀ S_k J_k; an entry of the computed sum is off by at most the sum of
   (‖Ĵ‖ + ‖J‖) ‖S‖ E + ‖J‖² ‖S(ẑ_k) − S(z_k)‖, and by the rounding of its terms. Entries of Ĵ were
   taken to be within ±3 max ‖M‖ where rounding was counted, so that E ≤ max ‖M‖ is required.

Where ‖M‖ grows like N, as in integrable motion, Σ‖e_k‖ grows like N⁵, E like N⁷, and the bound like
N⁹: it takes the worst of every step for all. `verify.runs.digits_on_demand` has a nearer one.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import flint

from verify.arithmetic.arb import rational_ball
from verify.kernels.rounding import Ball
from verify.kernels.step.tangent_map import entries_of

_LARGEST_Q = 50  # no bound is given beyond it, as the factor e^Q would make it useless
MOST = 3  # units of max ‖M‖; the entries of Ĵ are taken to be within it
# A bound of the rounding of an entry of MᵀΩM, and of det M in the plane, relative to ‖M‖².
_RELATIVE_ROUNDING = flint.arb(2) ** -48


def least_of(size: int, records: Mapping[str, Ball]) -> Ball:
    """Return d with ‖M‖/‖M⁻¹‖ ≥ d for all M that were carried; it is useless unless d > 0."""
    lost = _RELATIVE_ROUNDING * records["growth_top"]
    if size == 2:
        return records["det_low"] - lost
    if "form_top" not in records:
        return _least_of_any(size, records)
    n = size // 2
    # A bound of the entries of the computed B.
    largest = records["form_top"].abs_upper().sqrt() * (1 + _RELATIVE_ROUNDING)
    terms = flint.arb(1)
    for k in range(1, n + 1):
        terms *= 2 * k - 1  # in the end the number of products in a Pfaffian
    # A bound of the error of each product of n entries, each of which is off by at most `lost`.
    product = (largest + lost) ** n
    error = terms * (product - largest**n + _RELATIVE_ROUNDING * n * product)
    norm = largest + size * lost
    return (records["det_low"] - error) / norm ** (n - 1)


def _least_of_any(size: int, records: Mapping[str, Ball]) -> Ball:
    # All products of a determinant, one entry of each row, have sizes whose sum is at most F^m.
    # Each is rounded in its factors, its products and its sums, at most m² + m times.
    largest = records["growth_top"].abs_upper().sqrt() * (1 + _RELATIVE_ROUNDING)
    least = records["det_low"] - size * size * _RELATIVE_ROUNDING * largest**size
    if size == 1:
        return least * least if least > 0 else least
    root = (flint.arb(size - 1) ** (size - 1) / size).sqrt()
    return least * root / largest ** (size - 2)


def square_of_norm(size: int, squares: Ball, least: Ball) -> Ball:
    """Return a bound of ‖M‖² from `squares`, a bound of the sum of M's squared entries, and d.

    If `squares` bounds the mean of such sums over several M, the result bounds the mean of ‖M‖².
    """
    if size != 2:
        return squares.abs_upper()
    return ((squares + (squares * squares - 4 * least * least).abs_upper().sqrt()) / 2).abs_upper()


@dataclass(frozen=True)
class MatrixGrowth:
    """The growth of a run's matrices M: N, d, Q, max ‖M‖ and S of `a_posteriori_bound`'s text.

    `end`: a bound of the norm of the last one, if its entries are noted.
    """

    steps: int
    least: Ball
    rate: Ball
    top: Ball
    path: Ball
    end: Ball


def growth_of(
    size: int, records: Mapping[str, Ball], steps: int, rounding: Ball, last: Sequence[Ball]
) -> MatrixGrowth | None:
    """Return the growth of the `size` × `size` matrices of a run's records; None if no bound
    follows from it. `rounding`: ρ. `last`: the entries of the last one, if they are noted."""
    # The rounding of float64's sums, over the steps and in each sum of squares.
    slack = 1 + flint.arb(steps + size - 2) * flint.arb(2) ** -50
    growth, highest = records["growth"] * slack, records["growth_top"] * slack
    least = least_of(size, records)
    if not (growth.is_finite() and least > 0):
        return None
    # This is Q of `a_posteriori_bound`'s text.
    rate = rounding * growth / least
    if not rate < _LARGEST_Q:
        return None
    top = square_of_norm(size, highest, least).sqrt()
    mean = square_of_norm(size, growth / (steps + 1), least)
    square = sum((x * x * slack for x in last), flint.arb(0))
    end = square_of_norm(size, square, least).sqrt() if last else top
    return MatrixGrowth(steps, least, rate, top, (steps * (steps + 1) * mean).sqrt(), end)


def follow(
    sections: Iterable[MatrixGrowth], first: Ball, source: Ball, second: Ball | None = None
) -> tuple[Ball, Ball]:
    """Return bounds of all ‖y_k‖, and of their sum, for y_{k+1} = A_k y_k + s_k.

    `sections`: the matrices of each section, which begin with 1. `first`: ‖y_0‖. All ‖s_k‖ are at
    most `source`, and with `second`, B, at most `source` + ½ B ‖y_k‖², as long as ‖y_k‖ is at most
    twice the bound without it. The bounds are not finite if that is not shown to hold.
    """
    top = total = flint.arb(0)
    for motion in sections:
        # With y_k = M_k x_k this bounds all ‖x_k‖ of the section.
        share = motion.rate.exp() * motion.path / motion.least
        growth = motion.rate.exp() * first + share * source
        if second is not None:
            limit = 2 * motion.top * growth
            growth += share * second * limit * limit / 2
            # The bootstrap: with E* in the quadratic term the bound must stay within E*.
            if not motion.top * growth <= limit:
                return flint.arb.nan(), flint.arb.nan()
        top, total = top.max(motion.top * growth), total + motion.path * growth
        first = (motion.end * growth).abs_upper()
    return top.abs_upper(), total.abs_upper()


def bound_product(notes: Sequence[Mapping[str, Fraction]], coordinates: Sequence[str]) -> Ball:
    """Return about the greatest norm of the products of matrices that began anew at each note."""
    product = top = flint.arb(1)
    for records in notes:
        top = top.max(product * rational_ball(records["growth_top"]).sqrt())
        squares = (rational_ball(records[name]) ** 2 for name in entries_of(coordinates))
        product *= sum(squares, flint.arb(0)).sqrt()
    return top.abs_upper()


def bound_matrix(
    motion: MatrixGrowth, error_sum: Ball, second: Ball, matrix_rounding: Ball
) -> Ball:
    """Return E, a bound of the error of each Ĵ_k; not finite if there is none."""
    # `growth` · (`displacement` + Q) is the bound Y of step 1, `error` the bound E of step 2 above.
    top, growth = motion.top, motion.rate.exp()
    displacement = 2 * top * top * second * error_sum / motion.least
    if not growth * (displacement + motion.rate) <= 1:
        return flint.arb.nan()
    error = top * growth * (displacement + motion.path * matrix_rounding / motion.least)
    return error if error <= top else flint.arb.nan()


def bound_matrix_in_sections(
    sections: Sequence[MatrixGrowth], top: Ball, slope: Ball, matrix_rounding: Ball
) -> Ball:
    """Return a bound of the error of each Ĵ_k where M began anew; not finite if there is none.

    `top`: a bound of Ĵ's entries over MOST; `slope`: one of ‖A(ẑ_k) − A(z_k)‖.
    """
    # As long as ‖J_k‖ ≤ 2 `top`, J_{k+1} = A(ẑ_k) J_k + s_k with ‖s_k‖ ≤ 2 `slope` `top`. If that
    # gives ‖J_{k+1}‖ ≤ 2 `top` again, it holds for all k. E_k obeys the same from 0, with ρ added.
    source = 2 * slope * top
    largest, _ = follow(sections, flint.arb(1), source)
    error, _ = follow(sections, flint.arb(0), source + matrix_rounding)
    return error if largest <= 2 * top and error <= top else flint.arb.nan()


def bound_total_defect(
    motion: MatrixGrowth,
    *,
    error_sum: Ball,
    second: Ball,
    size: Ball,
    slope: Ball,
    matrix_rounding: Ball,
    entry_rounding: Ball,
) -> Ball:
    """Return a bound of the error of each entry of W; not finite if there is none.

    `error_sum`: Σ ‖e_k‖. `second`: B. `size`, `slope`: bounds of S and of its gradient.
    `matrix_rounding`: a bound of the rounding of one step of Ĵ. `entry_rounding`: one of the
    rounding of one term of W and its addition.
    """
    top, error = motion.top, bound_matrix(motion, error_sum, second, matrix_rounding)
    terms = motion.steps * (2 * top + MOST * top) * size * error
    bound = terms + 4 * top * top * slope * error_sum + motion.steps * entry_rounding
    # Where the rounding was counted, the computed W was taken to be below 9 max ‖M‖².
    return bound.abs_upper() if bound <= 3 * top * top else flint.arb.nan()
