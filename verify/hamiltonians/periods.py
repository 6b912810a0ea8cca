"""Periods of H in p, q or t, in one or n degrees of freedom; and whether q is an angle."""

from __future__ import annotations

import math
from fractions import Fraction
from functools import lru_cache

from verify.algebra.expressions.function_nodes import waves_in
from verify.algebra.formula import symbol
from verify.arithmetic.exact import text
from verify.effort import answer_unless_long
from verify.errors import InputError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.lazy_sympy import sympy


def check_period(hamiltonian: Hamiltonian, period: Fraction) -> None:
    """Raise InputError unless H at t + period is shown to equal H at t. H without t has every
    period.

    >>> check_period(Hamiltonian.parse("p**2/2 + q**2*cos(2*pi*t)"), Fraction(1))
    """
    if not hamiltonian.time_dependent:
        return
    is_invariant = _is_invariant(
        hamiltonian, "t", sympy.Rational(period.numerator, period.denominator)
    )
    if is_invariant is not True:
        relation = "is not known to be" if is_invariant is None else "is not"
        problem = f"H {relation} the same at t + {text(period)} as at t"
        raise InputError("period", text(period), problem)


def is_angle(hamiltonian: Hamiltonian) -> bool:
    """Return True if q is shown to be an angle: H at q + 2π equals H at q.

    >>> is_angle(Hamiltonian.parse("p**2/2 - cos(q)")), is_angle(Hamiltonian.parse("p**2 + q**2"))
    (True, False)
    """
    return _is_invariant(hamiltonian, "q", 2 * sympy.pi) is True


def _is_invariant(hamiltonian: Hamiltonian, name: str, shift: sympy.Expr) -> bool | None:
    """Return True if H does not change when `shift` is added to the variable, False if it does;
    None if that is not decided."""
    x = symbol(name)
    shifted = answer_unless_long(
        lambda: sympy.expand(hamiltonian.exact.xreplace({x: x + shift})), None
    )
    if shifted is None:
        return None
    field, (change,) = canonical_field(hamiltonian, shifted - hamiltonian.exact)
    return field.ring.decide(change).zero


@lru_cache(maxsize=256)
def period_in(hamiltonian: Hamiltonian, name: str) -> sympy.Expr | None:
    """Return a period of H in p, q or t, shown by algebra: a rational number, or one times π.

    None if no period is found. Parameters have their values; the period need not be the least.

    >>> period_in(Hamiltonian.parse("p**2/2 + q**2*(2 + cos(2*pi*t/3) + sin(pi*t))"), "t")
    6
    >>> period_in(Hamiltonian.parse("p**2/2 - cos(3*q/2)"), "q")
    4*pi/3
    """
    variable = symbol(name)
    periodic_functions = waves_in(hamiltonian.exact)
    rates = {sympy.expand(f.args[0]).diff(variable) for f in periodic_functions} - {sympy.S.Zero}
    for unit in (sympy.S.One, sympy.pi):
        rational_rates = [rate / unit for rate in rates]
        if rational_rates and all(part.is_Rational for part in rational_rates):
            # For the rates unit·a_i/b_i, (2π/unit)·lcm(b_i)/gcd(a_i) is a multiple of the period of
            # each function.
            common = (
                math.lcm(*(int(x.q) for x in rational_rates)),
                math.gcd(*(int(x.p) for x in rational_rates)),
            )
            period = 2 * sympy.pi / unit * sympy.Rational(*common)
            return period if _is_invariant(hamiltonian, name, period) is True else None
    return None
