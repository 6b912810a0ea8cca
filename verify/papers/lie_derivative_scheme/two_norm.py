"""L_p = ‖J_k‖₂: wrong as the L of Eq. 9, right as the Lipschitz constant of the step itself."""

from fractions import Fraction

import sympy

from verify.algebra.symbols import P, Q
from verify.arithmetic.exact import decimal, text
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.papers.argument import NUMBERS, Argument, ArgumentTexts, Check, same
from verify.papers.elementary_identities import stretching
from verify.papers.exact_maps import RationalPoint, jacobian, next_point, squared_distance
from verify.papers.lie_derivative_scheme.examples import duffing_step, with_symbols
from verify.papers.lie_derivative_scheme.lipschitz import PAIR

_TEXTS = ArgumentTexts(__file__)

_EDGE = Fraction(2, 3)  # of |δ|q²
STRETCHED = RationalPoint(p=Fraction(0), q=Fraction(2))
_BESIDE = ((1, 10), (1, 2), (80, 100), (83, 100), (3, 2))  # q, on both sides of √(2/3)
_STRETCHES = {"duffing": "3*delta*q**2/2", "pendulum": "(1 - cos(q))/2"}


def two_norm(point: RationalPoint = STRETCHED, h: Fraction = Fraction(1, 10)) -> Argument:
    """Refute L_p = ‖J_k‖₂ in Eq. 9, at a point where ‖J‖₂ > 1 + h ‖J‖₂ holds exactly."""
    a, b, c, d = jacobian(duffing_step(), point, h)
    # With |Jv| ≤ ‖J‖₂ |v| for v = (1, −1), ‖J‖₂ (1 − h) > 1 follows from |Jv|² (1 − h)² > |v|².
    stretch = ((a - b) ** 2 + (c - d) ** 2) / 2
    exceeds = Check(
        f"Duffing, δ = 1, lie2, h = {text(h)}, (p, q) = {point}: ‖J v‖²/‖v‖² for v = (1, −1), "
        "times (1 − h)², exceeds 1",
        stretch * (1 - h) ** 2 > 1,
        text(stretch * (1 - h) ** 2),
        NUMBERS,
    )
    return _TEXTS.refutation(
        "two_norm",
        exceeds=exceeds,
        stretching=stretching(),
        stretch_of=[_stretch_of(name) for name in _STRETCHES],
        is_a_factor=[_is_a_factor(Fraction(*q)) for q in _BESIDE],
        point=str(point),
        h=text(h),
        size=text(stretch * (1 - h) ** 2),
    )


def _is_a_factor(q: Fraction, h: Fraction = Fraction(1, 100), edge: Fraction = _EDGE) -> Check:
    """Check that ‖J‖₂ ≤ 1 + h‖J‖₂ for Duffing, δ = 1, at p = 0 exactly where q² < `edge`."""
    a, b, c, d = jacobian(duffing_step(), RationalPoint(Fraction(0), q), h)
    # ‖J‖₂² is the greater zero of x² − (tr JᵀJ) x + (det J)², so that no root is needed.
    trace, square = a * a + b * b + c * c + d * d, (a * d - b * c) ** 2
    limit = 1 / (1 - h) ** 2  # what the greater zero of x² − trace x + square may be at most
    holds = limit**2 - trace * limit + square >= 0 and 2 * limit >= trace
    return Check(
        f"Duffing, δ = 1, lie2, h = {text(h)}, (p, q) = (0, `{text(q)}`): ‖J‖₂ ≤ 1 + h‖J‖₂, if and "
        "only if q² < 2/3",
        holds is (q * q < edge),
        "it holds" if holds else "it does not hold",
        NUMBERS,
    )


def _stretch_of(name: str, stretch: str = "") -> Check:
    """Check s² of the system, all parameters symbols; `stretch` is used in place of s."""
    energy = with_symbols(name).expression
    s = Hamiltonian.parse(stretch or _STRETCHES[name]).expression
    pp, pq, qq = (sympy.diff(energy, *by) for by in ((P, P), (P, Q), (Q, Q)))
    gap = s**2 - (pq**2 + (pp - qq) ** 2 / 4)
    return same(f"{name}: s² for s = `{stretch or _STRETCHES[name]}`", [gap], ("p", "q", "delta"))


def two_norm_of_the_step(scale: Fraction = Fraction(1)) -> Argument:
    """Prove that ‖J‖₂ is the Lipschitz constant of the step itself; `scale` multiplies it.

    On the segment between two points |Φ(z̄) − Φ(z)|² ≤ max ‖J‖₂² |z̄ − z|².
    """
    h = Fraction(1, 10)
    step_map, ends = duffing_step(), PAIR
    images = [next_point(step_map, z, h) for z in ends]
    stretch = squared_distance(*images) / squared_distance(*ends)
    # The segment between the two points, on which the mean value theorem takes the maximum.
    between = [RationalPoint(Fraction(0), Fraction(k, 8)) for k in range(9)]
    norms = [_norm_squared(jacobian(step_map, z, h)) for z in between]
    example = Check(
        f"Duffing, δ = 1, lie2, h = {text(h)}: |Φ(z̄) − Φ(z)|²/|z̄ − z|² for (p, q) = "
        f"{ends[0]} and {ends[1]}, at most the greatest of 9 lower bounds of ‖J‖₂² between",
        stretch <= scale * max(norms),
        f"`{decimal(stretch, 4)}` ≤ `{decimal(scale * max(norms), 4)}`",
        NUMBERS,
    )
    return _TEXTS.proof("two_norm_of_the_step", example=example)


def _norm_squared(entries: tuple[Fraction, ...]) -> Fraction:
    """Return a lower bound of ‖J‖₂²: |J v|²/|v|² for the better of v = (0, 1) and (1, 0)."""
    a, b, c, d = entries
    return max(a * a + c * c, b * b + d * d)
