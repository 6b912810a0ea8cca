"""The exact facts on which arguments rest: polynomials that vanish, and equal formulas."""

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
    """One exact fact on which an argument rests.

    `what` states it, `value` is the result in a few words, and `how` the method of the check; these
    texts are in the syntax of `read_prose`, with formulas quoted.
    """

    what: str
    holds: bool
    value: str
    how: str = ALGEBRA


def vanishes(what: str, *elements: Any) -> Check:
    """Check that polynomials in normal form are zero."""
    wrong = [x for x in elements if x != 0]
    return Check(what, not wrong, f"{len(wrong[0])} terms are left" if wrong else "0")


def same(what: str, gaps: Sequence[sympy.Expr], names: Sequence[str], value: str = "0") -> Check:
    """Check that all differences, formulas in these names, are zero in one exact ring.

    `value`: what the check shows if they are.
    """
    # One ring for all formulas: `ring.decide` may then use relations between their functions.
    ring, elements = embed(gaps, names)
    wrong = [gap for gap, x in zip(gaps, elements, strict=True) if ring.decide(x).zero is not True]
    return Check(what, not wrong, f"`{to_text(wrong[0])}`" if wrong else value)
