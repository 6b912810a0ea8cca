"""Monomials, which are read without sympy's constructors: an expanded polynomial has many.

All other parts of a formula are built node by node by sympy, which examines every product for
simplifications, and is slow. This is called the ordinary way below.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence
from functools import cache, cmp_to_key, lru_cache
from typing import Any, NamedTuple, TypeAlias

import gmpy2

from verify.errors import InputError
from verify.lazy_sympy import sympy

MAX_NESTING = 6  # levels within a monomial
_MAX_DIGITS = 18  # of one number in a monomial
_MAX_BITS, _MAX_POWER = 1000, 64

Powers: TypeAlias = "tuple[tuple[sympy.Symbol, int], ...]"
Quotient = tuple[int, int]  # numerator, denominator


class Monomials:
    """A collector of a sum's monomials: terms that are numbers times powers of names.

    `line`: the text from which the nodes were parsed. `name` returns the symbol of a name, or
    another expression that it stands for; it raises InputError for a name that is not allowed.
    """

    def __init__(self, line: str, name: Callable[[str], sympy.Expr]) -> None:
        self.line, self.name = line, name
        self.collected: dict[Powers, gmpy2.mpq] = {}

    def take(self, node: ast.expr, sign: int) -> bool:
        """Add sign·node if the node is a monomial; return False if it must be read in the ordinary
        way."""
        powers: dict[str, int] = {}
        quotient = self._quotient(node, powers, MAX_NESTING)
        if quotient is None or max(powers.values(), default=0) > _MAX_POWER:
            return False
        try:
            symbols = [(self.name(name), n) for name, n in powers.items()]
        except InputError:  # the ordinary way reports the text's first error
            return False
        if not all(symbol.is_Symbol for symbol, _ in symbols):
            return False
        key = tuple(sorted(((s, n) for s, n in symbols if n), key=lambda pair: pair[0].name))
        above, below = quotient
        self.collected[key] = self.collected.get(key, 0) + gmpy2.mpq(sign * above, below)
        return True

    def sum(self) -> sympy.Expr:
        """Return the sum of the collected terms, in sympy's normal form.

        In it a number is the first term of a sum, and the others have sympy's order; in a product a
        number other than 1 stands before the names.
        """
        constant, terms = sympy.S.Zero, []
        for powers, c in self.collected.items():
            number = sympy.Rational(int(c.numerator), int(c.denominator))
            if not powers:
                constant = number
            elif c:
                names = _names(powers)
                factors = names if c == 1 else (number, *names)
                terms.append(
                    factors[0] if len(factors) == 1 else _build_ordered(sympy.Mul, factors)
                )
        if len(terms) < 2:
            return sympy.Add(constant, *terms)
        # sympy's constructors sort and simplify every argument, which is slow. Here the arguments
        # are in normal form already.
        terms.sort(key=_sort_key())
        return _build_ordered(sympy.Add, terms if constant.is_zero else [constant, *terms])

    def _quotient(self, node: ast.expr, powers: dict[str, int], levels: int) -> Quotient | None:
        """Return the number before the names, and add the names' powers to `powers`; None if the
        node is no monomial, or the ordinary way would refuse it."""
        match node:
            case ast.Constant():
                digits = self.line[node.col_offset : node.end_col_offset]
                short = digits.isdecimal() and len(digits) <= _MAX_DIGITS
                return (int(digits), 1) if short else None
            case ast.Name(id=name):
                powers[name] = powers.get(name, 0) + 1
                return 1, 1
            case ast.UnaryOp(op=ast.USub(), operand=operand) if levels:
                inner = self._quotient(operand, powers, levels - 1)
                return inner and (-inner[0], inner[1])
            case ast.BinOp(op=ast.Pow(), left=ast.Name(id=name), right=ast.Constant()):
                inner = self._quotient(node.right, {}, 0)
                powers[name] = powers.get(name, 0) + (inner[0] if inner else 0)
                return inner and (1, 1)
            case ast.BinOp(op=ast.Mult() | ast.Div()) if levels:
                return self._product(node, powers, levels - 1)
        return None

    def _product(self, node: ast.expr, powers: dict[str, int], levels: int) -> Quotient | None:
        above = below = 1
        while isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult | ast.Div):
            divided = isinstance(node.op, ast.Div)
            inner: dict[str, int] = {} if divided else powers
            quotient = self._quotient(node.right, inner, levels)
            if quotient is None or (divided and (inner or quotient[0] == 0)):
                return None
            over, under = quotient[::-1] if divided else quotient
            above, below, node = above * over, below * under, node.left
        quotient = self._quotient(node, powers, levels)
        if quotient is None:
            return None
        above, below = above * quotient[0], below * quotient[1]
        # Larger numbers are read in the ordinary way, which has its own limits and messages.
        return (above, below) if max(abs(above), abs(below)).bit_length() <= _MAX_BITS else None


@cache
def _sort_key() -> Callable[[sympy.Expr], Any]:
    """Return the key by which sympy orders the terms of a sum."""
    return cmp_to_key(sympy.Basic.compare)


def _build_ordered(kind: type[sympy.Expr], args: Sequence[sympy.Expr]) -> sympy.Expr:
    """Build a sum or product of arguments in sympy's order, ten times as fast as sympy, which sorts
    them."""
    return kind._from_args(tuple(args), is_commutative=True)


@lru_cache(maxsize=1024)
def _names(powers: Powers) -> tuple[sympy.Expr, ...]:
    factors: tuple[sympy.Expr, ...] = sympy.Mul.make_args(sympy.Mul(*(x**n for x, n in powers)))
    return factors


def is_power_of_name(x: sympy.Expr) -> bool:
    """Return True if x is a name or a power of one with an integer exponent."""
    return bool(x.is_Symbol or (x.is_Pow and x.base.is_Symbol and x.exp.is_Integer))


def reads_back(x: sympy.Expr, most: int) -> bool:
    """Return True if x is a sum of monomials whose text surely parses back to x; False decides
    nothing.

    `most`: the allowed number of characters. All terms are then read by `Monomials`, which leaves
    numbers and powers as they are, and sympy's order of a sum is unique.
    """
    if not x.is_Add:
        return False
    length = 0
    for term in x.args:
        length += 4  # signs, spaces
        for index, factor in enumerate(term.args if term.is_Mul else (term,)):
            if factor.is_Rational and not index:
                digits = [len(str(abs(n))) for n in (factor.p, factor.q)]
                if max(digits) > _MAX_DIGITS:
                    return False
                length += sum(digits) + 2
            elif is_power_of_name(factor):
                name, power = factor.as_base_exp()
                if not 0 < int(power) <= _MAX_POWER:
                    return False
                length += len(name.name) + 5
            else:
                return False
    return length <= most


class Monomial(NamedTuple):
    """A number times powers of names, with exponents of at least 1."""

    number: sympy.Rational
    powers: tuple[tuple[str, int], ...]


# Cached, since every computation with a formula needs its terms.
@lru_cache(maxsize=64)
def monomials_of(x: sympy.Expr) -> tuple[Monomial, ...] | None:
    """Return the terms of x in their order; None if one of them is no monomial."""
    monomials = []
    for term in x.args if x.is_Add else (x,):
        number, powers = sympy.S.One, []
        for factor in term.args if term.is_Mul else (term,):
            if factor.is_Symbol:
                powers.append((factor.name, 1))
            elif factor.is_Rational:
                number *= factor  # sympy's products may have several
            elif is_power_of_name(factor) and factor.exp.p > 0:
                powers.append((factor.base.name, int(factor.exp.p)))
            else:
                return None
        monomials.append(Monomial(number, tuple(powers)))
    return tuple(monomials)


def names_in(x: sympy.Expr) -> frozenset[str]:
    """Return the names of the symbols in x."""
    terms = monomials_of(x)
    if terms is None:
        return frozenset(symbol.name for symbol in x.free_symbols)
    return frozenset(name for term in terms for name, _ in term.powers)
