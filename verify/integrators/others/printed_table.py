"""A table of splitting coefficients as it is printed, and what its digits can say of its order.

Coefficients that stand for algebraic numbers are printed as decimals: taken exactly they have no
order at all. What can be asked is whether numbers near the printed ones satisfy the conditions
exactly: within ten units of their last digits for the order, within one for the digits.

With F the residues, J their derivative at the printed numbers x₀, and B a bound of the second
derivatives (Cauchy's, by a majorant that has all signs plus), F(x) is F(x₀) + J (x − x₀) up to
B |x − x₀|²/2, the norm being the sum. So

- some combination of residues may be enclosed away from 0 over the whole box: then none exist;
- else, with P = U Jᵀ(J U Jᵀ)⁻¹, U the squared units, t ↦ t − F(x₀ + P t) may map a ball around
  −F(x₀) into itself: then, by Brouwer, a solution exists, and it is known where.

J is a difference quotient with a step of 2⁻¹⁶⁰, whose error B bounds too. All is done in balls.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache

import sympy

from verify.algebra.formula import parse, symbol
from verify.arithmetic.number import E
from verify.errors import InputError
from verify.schemes.free_lie_words import KINDS, LogCondition, conditions
from verify.schemes.splitting_conditions import LETTERS

_ODD = (1, 3, 5, 7, 9)


@dataclass(frozen=True)
class PrintedTable:
    """`kind`: see `verify.schemes.free_lie_words`. `parts`: ("kick" or "drift", size) in the order
    in which they are made, or ("step", size) of a composition; sizes are formulas in `numbers`,
    which are decimals as printed, or exact formulas of numbers. InputError for what is none.
    """

    kind: str
    parts: tuple[tuple[str, str], ...]
    numbers: Mapping[str, str]

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise InputError("kind", self.kind, f"allowed: {', '.join(KINDS)}")
        known = ("step",) if self.kind == "composition" else tuple(LETTERS)
        wrong = [name for name, _ in self.parts if name not in known]
        if wrong or not self.parts:
            raise InputError("parts", wrong, f"are {' or '.join(known)}, one at least")
        _ = self.sizes, self.units

    @cached_property
    def sizes(self) -> tuple[sympy.Expr, ...]:
        """Of the parts, in the symbols of the numbers that are rounded."""
        exact = {
            symbol(name): parse(text, (), source=name)
            for name, text in self.numbers.items()
            if name not in self.units
        }
        return tuple(
            sympy.expand(parse(size, self.numbers, source="part").subs(exact))
            for _, size in self.parts
        )

    @cached_property
    def units(self) -> dict[str, Fraction]:
        """One unit of the last digit of each number that is printed as a decimal with a point."""
        return {n: unit for n, text in self.numbers.items() if (unit := _unit(text)) is not None}

    @cached_property
    def values(self) -> dict[str, Fraction]:
        """The rounded numbers exactly as they are printed."""
        return {name: Fraction(self.numbers[name].replace(" ", "")) for name in self.units}

    @cached_property
    def digits(self) -> int:
        """Decimals after the point of the number that has fewest."""
        return min(len(str(1 / unit)) - 1 for unit in self.units.values())

    @property
    def palindromic(self) -> bool:
        names = [name for name, _ in self.parts]
        return names == names[::-1] and self.sizes == self.sizes[::-1]

    def letters(self, sizes: Sequence[E]) -> list[Mapping[str, E]]:
        """The parts for `verify.schemes.free_lie_words.step`, with these sizes."""
        if self.kind == "composition":
            return [{str(n): power(x, n) for n in _ODD} for x in sizes]
        names = (name for name, _ in self.parts)
        return [{LETTERS[name]: x} for name, x in zip(names, sizes, strict=True)]

    def sums_to_one(self, name: str) -> bool:
        """Whether the sizes of these parts have the sum 1, whatever the numbers are."""
        own = (x for (kind, _), x in zip(self.parts, self.sizes, strict=True) if kind == name)
        return bool(sympy.expand(sum(own, sympy.S.Zero) - 1) == 0)

    def conditions(self, order: int) -> tuple[LogCondition, ...]:
        """The conditions of orders 1 … `order` that do not hold by the form of the table alone."""
        by_form = {"Σ kicks = 1": "kick", "Σ drifts = 1": "drift", "Σ w = 1": "step"}
        return tuple(
            c
            for c in conditions(self.kind, order)
            if not (self.palindromic and c.order % 2 == 0)
            and not (c.name in by_form and self.sums_to_one(by_form[c.name]))
        )


def power(x: E, n: int) -> E:
    """xⁿ, n ≥ 1, by products: of a ball with 0 in it, powers may be undefined."""
    result = x
    for _ in range(n - 1):
        result = result * x
    return result


def _unit(text: str) -> Fraction | None:
    mantissa, _, exponent = text.lower().strip().lstrip("+-").partition("e")
    whole, point, decimals = mantissa.partition(".")
    if not point or not (whole + decimals).isdigit():
        return None
    return Fraction(10) ** (int(exponent or 0) - len(decimals))


def evaluated(expression: sympy.Expr, at: Mapping[str, E], number: Callable[[Fraction], E]) -> E:
    """A polynomial in the numbers, at `at`; `number` makes what its coefficients are there."""
    total = number(Fraction(0))
    for powers, coefficient in _terms(expression):
        term = number(coefficient)
        for name, n in powers:
            term = term * power(at[name], n)
        total = total + term
    return total


@lru_cache(maxsize=4096)
def _terms(expression: sympy.Expr) -> tuple[tuple[tuple[tuple[str, int], ...], Fraction], ...]:
    """((number, exponent), …) and the coefficient, of each term."""
    if not expression.free_symbols:
        return (((), _fraction(expression)),)
    polynomial = sympy.Poly(expression)
    names = [x.name for x in polynomial.gens]
    return tuple(
        (tuple((n, e) for n, e in zip(names, powers, strict=True) if e), _fraction(coefficient))
        for powers, coefficient in polynomial.terms()
    )


def _fraction(x: sympy.Expr) -> Fraction:
    return Fraction(int(x.p), int(x.q))
