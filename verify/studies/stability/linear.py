"""Linear stability: for which hω > 0 a scheme stays bounded on the harmonic oscillator.

For H = (p² + ω²q²)/2, in the coordinates (p, ωq), a step of one of our schemes is a real 2 × 2
matrix M(y), y = hω, with polynomials or rational functions of y as entries. With d = det M and
t = tr M its eigenvalues are at most 1 in size exactly where 1 − d, 1 + d − t and 1 + d + t are all
≥ 0 (Jury's conditions; for `lieη`, d = |R_η(iy)|² with the truncated exponential R_η). Where they
are > 0, or d = 1 and |t| < 2, powers of M stay bounded. Where d = 1 and |t| = 2 they do so for
M = ±I alone, and else grow like a shear's; that is why a splitting's interval does not hold Y.

The interval is (0, Y) with the greatest Y such that all three hold in it; there is none where M is
a shear, or its negative, for all y. Their signs between their roots are decided exactly: by
isolating the real roots of integer polynomials.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import sympy

from verify.errors import InputError
from verify.hamiltonians import systems
from verify.schemes import get
from verify.schemes.step_map import H_STEP, StepMap

Y = sympy.Symbol("y", positive=True)


@dataclass(frozen=True)
class LinearStability:
    """`interval`: the Y of (0, Y), 0 where there is none, ∞ where there is no end.

    `delta_j`: det M − 1 as a function of y. `root_of`: an irreducible polynomial of which Y is a
    root, and the which of its positive ones, where Y is not written with square roots.
    """

    scheme: str
    interval: sympy.Expr
    delta_j: sympy.Expr
    root_of: tuple[sympy.Expr, int] | None = None

    @property
    def exact(self) -> str:
        """As a formula, or as a certain root of a polynomial."""
        if self.interval is sympy.oo:
            return "infinite"
        if self.root_of is not None:
            polynomial, which = self.root_of
            return f"positive root {which} of {polynomial}"
        return str(self.interval)

    def decimal(self, digits: int = 30) -> str:
        """Rounded to so many significant digits."""
        if self.interval in (sympy.oo, 0):
            return "infinite" if self.interval else "0"
        return str(self.interval.evalf(digits))


def linear_stability(name: str) -> LinearStability:
    """The stability interval of the scheme of that name in hω.

    Raises InputError for a scheme that has no closed form on the harmonic oscillator.
    """
    hamiltonian = systems.get("harmonic").hamiltonian({"omega": 1})
    step = get(name).step_map(hamiltonian)
    return of_map(name, step)


def of_map(name: str, step: StepMap) -> LinearStability:
    """The same for a step map of H = (p² + q²)/2, with h for y."""
    entries = [sympy.together(x.subs(H_STEP, Y)) for x in step.jacobian]
    if any(x.free_symbols - {Y} for x in entries):
        raise InputError("scheme", name, "is not linear on the harmonic oscillator")
    a, b, c, e = entries
    det, trace = (sympy.cancel(x) for x in (a * e - b * c, a + e))
    conditions = [_polynomial(x) for x in (1 - det, 1 + det - trace, 1 + det + trace)]
    interval = min(_first_failure(f) for f in conditions)
    if det == 1 and trace in (2, -2) and any(sympy.cancel(x) != 0 for x in (b, c)):
        interval = sympy.S.Zero
    root = _root_of(interval, conditions)
    return LinearStability(name, interval, sympy.factor(det - 1), root)


def _root_of(y: sympy.Expr, conditions: Sequence[sympy.Poly]) -> tuple[sympy.Expr, int] | None:
    """The irreducible factor of a condition that vanishes at y, and which positive root y is."""
    if not y.has(sympy.CRootOf):
        return None
    for f in conditions:
        for factor, _ in _over_rationals(f).factor_list()[1] if not f.is_zero else ():
            positive = sorted(root for root in factor.real_roots() if root > 0)
            if y in positive:
                return factor.as_expr(), positive.index(y) + 1
    return None


def _polynomial(x: sympy.Expr) -> sympy.Poly:
    """A polynomial of x's sign at every y > 0 that is no pole."""
    above, below = sympy.fraction(sympy.cancel(x))
    return sympy.Poly(sympy.expand(above * below), Y, extension=True)


def _over_rationals(f: sympy.Poly) -> sympy.Poly:
    """A polynomial with rational coefficients that has all of f's roots."""
    return f.norm() if f.domain.is_Algebraic else f


def _first_failure(f: sympy.Poly) -> sympy.Expr:
    """The greatest Y such that f ≥ 0 on (0, Y)."""
    if f.is_zero:
        return sympy.oo
    roots = sorted({root for root in _over_rationals(f).real_roots() if root > 0})
    ends = [sympy.S.Zero, *roots]
    for left, right in pairwise([*ends, None]):
        if f.eval(_between(left, right)) < 0:
            return left
    return sympy.oo


def _between(left: sympy.Expr, right: sympy.Expr | None) -> sympy.Rational:
    """A rational number in the open interval; `right` None is infinity."""
    if right is None:
        return sympy.Rational(sympy.ceiling(left) + 1)
    digits = 15
    while True:
        low, high = (sympy.Rational(str(sympy.N(x, digits))) for x in (left, right))
        middle = (low + high) / 2
        if left < middle < right:
            return middle
        digits *= 2
