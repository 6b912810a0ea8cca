"""Monomials, read at once: of polynomials that are written out as sums of them there are many.

What else a formula is made of goes node by node through sympy, which looks at every product for
what it could be simplified to.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence
from functools import cache, cmp_to_key, lru_cache
from typing import Any, NamedTuple, TypeAlias

import gmpy2

from verify.errors import InputError
from verify.late import sympy

DEEPEST = 6  # levels of nesting within a monomial, at most
_LONGEST = 18  # digits of a number
_MOST_BITS, _MOST_POWER = 1000, 64

Powers: TypeAlias = "tuple[tuple[sympy.Symbol, int], ...]"
Quotient = tuple[int, int]  # numerator, denominator


class Monomials:
    """Collects those terms of a sum that are numbers times powers of names, by their powers.

    `line`: the text that the nodes are of. `name` gives a name's symbol, or what else it
    stands for, and raises InputError for one that is not allowed.
    """

    def __init__(self, line: str, name: Callable[[str], sympy.Expr]) -> None:
        self.line, self.name = line, name
        self.collected: dict[Powers, gmpy2.mpq] = {}

    def take(self, node: ast.expr, sign: int) -> bool:
        """Adds the term times its sign; False where it is to be read in the ordinary way."""
        powers: dict[str, int] = {}
        quotient = self._quotient(node, powers, DEEPEST)
        if quotient is None or max(powers.values(), default=0) > _MOST_POWER:
            return False
        try:
            symbols = [(self.name(name), n) for name, n in powers.items()]
        except InputError:  # of several errors the first one in the text is told
            return False
        if not all(symbol.is_Symbol for symbol, _ in symbols):
            return False
        key = tuple(sorted(((s, n) for s, n in symbols if n), key=lambda pair: pair[0].name))
        above, below = quotient
        self.collected[key] = self.collected.get(key, 0) + gmpy2.mpq(sign * above, below)
        return True

    def sum(self) -> sympy.Expr:
        """The sum of what was taken, as sympy has it: sums it has in its own order, a number first;
        products with a number before the names, where that is not 1."""
        constant, terms = sympy.S.Zero, []
        for powers, c in self.collected.items():
            number = sympy.Rational(int(c.numerator), int(c.denominator))
            if not powers:
                constant = number
            elif c:
                names = _names(powers)
                factors = names if c == 1 else (number, *names)
                terms.append(factors[0] if len(factors) == 1 else _in_order(sympy.Mul, factors))
        if len(terms) < 2:
            return sympy.Add(constant, *terms)
        terms.sort(key=_place())
        return _in_order(sympy.Add, terms if constant.is_zero else [constant, *terms])

    def _quotient(self, node: ast.expr, powers: dict[str, int], levels: int) -> Quotient | None:
        """The number before the names, whose powers are added to `powers`; None of what else it
        may be, and of what the ordinary way would refuse."""
        match node:
            case ast.Constant():
                written = self.line[node.col_offset : node.end_col_offset]
                short = written.isdecimal() and len(written) <= _LONGEST
                return (int(written), 1) if short else None
            case ast.Name(id=name):
                powers[name] = powers.get(name, 0) + 1
                return 1, 1
            case ast.UnaryOp(op=ast.USub(), operand=operand) if levels:
                found = self._quotient(operand, powers, levels - 1)
                return found and (-found[0], found[1])
            case ast.BinOp(op=ast.Pow(), left=ast.Name(id=name), right=ast.Constant()):
                found = self._quotient(node.right, {}, 0)
                powers[name] = powers.get(name, 0) + (found[0] if found else 0)
                return found and (1, 1)
            case ast.BinOp(op=ast.Mult() | ast.Div()) if levels:
                return self._product(node, powers, levels - 1)
        return None

    def _product(self, node: ast.expr, powers: dict[str, int], levels: int) -> Quotient | None:
        above = below = 1
        while isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult | ast.Div):
            divided = isinstance(node.op, ast.Div)
            inner: dict[str, int] = {} if divided else powers
            found = self._quotient(node.right, inner, levels)
            if found is None or (divided and (inner or found[0] == 0)):
                return None
            over, under = found[::-1] if divided else found
            above, below, node = above * over, below * under, node.left
        found = self._quotient(node, powers, levels)
        if found is None:
            return None
        above, below = above * found[0], below * found[1]
        return (above, below) if max(abs(above), abs(below)).bit_length() <= _MOST_BITS else None


@cache
def _place() -> Callable[[sympy.Expr], Any]:
    """The key by which sympy orders what is summed."""
    return cmp_to_key(sympy.Basic.compare)


def _in_order(kind: type[sympy.Expr], args: Sequence[sympy.Expr]) -> sympy.Expr:
    """The sum or product of what is in order, which takes sympy ten times as long to find out."""
    return kind._from_args(tuple(args), is_commutative=True)


@lru_cache(maxsize=1024)
def _names(powers: Powers) -> tuple[sympy.Expr, ...]:
    found: tuple[sympy.Expr, ...] = sympy.Mul.make_args(sympy.Mul(*(x**n for x, n in powers)))
    return found


def is_of_name(x: sympy.Expr) -> bool:
    """Whether it is a name or a power of one with an integer exponent."""
    return bool(x.is_Symbol or (x.is_Pow and x.base.is_Symbol and x.exp.is_Integer))


def reads_back(x: sympy.Expr, most: int) -> bool:
    """Whether x is a sum of monomials whose text, of at most so many characters, surely reads as x.

    Its terms are then all taken by `Monomials`, which gives each number and powers as they stand
    there, and sympy has one order for what is summed. Where the answer is no, it may be so too.
    """
    if not x.is_Add:
        return False
    length = 0
    for term in x.args:
        length += 4  # signs, spaces
        for place, factor in enumerate(term.args if term.is_Mul else (term,)):
            if factor.is_Rational and not place:
                digits = [len(str(abs(n))) for n in (factor.p, factor.q)]
                if max(digits) > _LONGEST:
                    return False
                length += sum(digits) + 2
            elif is_of_name(factor):
                name, power = factor.as_base_exp()
                if not 0 < int(power) <= _MOST_POWER:
                    return False
                length += len(name.name) + 5
            else:
                return False
    return length <= most


class Monomial(NamedTuple):
    """A number times powers of names, with exponents of at least 1."""

    number: sympy.Rational
    powers: tuple[tuple[str, int], ...]


# A formula's expression is asked for its terms whenever something is made of it.
@lru_cache(maxsize=64)
def monomials_of(x: sympy.Expr) -> tuple[Monomial, ...] | None:
    """The terms of x, as they stand there; None where one of them is no monomial."""
    found = []
    for term in x.args if x.is_Add else (x,):
        number, powers = sympy.S.One, []
        for factor in term.args if term.is_Mul else (term,):
            if factor.is_Symbol:
                powers.append((factor.name, 1))
            elif factor.is_Rational:
                number *= factor  # sympy's products may have several
            elif is_of_name(factor) and factor.exp.p > 0:
                powers.append((factor.base.name, int(factor.exp.p)))
            else:
                return None
        found.append(Monomial(number, tuple(powers)))
    return tuple(found)


def names_in(x: sympy.Expr) -> frozenset[str]:
    """The names of the symbols in x."""
    terms = monomials_of(x)
    if terms is None:
        return frozenset(symbol.name for symbol in x.free_symbols)
    return frozenset(name for term in terms for name, _ in term.powers)
