"""Sums and products of sines and cosines of parts of a turn, which are algebraic numbers."""

from random import Random

from tests.helpers.sampled.identities.parts import Draw


def _half_sum(rng: Random) -> str:
    n = rng.choice((5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25))
    return "+".join(f"cos({2 * k}*pi/{n})" for k in range(1, n // 2 + 1)) + "+1/2"


def _sine_product(rng: Random) -> str:
    n = rng.choice((3, 5, 7, 9, 11, 13))
    product = "*".join(f"sin({k}*pi/{n})" for k in range(1, n // 2 + 1))
    return f"{2 ** (n // 2)}*{product}-sqrt({n})"


def _tangent_product(rng: Random) -> str:
    n = rng.choice((3, 5, 7, 9, 11))
    return "*".join(f"tan({k}*pi/{n})" for k in range(1, n // 2 + 1)) + f"-sqrt({n})"


def _gauss_sum(rng: Random) -> str:
    n = rng.choice((5, 13, 17, 29))
    return "+".join(f"cos({2 * (k * k % n)}*pi/{n})" for k in range(n)) + f"-sqrt({n})"


def _doubled_product(rng: Random) -> str:
    """Morrie's law: 2ⁿ sin a Π cos(2ᵏ a) = sin(2ⁿ a)."""
    n, a = rng.randint(2, 5), rng.choice((7, 9, 11, 13, 15, 17))
    product = "*".join(f"cos({2**k}*pi/{a})" for k in range(n))
    return f"{2**n}*sin(pi/{a})*{product}-sin({2**n}*pi/{a})"


def _products_of_cosines(rng: Random) -> str:
    """A product of two sums of cosines, multiplied out by 2 cos a cos b."""
    n = rng.choice((5, 7, 8, 9, 11, 12, 13, 15))
    one, two = ([(rng.randint(-5, 5) or 1, rng.randint(1, n)) for _ in range(3)] for _ in range(2))
    left = ["+".join(f"({c})*cos({k}*pi/{n})" for c, k in side) for side in (one, two)]
    right = "+".join(
        f"({c * d})*(cos({k + m}*pi/{n})+cos({k - m}*pi/{n}))/2" for c, k in one for d, m in two
    )
    return f"({left[0]})*({left[1]})-({right})"


def _radical(rng: Random) -> str:
    return rng.choice(
        (
            "cos(pi/5)-(1+sqrt(5))/4",
            "4*cos(pi/12)-sqrt(6)-sqrt(2)",
            "2*cos(pi/16)-sqrt(2+sqrt(2+sqrt(2)))",
            "16*cos(2*pi/17)+1-sqrt(17)-sqrt(34-2*sqrt(17))"
            "-2*sqrt(17+3*sqrt(17)-sqrt(34-2*sqrt(17))-2*sqrt(34+2*sqrt(17)))",
            "8*cos(pi/15)-sqrt(30+6*sqrt(5))-sqrt(5)+1",
            "tan(3*pi/11)+4*sin(2*pi/11)-sqrt(11)",
            "8*cos(pi/7)**3-4*cos(pi/7)**2-4*cos(pi/7)+1",
            "cos(pi/7)**(1/3)*0+cos(pi/7)-cos(2*pi/7)+cos(3*pi/7)-1/2",
            "4*sin(pi/24)**2-2+sqrt(2+sqrt(3))",
        )
    )


DRAWS: tuple[Draw, ...] = (
    _half_sum,
    _sine_product,
    _tangent_product,
    _gauss_sum,
    _doubled_product,
    _products_of_cosines,
    _radical,
)
