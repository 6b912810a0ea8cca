"""Logarithms of products, powers and units."""

from fractions import Fraction
from random import Random

from tests.helpers.sampled.identities.parts import Draw, fraction, positive, share


def _log_of_numbers(rng: Random) -> str:
    parts = [(fraction(rng), rng.choice((1, 2, 3, -1, -2))) for _ in range(rng.randint(2, 4))]
    product = Fraction(1)
    for x, n in parts:
        product *= x**n
    return f"log({product})" + "".join(f"-({n})*log({x})" for x, n in parts)


def _log_of_product(rng: Random) -> str:
    parts = [(positive(rng), share(rng)) for _ in range(rng.randint(2, 3))]
    product = "*".join(f"{x}**({r})" for x, r in parts)
    c = rng.randint(2, 30)
    return f"log({c}*{product})-log({c})" + "".join(f"-({r})*log({x})" for x, r in parts)


def _log_with_number(rng: Random) -> str:
    x, c = positive(rng), rng.randint(2, 60)
    n = rng.randint(2, 4)
    return f"log({c**n}*{x}**{n})-{n}*log({c})-{n}*log({x})"


def _log_known_positive(rng: Random) -> str:
    n = rng.randint(1, 3)
    return rng.choice(
        (
            f"log(q**{2 * n})-{2 * n}*log(q)",
            f"log(p*q)-log(p)-log(q)+log(q**{n})-{n}*log(q)",
            f"log(p/q)-log(p)+log({n}*q)-log({n})",
            "log(q**2*(1+p**2))-2*log(q)-2*log(sqrt(1+p**2))",
            f"log(sqrt(q))-log({n}*q)/2+log({n})/2",
        )
    )


def _log_of_unit(rng: Random) -> str:
    """Of numbers a + b√c whose norm is 1, and of functions of that form."""
    return rng.choice(
        (
            "log(1+sqrt(2))+log(sqrt(2)-1)",
            "log(3+2*sqrt(2))-2*log(1+sqrt(2))",
            "log(2+sqrt(3))+log(2-sqrt(3))",
            "log(9+4*sqrt(5))-6*log((1+sqrt(5))/2)",
            "log(q+sqrt(1+q**2))+log(sqrt(1+q**2)-q)",
            "log(sqrt(1+q**2)+1)+log(sqrt(1+q**2)-1)-log(q**2)",
            "log(1+exp(q))-log(1+exp(-q))-q",
            "log(1+tanh(q))-log(1-tanh(q))-2*q",
            "log(2*cosh(q))-log(1+exp(2*q))+q",
        )
    )


DRAWS: tuple[Draw, ...] = (
    _log_of_numbers,
    _log_of_product,
    _log_with_number,
    _log_known_positive,
    _log_of_unit,
)
