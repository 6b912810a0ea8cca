"""The links of W in n degrees of freedom, which is made of products of matrices.

W_N = MᵀΩM − Ω, M the product of N steps' Jacobians, is to n degrees what Λ is to one. Each of its
n (2n − 1) entries above the diagonal has a chain (`verify.studies.separation.chain`) of its own:

    W₀  exact arithmetic at the exact inputs
    W₁  exact arithmetic at the inputs rounded to float64
    W₂  the states that float64 steps to, bit by bit; the Jacobians at them and W exactly
    W₃  the Jacobians, or S, as float64 computes them, bit by bit; their products and W exactly
    W₄  products and W in float64 too, `w_working`

    W₄ = W₀ + (W₁ − W₀) + (W₂ − W₁) + (W₃ − W₂) + (W₄ − W₃)
       = truncation + input + trajectory + derivatives + product,

an equation of rationals, entry by entry. `verify.studies.separation.matrix_lines` lists the
matrices that the kernel carries. W = MᵀΩM − Ω of a wide M is computed in rationals, that of
float64's M in float64: each entry is a sum of 2n products from the left, p's row first, less 1
where Ω has 1.

The rounding of a wide link is counted, except for that of a clock. Let M̂_k be the matrix that was
carried, M̂_{k+1} = A_k M̂_k + δ_k with the exact A_k, M_k the exact product, E_k = M̂_k − M_k, all
norms Frobenius', and ‖δ_k‖ ≤ δ: the rounding of a product of rows and columns, and the error of the
computed A_k. Then E_{k+1} = A_k E_k + δ_k, and with Φ = M_{k+1} M_{i+1}⁻¹

    E_{k+1} = δ_k + Σ_{i<k} Φ δ_i.

From M_iᵀΩM_i = Ω + W_i it follows that M_i⁻¹ = (Ω + W_i)⁻¹ M_iᵀΩ, so that ‖M_i⁻¹‖ ≤ ‖M_i‖/(1 − ω)
where all ‖W_i‖ ≤ ω < 1. With μ ≥ ‖M̂_k‖ for all k, and as long as ‖E_i‖ ≤ E for i ≤ k,

    ‖E_{k+1}‖ ≤ (μ + ‖E_{k+1}‖) R,   R = N (μ + E) δ/(1 − ω),

since μ ≥ 1. So ‖E_k‖ ≤ μR/(1 − R) for all k by induction, if R < 1 and that is at most the E that R
was computed with. W = M̂ᵀΩM̂ − Ω is computed from M̂ exactly, and so is within 2μE + E² of the exact
product's. A sum of M̂ᵀSM̂ over N steps is within N ‖S‖ (2μE + E²) and the rounding of its terms and
of its additions. The kernel keeps μ and ω as maxima over all steps, in float64, of M̂ rounded to
float64. If ‖W‖ is not below 1, as in chaos, there is no bound of this kind, and a rerun estimates
one.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from typing import Any, ClassVar

import flint

from verify.arithmetic.arb import bounds, is_representable, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number_system import Arithmetic, UnsupportedError
from verify.kernels.chunked_loop import W_ENTRIES
from verify.kernels.rounding import PRECISION_BITS, Ball
from verify.kernels.step.computation import Computation, StepRequest, computation_of, step_map_of
from verify.kernels.stepping import KernelRun, RunOutcome
from verify.observables.observable import Need
from verify.runs.step_bounds import norm
from verify.scenes.results.separation import SeparationInDegrees
from verify.scenes.results.separation_parts import FormParts
from verify.schemes.maps.step_map import StepMap
from verify.studies.separation.chain import Entries, Links, exact_links
from verify.studies.separation.matrix_lines import matrix_lines
from verify.studies.separation.mixed_run import marks_of
from verify.studies.separation.way import KernelLines, Side, Size, State, SteppedRun, Way

POINTS = 512  # checkpoints of a run; each has a matrix for each link
# Bounds of float64's rounding, relative to a sum of squares, and of MᵀΩM's entries to ‖M‖².
_SQUARES_ROUNDING = flint.arb(2) ** -45
_ENTRY_ROUNDING = flint.arb(2) ** -44


@dataclass(frozen=True)
class Matrices(Way):
    """W = MᵀΩM − Ω of a run."""

    result: ClassVar = SeparationInDegrees
    observable: ClassVar = "symplectic_defect"
    observables: ClassVar = frozenset({"symplectic_defect", W_ENTRIES})
    points: ClassVar = POINTS
    parts: ClassVar = FormParts.rounding
    cancelled: ClassVar = 20
    products: ClassVar = 20
    hidden: ClassVar = 25
    vanishes: ClassVar = "S ≡ 0"

    # -- the kernel ---------------------------------------------------------------------------

    def step(self, step_map: StepMap, arithmetic: Arithmetic, exactly: bool) -> Computation:
        """Return the computation with K, and in float64 with S, M and W."""
        if exactly and arithmetic.absolute:
            raise UnsupportedError(f"{arithmetic.name} follows no matrices")
        form = not (exactly or step_map.preserves_area)
        needs: frozenset[Need] = frozenset({"symplectic", "carried"} if form else ())
        request = StepRequest(
            pipelined=arithmetic.pipelined, scaled=False, tangent=False, needs=needs, slopes=True
        )
        return computation_of(step_map, request)

    def lines(self, narrow: Side, wide: Side | None, clocked: Side | None) -> KernelLines:
        return matrix_lines(narrow, wide, clocked)

    # -- reading its states -------------------------------------------------------------------

    def read(self, state: State, name: str, arithmetic: Arithmetic) -> Entries:
        if name == "closed":
            return tuple(arithmetic.exact(x) for x in self._above(state, "w_closed"))
        matrix, scale = self._whole_matrix(state, name, arithmetic)
        entries = entries_of_defect(lambda a, b: matrix[a][b], self.count, scale * scale)
        return tuple(Fraction(x, scale * scale) for x in entries)

    def plain(self, state: State) -> tuple[float, ...]:
        return entries_of_defect(lambda a, b: state[f"f_plain_{a}_{b}"], self.count)

    def closed_form(self, state: State) -> tuple[float, ...]:
        return self._above(state, "f_closed")

    def in_range(self, state: State) -> bool:
        norm = math.hypot(*(x for row in self._matrix(state, "f_plain") for x in row))
        return all(map(math.isfinite, (*self.plain(state), norm)))

    def size(self, state: State, arithmetic: Arithmetic) -> Size:
        return compute_size(*self._whole_matrix(state, "factors", arithmetic))

    def _matrix(self, state: State, name: str) -> list[list[Any]]:
        every = range(self.count)
        return [[state[f"{name}_{a}_{b}"] for b in every] for a in every]

    def _above(self, state: State, name: str) -> tuple[Any, ...]:
        """Return the entries above the diagonal, row by row."""
        return tuple(state[f"{name}_{a}_{b}"] for a, b in combinations(range(self.count), 2))

    def _whole_matrix(
        self, state: State, name: str, arithmetic: Arithmetic
    ) -> tuple[list[list[int]], int]:
        """Return a wide matrix as whole numbers, and the denominator that all share.

        Fractions would be slow.
        """
        rationals = [[arithmetic.exact(x) for x in row] for row in self._matrix(state, f"w_{name}")]
        # Denominators are powers of 2, so that the greatest is a multiple of all.
        scale = max(x.denominator for row in rationals for x in row)
        return [[x.numerator * (scale // x.denominator) for x in row] for row in rationals], scale

    # -- error bounds -------------------------------------------------------------------------

    def bounds(self, run: SteppedRun) -> Mapping[str, Fraction | None]:
        return bound_entries(run)

    def hidden_size(self, run: SteppedRun, name: str) -> Fraction:
        names = [n for n in run.last if n.startswith(f"w_{name}_")]
        size = Fraction(max(abs(float(state[n])) for state in run.states for n in names))
        return (1 + size * size) * Fraction(1, 1 << (run.arithmetic.bits - 4))

    # -- runs in exact arithmetic's stead -----------------------------------------------------

    def prove_links(self, run: KernelRun, step_map: StepMap | None, digits: int) -> Links | None:
        """Return links of 0 where S ≡ 0 whatever the parameters are, else None."""
        if not step_map_of(run.hamiltonian, run.scheme).preserves_area:
            return None
        nothing = (Fraction(0),) * (self.count * (self.count - 1) // 2)
        return exact_links([nothing] * len(marks_of(run.steps, POINTS)), self.vanishes)

    def values(self, run: RunOutcome, last: Fraction) -> list[Entries]:
        names = [n for n in run.tangents[0] if n.startswith("w_")]
        return [tuple(note[n] for n in names) for note in run.tangents]


def entries_of_defect(
    entry: Callable[[int, int], Any], size: int, scale: int = 1
) -> tuple[Any, ...]:
    """Return the entries of MᵀΩM − Ω above the diagonal, row by row, in the entries' arithmetic.

    M comes multiplied by the root of `scale`, and the entries are multiplied by `scale`.
    """
    n, entries = size // 2, []
    for a, b in combinations(range(size), 2):
        total = entry(0, a) * entry(n, b) - entry(n, a) * entry(0, b)
        for i in range(1, n):
            total = total + entry(i, a) * entry(n + i, b)
            total = total - entry(n + i, a) * entry(i, b)
        entries.append(total - scale if b == n + a else total)
    return tuple(entries)


def compute_size(matrix: Sequence[Sequence[int]], scale: int) -> Size:
    """Return the sizes of `matrix`/`scale`: ‖∧²M‖² = (‖M‖⁴ − ‖MᵀM‖²)/2."""
    columns, indices = list(zip(*matrix, strict=True)), range(len(matrix))
    square = {
        (a, b): sum(x * y for x, y in zip(columns[a], columns[b], strict=True))
        for a in indices
        for b in range(a, len(matrix))
    }
    norm = sum(square[a, a] for a in indices)
    # MᵀM is symmetric: entries off the diagonal count twice in its norm.
    norm_of_square = sum((1 if a == b else 2) * x * x for (a, b), x in square.items())
    return Size(Fraction(norm, scale**2), Fraction(norm * norm - norm_of_square, 2 * scale**4))


def bound_entries(run: SteppedRun) -> Mapping[str, Fraction | None]:
    """Return bounds of the error of every entry of W at every checkpoint; None if there is none.

    There is one for everything that was followed except the clock.
    """
    with working_precision(PRECISION_BITS):
        count = _RoundingCount(run)
        errors = {"factors": count.bound_product("factors", flint.arb(0), count.top("f_j_norm"))}
        if "trajectory" in run.kernel.followed:
            size, lost = count.bound_slopes()
            errors["trajectory"] = count.bound_product("trajectory", lost, 1 + size)
        if run.kernel.closed:
            errors["closed"] = count.bound_sum()
        return {n: bounds(x)[1] if is_representable(x) else None for n, x in errors.items()}


class _RoundingCount:
    """A count of the rounding of products of matrices, by the norms that a run has noted."""

    def __init__(self, run: SteppedRun) -> None:
        self.run, self.steps, self.size = run, run.steps, len(run.kernel.wide.coordinates)
        # 2n products, their sum, and its sum with M: twice half a unit each, and second order.
        self.unit = (self.size + 3) * flint.arb(2) ** (1 - run.arithmetic.bits)

    def top(self, name: str) -> Ball:
        """Return the root of a greatest sum of squares."""
        return (
            (rational_ball(Fraction(self.run.last[name])) * (1 + _SQUARES_ROUNDING))
            .sqrt()
            .abs_upper()
        )

    def norm_of(self, matrix: str) -> Ball:
        least = flint.arb(self.size).sqrt()  # ‖M₀‖, M₀ = 1, which the maxima leave out
        return self.top(f"f_{matrix}_norm").max(least)

    def bound_error(self, matrix: str, lost: Ball, factor: Ball) -> Ball:
        """Return E; `lost` bounds the error of A, `factor` bounds ‖A‖, or is 1 + ‖A − 1‖."""
        top = self.norm_of(matrix)
        # δ: the rounding of sums of products of |A| and |M̂|, and the error of A times M̂.
        rounding = top * (lost + self.unit * (factor + lost))
        form = self.top(f"f_{matrix}_form") + self.size * _ENTRY_ROUNDING * top * top

        def bound(error: Ball) -> Ball:
            defect = form + 2 * top * error + error * error
            rate = self.steps * (top + error) * rounding / (1 - defect)
            return top * rate / (1 - rate) if defect < 1 and rate < 1 else flint.arb.nan()

        # If the bound computed with the guess is at most the guess, it holds (the induction).
        guess = (2 * bound(flint.arb(0))).abs_upper()
        bound_of_guess = bound(guess)
        return bound_of_guess.abs_upper() if bound_of_guess <= guess else flint.arb.nan()

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
