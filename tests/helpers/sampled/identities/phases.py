"""Sines and cosines of sums with parts of a turn."""

from fractions import Fraction
from random import Random

from tests.helpers.sampled.identities.parts import Draw, angle, turn


def _sum_formula(rng: Random) -> str:
    x, a = angle(rng), turn(rng)
    return f"sin({x}+{a})-sin({x})*cos({a})-cos({x})*sin({a})"


def _product_to_sum(rng: Random) -> str:
    x, y, a, b = angle(rng), angle(rng), turn(rng), turn(rng)
    left = f"2*sin({x}+{a})*cos({y}-{b})"
    return f"{left}-sin({x}+{y}+{a}-{b})-sin({x}-({y})+{a}+{b})"


def _phases_around(rng: Random) -> str:
    x, n = angle(rng), rng.randint(3, 12)
    return "+".join(f"cos({x}+2*{k}*pi/{n})" for k in range(n))


def _squares_around(rng: Random) -> str:
    x, n = angle(rng), rng.randint(3, 9)
    return "+".join(f"sin({x}+{k}*pi/{n})**2" for k in range(n)) + f"-{Fraction(n, 2)}"


def _product_around(rng: Random) -> str:
    x, n = rng.choice(("q", "p", "p+q")), rng.randint(2, 6)
    product = "*".join(f"sin({x}+{k}*pi/{n})" for k in range(n))
    return f"{2 ** (n - 1)}*{product}-sin({n}*({x}))"


def _one_wave(rng: Random) -> str:
    """a sin x + b cos x as one sine, for the angles whose sines are square roots."""
    x = angle(rng)
    cosine, sine, a = rng.choice(
        (
            ("1", "1", "sqrt(2)*sin({x}+pi/4)"),
            ("sqrt(3)", "1", "2*sin({x}+pi/6)"),
            ("1", "-sqrt(3)", "2*sin({x}-pi/3)"),
            ("(sqrt(6)+sqrt(2))", "(sqrt(6)-sqrt(2))", "4*sin({x}+pi/12)"),
            ("(1+sqrt(5))", "sqrt(10-2*sqrt(5))", "4*sin({x}+pi/5)"),
            ("sqrt(2+sqrt(2))", "sqrt(2-sqrt(2))", "2*sin({x}+pi/8)"),
            ("(sqrt(5)-1)", "-sqrt(10+2*sqrt(5))", "4*sin({x}-2*pi/5)"),
        )
    )
    return f"{cosine}*sin({x})+({sine})*cos({x})-{a.format(x=x)}"


def _half_angle(rng: Random) -> str:
    x, a = angle(rng), turn(rng)
    return f"2*cos({x}+{a})**2-1-cos(2*({x})+2*{a})"


def _tangent(rng: Random) -> str:
    x = rng.choice(("q", "p", "q/3"))
    return rng.choice(
        (
            f"tan({x}+pi/4)*(1-tan({x}))-1-tan({x})",
            f"tan({x})*tan({x}+pi/3)*tan({x}-pi/3)+tan(3*({x}))",
            f"tan({x}+pi/3)+tan({x}-pi/3)+tan({x})-3*tan(3*({x}))",
        )
    )


DRAWS: tuple[Draw, ...] = (
    _sum_formula,
    _product_to_sum,
    _phases_around,
    _squares_around,
    _product_around,
    _one_wave,
    _half_angle,
    _tangent,
)
