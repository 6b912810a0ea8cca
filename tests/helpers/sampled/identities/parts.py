"""What identities are made of: arguments, turns, functions that are positive, and numbers."""

from collections.abc import Callable
from fractions import Fraction
from random import Random

Draw = Callable[[Random], str]


def angle(rng: Random) -> str:
    """An argument of a sine."""
    return rng.choice(
        ("q", "p", "2*q", "q/2", "p+q", "p*q", "q**2/3", "delta*q", "exp(q)", "3*p-q")
    )


def turn(rng: Random) -> str:
    n = rng.choice((3, 4, 5, 6, 7, 8, 9, 10, 12, 15, 16, 24))
    return f"{rng.randint(1, 2 * n)}*pi/{n}"


def positive(rng: Random) -> str:
    """A function that is positive everywhere."""
    a, b = rng.randint(1, 9), rng.randint(1, 9)
    return rng.choice(
        (
            f"({a}+{b}*q**2)",
            f"({a}+p**2)",
            f"({a}+{b}*p**2*q**2)",
            f"(q**2+q+{a})",
            f"({a}+exp(q))",
            f"cosh({a}*q)",
            f"(p**2+q**2+{a})",
            f"sqrt({a}+{b}*q**2)",
            f"exp({a}*q)",
        )
    )


def fraction(rng: Random, most: int = 60) -> Fraction:
    return Fraction(rng.randint(1, most), rng.randint(1, most))


def share(rng: Random) -> Fraction:
    return Fraction(rng.choice((1, 2, 3, -1, -2, 5)), rng.choice((1, 1, 2, 3, 4)))
