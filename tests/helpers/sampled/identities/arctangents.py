"""Sums of arctangents, of numbers and of functions."""

from fractions import Fraction
from math import atan, pi
from random import Random

from tests.helpers.sampled.identities.parts import Draw, positive


def _gaussian_sum(rng: Random) -> str:
    """Σ kᵢ atan xᵢ by the product of (1 + i xᵢ)^kᵢ, the multiple of π by their size."""
    parts = [
        (Fraction(rng.randint(1, 12), rng.randint(1, 30)), rng.choice((1, 1, 2, 3, -1, -2)))
        for _ in range(rng.randint(2, 4))
    ]
    return _summed(parts)


def _summed(parts: list[tuple[Fraction, int]]) -> str:
    real, imaginary = Fraction(1), Fraction(0)
    for x, k in parts:
        y = x if k > 0 else -x
        for _ in range(abs(k)):
            real, imaginary = real - imaginary * y, imaginary + real * y
    size = sum(k * atan(x) for x, k in parts)
    written = "+".join(f"({k})*atan({x})" for x, k in parts)
    if real == 0:
        return f"{written}-({Fraction(round(2 * size / pi))})*pi/2"
    rest = imaginary / real
    turns = round((size - atan(rest)) / pi)
    return f"{written}-atan({rest})-({turns})*pi"


def _machin(rng: Random) -> str:
    return rng.choice(
        (
            "4*atan(1/5)-atan(1/239)-pi/4",
            "atan(1/2)+atan(1/3)-pi/4",
            "2*atan(1/2)-atan(1/7)-pi/4",
            "2*atan(1/3)+atan(1/7)-pi/4",
            "12*atan(1/18)+8*atan(1/57)-5*atan(1/239)-pi/4",
            "44*atan(1/57)+7*atan(1/239)-12*atan(1/682)+24*atan(1/12943)-pi/4",
            "atan(2)+atan(3)-3*pi/4",
            "atan(1)+atan(2)+atan(3)-pi",
            "5*atan(1/7)+2*atan(3/79)-pi/4",
            "6*atan(1/8)+2*atan(1/57)+atan(1/239)-pi/4",
        )
    )


def _reciprocal(rng: Random) -> str:
    x = positive(rng)
    return rng.choice((f"atan({x})+atan(1/{x})-pi/2", f"atan(-{x})+atan(-1/{x})+pi/2"))


def _difference(rng: Random) -> str:
    x, y = positive(rng), positive(rng)
    return f"atan({x})-atan({y})-atan(({x}-{y})/(1+{x}*{y}))"


def _known_function(rng: Random) -> str:
    return rng.choice(
        (
            "atan(sinh(q))-2*atan(tanh(q/2))",
            "atan(q)-2*atan(q/(1+sqrt(1+q**2)))",
            "atan(exp(q))-pi/4-atan(tanh(q/2))",
            "2*atan(exp(q))-pi/2-atan(sinh(q))",
            "atan(sqrt(q))+atan(1/sqrt(q))-pi/2",
            "sin(2*atan(q))-2*q/(1+q**2)",
            "cos(atan(p))-1/sqrt(1+p**2)",
            "tan(atan(q)+pi/4)*(1-q)-1-q",
            "atan(log(2))+atan(1/log(2))-pi/2",
        )
    )


def _surd(rng: Random) -> str:
    c = rng.choice((2, 3, 5, 6, 7))
    return rng.choice(
        (
            f"atan(sqrt({c}))+atan(1/sqrt({c}))-pi/2",
            "atan(sqrt(2)-1)-pi/8",
            f"2*atan(sqrt({c})+sqrt({c + 1}))-pi/2-atan(sqrt({c}))",
        )
    )


DRAWS: tuple[Draw, ...] = (
    _gaussian_sum,
    _machin,
    _reciprocal,
    _difference,
    _known_function,
    _surd,
)
