"""The step size up to which a scheme is stable on the harmonic oscillator, as hω.

That is the end of the interval (0, hω) on which the steps of p²/2 + ω²q²/2 stay bounded, as
`verify stability --linear` has it; `printed` as a decimal, or as a `formula` such as `2*sqrt(2)`.
"""

from fractions import Fraction
from typing import Literal, Self

import sympy
from pydantic import model_validator

from verify.algebra.formula import parse
from verify.arithmetic.arb import Ball, make_ball
from verify.claims.base_claim import Claim, Findings
from verify.claims.quantities import PrintedDecimal, places, rounds_to
from verify.effort import answer_unless_long
from verify.errors import NOT_GIVEN, InputError
from verify.prose import Number, Prose, prose
from verify.scenes.results.claim import ClaimResult
from verify.studies.stability.linear_stability import LinearStability
from verify.studies.stability.scheme_interval import linear_stability
from verify.verdict import Verdict

_DIGITS = 30
_MOST_CHARACTERS = 100  # of the exact limit, which may be the root of a long polynomial


class StabilityLimitClaim(Claim):
    """The end of the interval of stability, in hω."""

    on_scene = False
    obstacle = "it is about the harmonic oscillator alone"
    kind: Literal["stability_limit"]
    printed: PrintedDecimal | None = None
    """The limit as printed; or `formula`."""
    formula: str = ""
    """The limit exactly; or `printed`."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        if (self.printed is None) == (not self.formula):
            raise InputError("printed, formula", NOT_GIVEN, "give one of the two")
        return self

    def judge(self, findings: Findings) -> ClaimResult:
        stability = linear_stability(self.scheme)
        evidence = prose("it is stable for 0 < hω < ", Number(stability.decimal(_DIGITS)))
        if stability.interval is sympy.oo or stability.interval == 0:
            words = "for no hω > 0" if stability.interval == 0 else "for every hω > 0"
            return self.result(Verdict.REFUTED, prose(f"it is stable {words}"))
        holds = self._is_right(stability)
        verdict = {True: Verdict.PROVED, False: Verdict.REFUTED, None: Verdict.UNDECIDED}[holds]
        return self.result(verdict, _with_exact(evidence, stability))

    def _is_right(self, stability: LinearStability) -> bool | None:
        if self.printed is not None:
            return rounds_to(_ball(stability), self.printed)
        exact = parse(self.formula, (), source="formula")
        if not isinstance(stability.interval, sympy.Expr):
            near = rounds_to(_ball(stability), str(sympy.N(exact, 20)))
            return False if near is False else None
        gap = exact - stability.interval
        if abs(sympy.N(gap, 2 * _DIGITS)) > sympy.Rational(1, 10**_DIGITS):
            return False
        is_same = answer_unless_long(lambda: bool(sympy.simplify(gap) == 0), otherwise=False)
        return True if is_same else None


def _ball(stability: LinearStability) -> Ball:
    text = stability.decimal(_DIGITS)
    return make_ball(Fraction(text), Fraction(1, 10 ** places(text)))


def _with_exact(evidence: Prose, stability: LinearStability) -> Prose:
    is_short = 0 < len(stability.exact) < _MOST_CHARACTERS
    return prose(evidence, f", exactly {stability.exact}") if is_short else evidence


CLAIM = StabilityLimitClaim
