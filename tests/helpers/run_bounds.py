"""The bounds of a run by their formulas, worked out again with mpmath's numbers.

Every formula is written here as it stands in the docstrings of `verify.runs.a_posteriori`,
`verify.runs.form_bound` and `verify.runs.inverse_norm`, and shares no code with them. A bound that
is loose says nothing by holding the true value; it is held to its formula, term by term.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from mpmath.ctx_mp import MPContext

ctx = MPContext()
ctx.dps = 50
Real = Any


@dataclass(frozen=True)
class Noted:
    """What a run has noted, and what a step loses: numbers of mpmath's, all of them.

    `second`: B over the box that is widened by so much. `slope`: of 2^s ΔJ over that box.
    """

    size: int
    steps: int
    seen: Mapping[str, Real]
    start: Real
    state: Real
    delta_j: Real
    tangent: Real
    largest: Real  # of |2^s ΔJ|
    defect: Real
    second: Callable[[Real], Real]
    slope: Callable[[Real], Real]
    form: Callable[[Real], tuple[Real, Real]]
    of_matrix: Real
    of_entry: Real
    squares: Real  # the mean of ΔJ²
    scale: Real  # 2^−s
    unit: Real
    absolute: bool

    @property
    def grown(self) -> "Grown":
        """How M has grown."""
        return grown(self.steps, self.size, self.seen, self.tangent)


def least(size: int, seen: Mapping[str, Real]) -> Real:
    """d with ‖M‖/‖M⁻¹‖ ≥ d."""
    rounded = ctx.ldexp(1, -48)
    lost = rounded * seen["growth_top"]
    if size == 2:
        return seen["det_low"] - lost
    n = size // 2
    entry = ctx.sqrt(seen["form_top"]) * (1 + rounded)
    products = {2: 3, 3: 15, 4: 105}[n]
    off = (entry + lost) ** n - entry**n + rounded * n * (entry + lost) ** n
    return (seen["det_low"] - products * off) / (entry + size * lost) ** (n - 1)


@dataclass(frozen=True)
class Grown:
    """d, Q, max ‖M‖ and S."""

    least: Real
    rate: Real
    top: Real
    path: Real


def grown(n: int, size: int, seen: Mapping[str, Real], tangent: Real) -> Grown:
    """How M has grown in n steps, of which each loses `tangent` of it."""
    slack = 1 + (n + size - 2) * ctx.ldexp(1, -50)
    d, total = least(size, seen), seen["growth"] * slack

    def square(y: Real) -> Real:
        return y if size > 2 else (y + ctx.sqrt(abs(y * y - 4 * d * d))) / 2

    return Grown(
        d,
        tangent * total / d,
        ctx.sqrt(square(seen["growth_top"] * slack)),
        ctx.sqrt(n * (n + 1) * square(total / (n + 1))),
    )


def of_state(noted: Noted) -> tuple[Real, Real]:
    """max ‖e_k‖ and Σ ‖e_k‖."""
    m = noted.grown
    linear = ctx.exp(m.rate) * (noted.start + m.path / m.least * noted.state)
    reach = 2 * m.top * linear
    curved = ctx.exp(m.rate) * m.path / m.least * noted.second(reach) * reach**2 / 2
    assert m.top * (linear + curved) <= reach
    return m.top * (linear + curved), (linear + curved) * m.path


def of_delta_j_max(noted: Noted) -> Real:
    error, _ = of_state(noted)
    return noted.scale * (noted.slope(error) * error + noted.delta_j)


def of_mse(noted: Noted) -> Real:
    """Of (1/N) Σ ΔJ²: |x² − y²| ≤ |x − y| (|x| + |y|), and the rounding of the sum."""
    error, total = of_state(noted)
    moved = noted.slope(error) * total + noted.steps * noted.delta_j
    largest = noted.largest + noted.slope(error) * error
    added = noted.unit
    if not noted.absolute:
        added = 2 * noted.unit * (noted.squares * noted.steps / noted.scale**2 + largest**2)
    return noted.scale**2 * (2 * largest * moved / noted.steps + added)


def of_lambda(noted: Noted) -> Real:
    """Of Π (1 + ΔJ) − 1."""
    error, total = of_state(noted)
    low, high = noted.seen["least"], noted.seen["most"]
    moved = noted.scale * (noted.slope(error) * total + noted.steps * noted.delta_j)
    jump = noted.scale * (noted.largest + noted.slope(error) * error)
    if noted.absolute:
        rounded = noted.unit * (1 + noted.scale)
    else:
        size = max(abs(low), abs(high))
        rounded = noted.unit * (1 + noted.unit) * (size + 2 * jump * (1 + size))
    drift = noted.steps * rounded / (1 + low)
    shifted = ctx.expm1(moved / (1 - jump)) * ctx.exp(drift) * (1 + high)
    apart = ctx.expm1(drift) * (1 + high)
    if noted.absolute:
        return shifted + noted.steps * (jump * apart + noted.scale * noted.unit)
    return shifted + apart


def of_defect_max(noted: Noted) -> Real:
    """Of an entry of S."""
    error, _ = of_state(noted)
    return noted.form(error)[1] * error + noted.scale * noted.defect


def of_defect(noted: Noted) -> Real:
    """Of an entry of W."""
    m = noted.grown
    error, total = of_state(noted)
    size, slope = noted.form(error)
    moved = 2 * m.top**2 * noted.second(error) * total / m.least
    assert ctx.exp(m.rate) * (moved + m.rate) <= 1
    matrix = m.top * ctx.exp(m.rate) * (moved + m.path * noted.of_matrix / m.least)
    assert matrix <= m.top
    return (
        noted.steps * 5 * m.top * size * matrix
        + 4 * m.top**2 * slope * total
        + noted.steps * noted.of_entry
    )
