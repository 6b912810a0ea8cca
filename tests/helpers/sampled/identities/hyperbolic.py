"""Hyperbolic functions and exponentials of logarithms."""

from fractions import Fraction
from random import Random

from tests.helpers.sampled.identities.parts import Draw, fraction, positive


def _hyperbolic_number(rng: Random) -> str:
    a, r = (
        fraction(rng, 20),
        rng.choice((Fraction(1), Fraction(2), Fraction(1, 2), Fraction(3, 2))),
    )
    up, down = f"({a})**({r})", f"({a})**({-r})"
    return rng.choice(
        (
            f"cosh({r}*log({a}))-({up}+{down})/2",
            f"sinh({r}*log({a}))-({up}-{down})/2",
            f"tanh({r}*log({a})+0)*({up}+{down})-{up}+{down}",
        )
    )


def _hyperbolic_function(rng: Random) -> str:
    u, n = positive(rng), rng.randint(1, 3)
    return rng.choice(
        (
            f"2*cosh({n}*log({u}))-{u}**{n}-1/{u}**{n}",
            f"2*sinh({n}*log({u})+q)-{u}**{n}*exp(q)+exp(-q)/{u}**{n}",
            f"tanh(log({u})/2)-({u}-1)/({u}+1)",
        )
    )


def _shifted(rng: Random) -> str:
    a = rng.randint(2, 9)
    up, down = Fraction(a * a + 1, 2 * a), Fraction(a * a - 1, 2 * a)
    x = rng.choice(("q", "p*q", "2*p"))
    return f"sinh({x}+log({a}))-{up}*sinh({x})-{down}*cosh({x})"


def _exponential(rng: Random) -> str:
    a, n, x = rng.randint(2, 9), rng.randint(2, 4), rng.choice(("q", "p*q", "pi", "q**2"))
    return rng.choice(
        (
            f"exp({x}*log({a**n}))-exp({n}*{x}*log({a}))",
            f"exp({x}+{n}*log({a}))-{a**n}*exp({x})",
            f"exp({x}*log({a}))*exp({x}*log({n}))-exp({x}*log({a * n}))",
            f"exp(log({a})/{n})**{n}-{a}",
        )
    )


def _exact_tangent(rng: Random) -> str:
    a = fraction(rng, 30)
    value = (a**2 - 1) / (a**2 + 1)
    return f"tanh(log({a}))-({value})"


DRAWS: tuple[Draw, ...] = (
    _hyperbolic_number,
    _hyperbolic_function,
    _shifted,
    _exponential,
    _exact_tangent,
)
