"""Rigorous bounds of products of matrices that were carried in wide numbers.

Let M̂_{k+1} = A_k M̂_k + δ_k be what was carried, A_k the matrix that it stands for, M_k the exact
product, E_k = M̂_k − M_k, all norms Frobenius', and ‖δ_k‖ ≤ δ: what rounding a product of rows and
columns makes, and what A_k was off. Then E_{k+1} = A_k E_k + δ_k, and with Φ = M_{k+1} M_{i+1}⁻¹

    E_{k+1} = δ_k + Σ_{i<k} Φ δ_i.

From M_iᵀΩM_i = Ω + W_i it follows that M_i⁻¹ = (Ω + W_i)⁻¹ M_iᵀΩ, so that ‖M_i⁻¹‖ ≤ ‖M_i‖/(1 − ω)
where all ‖W_i‖ ≤ ω < 1. With μ ≥ ‖M̂_k‖ for all k, and as long as ‖E_i‖ ≤ E for i ≤ k,

    ‖E_{k+1}‖ ≤ (μ + ‖E_{k+1}‖) R,   R = N (μ + E) δ/(1 − ω),

since μ ≥ 1. So ‖E_k‖ ≤ μR/(1 − R) for all k by induction, where that is at most the E that R was
taken with and R < 1. What is read of M̂ is W = M̂ᵀΩM̂ − Ω, exactly, and so within 2μE + E²; a sum
of M̂ᵀSM̂ over N steps is within N times ‖S‖ of that, and the rounding of its terms and of itself. μ
and ω are noted in float64 at every step, M̂ rounded to it. Where W is not below 1, as in chaos,
there is no bound of this kind, and a rerun estimates one.
"""

from collections.abc import Mapping
from fractions import Fraction

import flint

from verify.arithmetic.arb import bounds, is_representable, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.kernels.rounding import PRECISION, Ball
from verify.runs.derivatives import norm
from verify.studies.separation.stepper.way import SteppedRun

_FLOAT = flint.arb(2) ** -45  # of sums of squares in float64, relative
_ENTRY = flint.arb(2) ** -44  # of an entry of MᵀΩM in float64, relative to ‖M‖²


def bound_entries(run: SteppedRun) -> Mapping[str, Fraction | None]:
    """Return bounds of the error of every entry of W at every checkpoint; None where there is none.

    There is one for everything that was followed except the clock.
    """
    with working_precision(PRECISION):
        count = _Count(run)
        errors = {"factors": count.bound_product("factors", flint.arb(0), count.top("f_j_norm"))}
        if "trajectory" in run.kernel.followed:
            size, lost = count.bound_slopes()
            errors["trajectory"] = count.bound_product("trajectory", lost, 1 + size)
        if run.kernel.closed:
            errors["closed"] = count.bound_sum()
        return {n: bounds(x)[1] if is_representable(x) else None for n, x in errors.items()}


class _Count:
    """A count of the rounding of products of matrices, by the norms that a run has noted."""

    def __init__(self, run: SteppedRun) -> None:
        self.run, self.steps, self.size = run, run.steps, len(run.kernel.wide.coordinates)
        # 2n products, their sum, and its sum with M: twice half a unit each, and second order.
        self.unit = (self.size + 3) * flint.arb(2) ** (1 - run.arithmetic.bits)

    def top(self, name: str) -> Ball:
        """Return the root of a greatest sum of squares."""
        return (rational_ball(Fraction(self.run.last[name])) * (1 + _FLOAT)).sqrt().abs_upper()

    def norm_of(self, matrix: str) -> Ball:
        least = flint.arb(self.size).sqrt()  # of M₀ = 1
        return self.top(f"f_{matrix}_norm").max(least)

    def bound_error(self, matrix: str, lost: Ball, factor: Ball) -> Ball:
        """Return E; `lost` is the error of A, `factor` a bound of ‖A‖, or of 1 + ‖A − 1‖."""
        top = self.norm_of(matrix)
        # An entry of δ is a rounded sum of products of |A| and |M̂|; what A is off is times M̂.
        rounding = top * (lost + self.unit * (factor + lost))
        form = self.top(f"f_{matrix}_form") + self.size * _ENTRY * top * top

        def bound(error: Ball) -> Ball:
            defect = form + 2 * top * error + error * error
            rate = self.steps * (top + error) * rounding / (1 - defect)
            return top * rate / (1 - rate) if defect < 1 and rate < 1 else flint.arb.nan()

        # E is a fixed point: where the bound taken with the guess is at most the guess, it holds.
        guess = (2 * bound(flint.arb(0))).abs_upper()
        again = bound(guess)
        return again.abs_upper() if again <= guess else flint.arb.nan()

    def bound_product(self, matrix: str, lost: Ball, factor: Ball) -> Ball:
        """Return a bound of the error of W = MᵀΩM − Ω."""
        top, error = self.norm_of(matrix), self.bound_error(matrix, lost, factor)
        return (2 * top * error + error * error).abs_upper()

    def bound_sum(self) -> Ball:
        """Return a bound of the error of Σ MᵀSM, with float64's S and K."""
        top, size = self.norm_of("m"), self.top("f_s_norm")
        error = self.bound_error("m", flint.arb(0), 1 + self.top("f_k_norm"))
        term = size * (top + error) * (top + error)
        # Two products of matrices are rounded, and the sum at every step.
        rounding = (2 * self.unit + self.steps * self.unit) * 2 * term
        return (self.steps * (size * (2 * top * error + error * error) + rounding)).abs_upper()

    def bound_slopes(self) -> tuple[Ball, Ball]:
        """Return ‖K‖ over the region that the float64 states visited, and the wide K's error."""
        slopes = self.run.kernel.wide.slopes
        values = self.run.analyse_values([index for row in slopes for index in row], flint.arb(0))
        if values is None:
            return flint.arb.nan(), flint.arb.nan()
        return norm(x.magnitude for x in values), norm(x.error for x in values)
