"""The bounds of a run by their formulas, worked out again with mpmath's numbers.

Every formula is written here as it stands in the docstrings of `verify.runs.a_posteriori_bound` and
`verify.runs.matrix_growth`, and shares no code with them. A bound that is loose says nothing by
holding the true value; it is held to its formula, term by term.
"""

import random
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import flint
from mpmath.ctx_mp import MPContext

from verify.arithmetic.arb import rational_ball
from verify.arithmetic.exact import of_mpf
from verify.arithmetic.flint_precision import working_precision

ctx = MPContext()
ctx.dps = 50
CLOSE = ctx.mpf(10) ** -20  # as near as a ball of 96 bits is to what it stands for
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
    steep: Callable[[Real], Real]  # the gradient of H
    energy: Callable[[Real], Real]  # the greatest |H|
    of_energy: Real
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


def of_energy_error(noted: Noted) -> Real:
    """Of H − H₀ at the end: H at the state as it is, and four times the last bits of 1 + |H|."""
    error, _ = of_state(noted)
    return noted.steep(error) * error + 4 * noted.unit * (1 + noted.energy(error))


# -- numbers to try them with ---------------------------------------------------------------------


def ball(x: Real) -> flint.arb:
    """The number as a ball, in the present precision."""
    return rational_ball(of_mpf(x))


def number(x: flint.arb) -> Real:
    """A ball's middle, to 40 digits."""
    with working_precision(200):
        return ctx.mpf(x.mid().str(40, radius=False))


def drawn(seed: int, size: int) -> Noted:
    """Sizes at which every term of every bound is a part of it that counts.

    The rounding of M's numbers, 2⁻⁴⁸, is seen at 20 digits; no other term is that small.
    """
    draw = random.Random(f"{seed} {size}")  # noqa: S311 - sizes, no secret

    def between(low: float, high: float) -> Real:
        return ctx.mpf(draw.uniform(low, high))

    n = draw.randint(1, 12)
    squares = between(1.1, 3) * size
    seen = {
        "growth_top": squares,
        "growth": between(1, n + 1) * squares,
        "det_low": between(0.7, 1),
        "form_top": between(1, 1.3) * size / 2,
        "least": -between(0.01, 0.5),
        "most": between(0.01, 0.5) * draw.choice([1, 3]),
    }
    rate = between(0.05, 0.2)
    m = grown(n, size, seen, rate * least(size, seen) / seen["growth"])
    tiny = ctx.mpf(10) ** -draw.randint(5, 7)
    start, state = tiny * between(0.2, 1), tiny * between(0.2, 1) * m.least / m.path
    linear = ctx.exp(m.rate) * (start + m.path / m.least * state)
    moved = 1 / (linear * m.path)  # about 1/Σ ‖e_k‖
    curved = between(0.1, 0.3) / (ctx.exp(m.rate) * m.path / m.least * 2 * m.top**2 * linear)
    steep, size_of_form, slope_of_form = between(0.02, 0.05), between(0.05, 0.1), between(0.05, 0.1)
    scale = ctx.ldexp(1, -draw.randint(0, 5))

    def wider(x: Real) -> Callable[[Real], Real]:
        """x, and more over a wider box."""
        return lambda margin: x * (1 + margin / (1000 * tiny * m.top))

    forms = wider(size_of_form / n), wider(slope_of_form * moved)
    return Noted(
        size=size, steps=n, seen=seen, start=start, state=state,
        delta_j=between(0.02, 0.05) / n / scale, tangent=rate * m.least / seen["growth"],
        largest=between(0.05, 0.2) / scale, defect=between(0.01, 0.1) * slope_of_form / scale,
        second=wider(curved), slope=wider(steep * moved / scale),
        form=lambda margin: (forms[0](margin), forms[1](margin)),
        of_matrix=between(0.02, 0.1) * m.least / m.path,
        of_entry=between(0.05, 0.2) * m.top**2 / n,
        steep=wider(between(0.02, 0.5) / tiny), energy=wider(between(1, 9)),
        of_energy=between(0.001, 0.02),
        squares=between(0.1, 0.5), scale=scale, unit=between(0.005, 0.02) / n,
        absolute=draw.random() < 0.5,
    )  # fmt: skip
