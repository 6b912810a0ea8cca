"""Roots that are denested, taken out, multiplied or known to be positive."""

from random import Random

from tests.helpers.sampled.identities.parts import Draw, positive


def _square_free(rng: Random) -> int:
    return rng.choice((2, 3, 5, 6, 7, 10, 11, 13, 15))


def _denested(rng: Random) -> str:
    a, b, c = rng.randint(1, 9), rng.randint(1, 9), _square_free(rng)
    return f"sqrt({a * a + b * b * c}+{2 * a * b}*sqrt({c}))-{a}-{b}*sqrt({c})"


def _denested_sum(rng: Random) -> str:
    a, b = rng.sample((2, 3, 5, 7, 11, 13, 17), 2)
    larger, smaller = max(a, b), min(a, b)
    return rng.choice(
        (
            f"sqrt({a + b}+2*sqrt({a * b}))-sqrt({a})-sqrt({b})",
            f"sqrt({a + b}-2*sqrt({a * b}))-sqrt({larger})+sqrt({smaller})",
            f"sqrt({a})*sqrt({b})*sqrt({a * b})-{a * b}",
        )
    )


def _denested_cube(rng: Random) -> str:
    a, b, c = rng.randint(1, 4), rng.randint(1, 4), _square_free(rng)
    whole, root = a**3 + 3 * a * b * b * c, 3 * a * a * b + b**3 * c
    return f"({whole}+{root}*sqrt({c}))**(1/3)-{a}-{b}*sqrt({c})"


def _taken_out(rng: Random) -> str:
    x, n, c = positive(rng), rng.choice((2, 3, 4)), rng.randint(2, 12)
    return f"({c**n}*{x}+0)**(1/{n})-{c}*{x}**(1/{n})"


def _root_of_product(rng: Random) -> str:
    x, y, n = positive(rng), positive(rng), rng.choice((2, 3, 4))
    return f"({x}*{y})**(1/{n})-{x}**(1/{n})*{y}**(1/{n})"


def _root_of_expanded(rng: Random) -> str:
    """The root of an even power that is written out."""
    a, b = rng.randint(1, 9), rng.randint(1, 9)
    return rng.choice(
        (
            f"sqrt({a * a}+{2 * a * b}*q**2+{b * b}*q**4)-{a}-{b}*q**2",
            "sqrt(p**4+2*p**2*q**2+q**4)-p**2-q**2",
            f"sqrt({a * a}+{2 * a}*exp(q)+exp(2*q))-{a}-exp(q)",
            f"sqrt({a * a}+{a * a}*sinh(q)**2)-{a}*cosh(q)",
            f"({a}*q**2+{a * a}+q**4/4)**(1/2)-q**2/2-{a}",
            "sqrt(cosh(2*q)/2+1/2)-cosh(q)",
            f"(1+sinh({b}*q)**2)**(3/2)-cosh({b}*q)**3",
        )
    )


def _root_of_sum(rng: Random) -> str:
    a, b, c = (rng.randint(1, 5) for _ in range(3))
    f, g = f"{a}+q**2", f"{b}+{c}*p**2"
    return f"sqrt({a + b}+q**2+{c}*p**2+2*sqrt(({f})*({g})))-sqrt({f})-sqrt({g})"


def _root_of_root(rng: Random) -> str:
    x, n = positive(rng), rng.choice((2, 3))
    return f"sqrt(({x})**(1/{n})*4)-2*({x})**(1/{2 * n})"


def _known_positive_root(rng: Random) -> str:
    a = rng.randint(2, 9)
    return rng.choice(
        (
            "sqrt(p)*sqrt(q)-sqrt(p*q)",
            f"sqrt({a * a}*q)-{a}*sqrt(q)",
            f"sqrt(q/{a})-sqrt({a}*q)/{a}",
            "sqrt(q)*q-sqrt(q**3)",
            "sqrt(p/q)*sqrt(q)-sqrt(p)+0*log(q)",
            "1/(sqrt(q+1)+sqrt(q))-sqrt(q+1)+sqrt(q)",
        )
    )


DRAWS: tuple[Draw, ...] = (
    _denested,
    _denested_sum,
    _denested_cube,
    _taken_out,
    _root_of_product,
    _root_of_expanded,
    _root_of_sum,
    _root_of_root,
    _known_positive_root,
)
