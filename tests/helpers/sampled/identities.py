"""Identities as people print them, drawn at random, each with a twin that is false.

An identity is a formula that is 0 wherever it is defined; it is written from textbook rules and by
Python's own integers, so that nothing of it comes from the code that decides it. Its twin differs
by a small exact amount.
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from math import atan, pi
from random import Random

Draw = Callable[[Random], str]

# Is 0 for every q, and is not decided.
HIDDEN = "sqrt(1 + 2*q**2 + 2*q*sqrt(1 + q**2)) - q - sqrt(1 + q**2)"


@dataclass(frozen=True)
class Identity:
    """A formula that is 0, and one that is not."""

    true: str
    false: str


def identities(sort: str, count: int, seed: int) -> list[Identity]:
    """So many of one of the `SORTS`."""
    rng = Random(f"{sort} {seed}")  # noqa: S311 - no secret
    return [drawn_identity(sort, rng) for _ in range(count)]


def drawn_identity(sort: str, rng: Random) -> Identity:
    """One of that sort."""
    true = rng.choice(SORTS[sort])(rng)
    amount = f"{rng.choice((1, 2, 3, 7))}/10**{rng.randint(4, 60)}"
    factor = rng.choice(("", "*(1+q**2)", "*exp(q)", "*pi"))
    return Identity(true, f"{true} {rng.choice('+-')} {amount}{factor}")


# -- what identities are made of --------------------------------------------------------------


def _angle(rng: Random) -> str:
    """An argument of a sine."""
    return rng.choice(
        ("q", "p", "2*q", "q/2", "p+q", "p*q", "q**2/3", "delta*q", "exp(q)", "3*p-q")
    )


def _turn(rng: Random) -> str:
    n = rng.choice((3, 4, 5, 6, 7, 8, 9, 10, 12, 15, 16, 24))
    return f"{rng.randint(1, 2 * n)}*pi/{n}"


def _positive(rng: Random) -> str:
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


def _fraction(rng: Random, most: int = 60) -> Fraction:
    return Fraction(rng.randint(1, most), rng.randint(1, most))


def _share(rng: Random) -> Fraction:
    return Fraction(rng.choice((1, 2, 3, -1, -2, 5)), rng.choice((1, 1, 2, 3, 4)))


# -- phases -----------------------------------------------------------------------------------


def _sum_formula(rng: Random) -> str:
    x, a = _angle(rng), _turn(rng)
    return f"sin({x}+{a})-sin({x})*cos({a})-cos({x})*sin({a})"


def _product_to_sum(rng: Random) -> str:
    x, y, a, b = _angle(rng), _angle(rng), _turn(rng), _turn(rng)
    left = f"2*sin({x}+{a})*cos({y}-{b})"
    return f"{left}-sin({x}+{y}+{a}-{b})-sin({x}-({y})+{a}+{b})"


def _phases_around(rng: Random) -> str:
    x, n = _angle(rng), rng.randint(3, 12)
    return "+".join(f"cos({x}+2*{k}*pi/{n})" for k in range(n))


def _squares_around(rng: Random) -> str:
    x, n = _angle(rng), rng.randint(3, 9)
    return "+".join(f"sin({x}+{k}*pi/{n})**2" for k in range(n)) + f"-{Fraction(n, 2)}"


def _product_around(rng: Random) -> str:
    x, n = rng.choice(("q", "p", "p+q")), rng.randint(2, 6)
    product = "*".join(f"sin({x}+{k}*pi/{n})" for k in range(n))
    return f"{2 ** (n - 1)}*{product}-sin({n}*({x}))"


def _one_wave(rng: Random) -> str:
    """a sin x + b cos x as one sine, for the angles whose sines are square roots."""
    x = _angle(rng)
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
    x, a = _angle(rng), _turn(rng)
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


# -- sums of cosines of parts of a turn -------------------------------------------------------


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


# -- logarithms -------------------------------------------------------------------------------


def _log_of_numbers(rng: Random) -> str:
    parts = [(_fraction(rng), rng.choice((1, 2, 3, -1, -2))) for _ in range(rng.randint(2, 4))]
    product = Fraction(1)
    for x, n in parts:
        product *= x**n
    return f"log({product})" + "".join(f"-({n})*log({x})" for x, n in parts)


def _log_of_product(rng: Random) -> str:
    parts = [(_positive(rng), _share(rng)) for _ in range(rng.randint(2, 3))]
    product = "*".join(f"{x}**({r})" for x, r in parts)
    c = rng.randint(2, 30)
    return f"log({c}*{product})-log({c})" + "".join(f"-({r})*log({x})" for x, r in parts)


def _log_with_number(rng: Random) -> str:
    x, c = _positive(rng), rng.randint(2, 60)
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


# -- roots ------------------------------------------------------------------------------------


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
    x, n, c = _positive(rng), rng.choice((2, 3, 4)), rng.randint(2, 12)
    return f"({c**n}*{x}+0)**(1/{n})-{c}*{x}**(1/{n})"


def _root_of_product(rng: Random) -> str:
    x, y, n = _positive(rng), _positive(rng), rng.choice((2, 3, 4))
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
    x, n = _positive(rng), rng.choice((2, 3))
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


# -- hyperbolic functions and exponentials of logarithms --------------------------------------


def _hyperbolic_number(rng: Random) -> str:
    a, r = (
        _fraction(rng, 20),
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
    u, n = _positive(rng), rng.randint(1, 3)
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
    a = _fraction(rng, 30)
    value = (a**2 - 1) / (a**2 + 1)
    return f"tanh(log({a}))-({value})"


# -- arctangents ------------------------------------------------------------------------------


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
    x = _positive(rng)
    return rng.choice((f"atan({x})+atan(1/{x})-pi/2", f"atan(-{x})+atan(-1/{x})+pi/2"))


def _difference(rng: Random) -> str:
    x, y = _positive(rng), _positive(rng)
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
            "atan(q/p)+atan(p/q)-pi/2+0*q",
        )[:-1]
    )


def _surd(rng: Random) -> str:
    c = rng.choice((2, 3, 5, 6, 7))
    return rng.choice(
        (
            f"atan(sqrt({c}))+atan(1/sqrt({c}))-pi/2",
            "atan(sqrt(2)-1)-pi/8",
            f"2*atan(sqrt({c})+sqrt({c + 1}))-pi/2-atan(sqrt({c}))",
            "atan(1/sqrt(2))-atan(sqrt(2))/2-atan(1/(2*sqrt(2)))/2+0",
        )[:-1]
    )


SORTS: dict[str, tuple[Draw, ...]] = {
    "phases": (_sum_formula, _product_to_sum, _phases_around, _squares_around, _product_around,
               _one_wave, _half_angle, _tangent),
    "parts of a turn": (_half_sum, _sine_product, _tangent_product, _gauss_sum, _doubled_product,
                        _products_of_cosines, _radical),
    "logarithms": (_log_of_numbers, _log_of_product, _log_with_number, _log_known_positive,
                   _log_of_unit),
    "roots": (_denested, _denested_sum, _denested_cube, _taken_out, _root_of_product,
              _root_of_expanded, _root_of_sum, _root_of_root, _known_positive_root),
    "hyperbolic functions of logarithms": (_hyperbolic_number, _hyperbolic_function, _shifted,
                                           _exponential, _exact_tangent),
    "arctangents": (_gaussian_sum, _machin, _reciprocal, _difference, _known_function, _surd),
}  # fmt: skip
