"""The chain Λ₀ … Λ₄ by brute force: rationals throughout, for polynomial H and a few steps.

Exact as long as they are short: the degree of a state grows like that of the map to the power N, so
that numbers beyond 4000 bits are rounded to so many, with an error below 2^−3000 in the end.

Shares with `verify` the float64 kernel alone, whose arithmetic is what is examined; its lines run
here as plain Python, one step at a time. ΔJ is plain sympy's.
"""

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import sympy

from tests.helpers.sampled.formulas import H, P, Q, lie_step, plain, plain_delta_j
from verify import arithmetic
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import kernel_for
from verify.studies.separation.determinants import WORKING

Point = dict[str, Fraction]
_BITS = 4000
Polynomial = Callable[[Fraction, Fraction, Fraction], Fraction]


def polynomial(expression: sympy.Expr) -> Polynomial:
    """An expression in p, q and h as a function of exact rationals."""
    terms = [
        (powers, Fraction(int(c.p), int(c.q)))
        for powers, c in sympy.Poly(expression, P, Q, H).terms()
    ]
    return lambda p, q, h: sum((c * p**i * q**j * h**k for (i, j, k), c in terms), Fraction(0))


def short(x: Fraction) -> Fraction:
    """x, or x rounded to 4000 bits."""
    excess = x.denominator.bit_length() - _BITS
    return x if excess <= 0 else Fraction(round(x * 2**_BITS), 2**_BITS)


def links(text: str, eta: int, start: Point, steps: int) -> dict[str, list[Fraction]]:
    """Λ₀ … Λ₄ of both ways after `steps` steps of lieη, exactly."""
    maps = lie_step(plain(text), eta)
    step, delta_j = [polynomial(x) for x in maps], polynomial(plain_delta_j(*maps))
    rounded = {name: Fraction(float(x)) for name, x in start.items()}

    def exactly(at: Point) -> Fraction:
        p, q, product = at["p"], at["q"], Fraction(1)
        for _ in range(steps):
            product = short(product * (1 + delta_j(p, q, at["h"])))
            p, q = (short(f(p, q, at["h"])) for f in step)
        return product - 1

    shared = [exactly(start), exactly(rounded)]
    third = fourth = fifth = Fraction(1)
    product, logarithms = 1.0, []
    for p, q, det, own in float64_steps(text, eta, start, steps):
        third = short(third * (1 + delta_j(Fraction(p), Fraction(q), rounded["h"])))
        fourth = short(fourth * Fraction(det))
        fifth = short(fifth * (1 + Fraction(own)))
        product *= det
        logarithms.append(math.log1p(own) if own > -1 else math.nan)
    return {
        "plain": [*shared, third - 1, fourth - 1, Fraction(product - 1.0)],
        # fsum, rounded once; the two-sum of the kernel is as good but for the last bits.
        "closed_form": [*shared, third - 1, fifth - 1, _expm1(math.fsum(logarithms))],
    }


def _expm1(x: float) -> Fraction:
    return Fraction(math.expm1(x)) if math.isfinite(x) else Fraction(0)


def float64_steps(
    text: str, eta: int, start: Point, steps: int
) -> list[tuple[float, float, float, float]]:
    """p, q, det J and ΔJ of every step as the float64 kernel finds them."""
    kernel = kernel_for(
        Hamiltonian.parse(text).with_symbols(), f"lie{eta}", arithmetic.get("float64", 17), WORKING
    )
    step: Any = kernel.function
    p, q, h = (float(start[name]) for name in "pqh")
    found = []
    for _ in range(steps):
        first = dict(zip(kernel.state_names, (p, q, *map(float, kernel.start)), strict=True))
        _, *after = step(1, h, *first.values())
        after = dict(zip(kernel.state_names, after, strict=True))
        found.append((p, q, after["plain"], after["lam"]))  # products of one factor each
        p, q = after["p"], after["q"]
    return found
