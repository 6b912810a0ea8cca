"""An elementary function of one real number: all that other rooms need of it, in one object.

A formula that holds in numbers of any kind is written once, with + − * and `apply`, which applies a
function to such a number by its name, "inverse" and "sqrt" among them: the numbers may be MPFR's,
balls, elements of a ring, series, operations of a program. No library is imported here.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

Number: TypeAlias = Any
Apply: TypeAlias = Callable[[str, Number], Number]


@dataclass(frozen=True)
class Pair:
    """The names of odd s and even c with s' = c, c' = sign·s and c² − sign·s² = 1."""

    odd: str
    even: str
    sign: int


CIRCLE, HYPERBOLA = Pair("sin", "cos", -1), Pair("sinh", "cosh", 1)


@dataclass(frozen=True)
class Domain:
    """The domain of a function: `inside`, made from its argument, is ≠ 0, ≥ 0 or > 0; or `through`,
    the function of that name, of it is."""

    relation: Literal["!=", ">=", ">"]
    inside: Callable[[Number], Number] = lambda x: x
    through: str = ""


@dataclass(frozen=True)
class FixedPoint:
    """The accuracy of a function in fixed point, and how it is computed if it is made of others.

    A result is off by `units` in the last place at most, and by its size divided by `share` more,
    if that is not 0. `composed`: the function in finer numbers, from these and its argument (see
    `verify.arithmetic.wide.newton`); None if `verify.arithmetic.wide` has code for it.
    """

    units: str
    share: int = 0
    composed: Callable[[Any, Number], Number] | None = None


@dataclass(frozen=True)
class Function:
    """An elementary function; `name`: in formulas, in sympy, arb, MPFR, mpmath, `math` and the C
    library.

    - `slope`: its derivative, from the argument; or `equation`, from the value. Without a pair it
      is made with "inverse" and "sqrt" alone, which a ring has.
    - `lipschitz`: a bound on |slope|, which is 1: the function then stays in a range that its
      argument is in, such as fixed point's; None if the slope has no bound.
    - `domain`: where it is defined; None: everywhere.
    - `pair`, `parts`: the pair whose odd and even function it is made of, and how, with a quotient.
    - `image`: its image in the field of `verify.algebra.identities.field_image`, from its
      argument's image. None: it is made of others, and a ring has no generator of it.
    - `turns`: whether sums of it, as of arctangents, are the same but for multiples of π.
    - `bounded`: whether it is between −1 and 1. `positive`: whether it is > 0 everywhere, or an
      expression of its argument that is > 0 where the function is.
    - `ball`: a ball around its values on one, if arb's own method is too wide.
    - `fixed`: in fixed point; None: that has none.
    - `numpy`: its name there; `shown`: on pages; `tex`: a command of TeX's; each follows from the
      name if it is empty. `synonyms`: other names for it, which the message for a refused
      formula mentions.
    """

    name: str
    slope: Callable[[Number, Apply], Number] | None = None
    equation: Callable[[Number], Number] | None = None
    lipschitz: int | None = None
    domain: Domain | None = None
    pair: Pair | None = None
    parts: Callable[[Number, Number, Callable[[Number, Number], Number]], Number] | None = None
    image: Callable[[Any, Number], Number] | None = None
    turns: bool = False
    bounded: bool = False
    positive: Callable[[Number], Number] | bool = False
    ball: Callable[[Number], Number] | None = None
    fixed: FixedPoint | None = None
    numpy: str = ""
    shown: str = ""
    tex: str = ""
    synonyms: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        shown_name = self.shown or self.name
        names = {
            "numpy": self.numpy or self.name,
            "shown": shown_name,
            "tex": self.tex or f"\\{shown_name}",
        }
        # The dataclass is frozen, so the defaults are set past its own __setattr__.
        for field, text in names.items():
            object.__setattr__(self, field, text)

    def of_balls(self, arb: Any) -> Callable[[Number], Number]:
        """Return the function for arb's balls, which are of that type."""
        method: Callable[[Number], Number] = self.ball or getattr(arb, self.name)
        return method

    def derivative(self, x: Number, y: Number, apply: Apply) -> Number:
        """Return f'(x), where y = f(x)."""
        if self.equation is not None:
            return self.equation(y)
        assert self.slope is not None  # noqa: S101 - each has one of the two
        return self.slope(x, apply)
