"""One exact fact that an argument rests on: polynomials that vanish, formulas that are the same."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import sympy

from verify.algebra.embedding import embed
from verify.algebra.expressions.formula_text import to_text

ALGEBRA = "exact algebra"
NUMBERS = "exact numbers"
BALLS = "enclosures"


@dataclass(frozen=True)
class Check:
    """One exact fact that an argument rests on; `shown` is its value in a few words, `how` it is
    known.

    Both texts are written as `read_prose` takes them, with formulas quoted.
    """

    what: str
    holds: bool
    shown: str
    how: str = ALGEBRA


def vanishes(what: str, *elements: Any) -> Check:
    """The check that polynomials in normal form are zero."""
    wrong = [x for x in elements if x != 0]
    return Check(what, not wrong, f"{len(wrong[0])} terms are left" if wrong else "0")


def same(what: str, gaps: Sequence[sympy.Expr], names: Sequence[str], shown: str = "0") -> Check:
    """The check that all differences, formulas in these names, are zero in one exact ring; `shown`:
    what is told then."""
    ring, elements = embed(gaps, names)
    wrong = [gap for gap, x in zip(gaps, elements, strict=True) if ring.decide(x).zero is not True]
    return Check(what, not wrong, f"`{to_text(wrong[0])}`" if wrong else shown)
