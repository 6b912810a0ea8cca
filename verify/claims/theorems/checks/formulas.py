"""Formulas that are the same: their differences are decided to be zero in one exact ring."""

from collections.abc import Sequence

import sympy

from verify.algebra.embedding import embed
from verify.algebra.expressions.formula_text import to_text
from verify.claims.theorems.checks.check import Check


def same(what: str, gaps: Sequence[sympy.Expr], names: Sequence[str], shown: str = "0") -> Check:
    """Whether all differences, formulas in these names, are zero; `shown`: what is told then."""
    ring, elements = embed(gaps, names)
    wrong = [gap for gap, x in zip(gaps, elements, strict=True) if ring.decide(x).zero is not True]
    return Check(what, not wrong, f"`{to_text(wrong[0])}`" if wrong else shown)
