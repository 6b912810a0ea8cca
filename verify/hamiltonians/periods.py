"""Whether H(p, q, t) has a given period in t, and whether q is an angle."""

from fractions import Fraction

import sympy

from verify.algebra.formula import symbol
from verify.arithmetic.exact import text
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian


def check_period(hamiltonian: Hamiltonian, period: Fraction) -> None:
    """InputError where H at t + period differs from H at t, or may: what is not decided is not
    taken for a period. H without t has every one.

    >>> check_period(Hamiltonian.parse("p**2/2 + q**2*cos(2*pi*t)", time=True), Fraction(1))
    """
    if not hamiltonian.time_dependent:
        return
    same = _is_same(hamiltonian, "t", sympy.Rational(period.numerator, period.denominator))
    if same is not True:
        is_known = "is not known to be" if same is None else "is not"
        problem = f"H {is_known} the same at t + {text(period)} as at t"
        raise InputError("period", text(period), problem)


def is_angle(hamiltonian: Hamiltonian) -> bool:
    """Whether q is known to be an angle: H at q + 2π is H at q.

    >>> is_angle(Hamiltonian.parse("p**2/2 - cos(q)")), is_angle(Hamiltonian.parse("p**2 + q**2"))
    (True, False)
    """
    return _is_same(hamiltonian, "q", 2 * sympy.pi) is True


def _is_same(hamiltonian: Hamiltonian, name: str, shift: sympy.Expr) -> bool | None:
    """Whether H is the same function with that added to q or t; None where it is not decided."""
    x = symbol(name)
    moved = sympy.expand(hamiltonian.exact.xreplace({x: x + shift}))
    field, (change,) = hamiltonian.field(moved - hamiltonian.exact)
    return field.ring.decide(change).zero
