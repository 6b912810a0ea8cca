"""What the strategies take as arguments: whole numbers and exact ones, looked at when they are
given, not when something is drawn."""

from fractions import Fraction

from verify.arithmetic.exact import Exact, rational, text
from verify.arithmetic.exact import whole as whole
from verify.errors import InputError


def exactly(name: str, value: Exact) -> Fraction:
    """The rational that is written; InputError for a float, which says how to write it.

    >>> exactly("most", "1e-3")
    Fraction(1, 1000)
    """
    if isinstance(value, float):
        if value != value or value in (float("inf"), float("-inf")):
            raise InputError(name, value, "not a finite number")
        meant = Fraction(repr(value))
        problem = f"is a float; write '{text(meant)}' or Fraction({meant.numerator}, " + (
            f"{meant.denominator}) to have it exactly"
        )
        raise InputError(name, value, problem)
    return rational(value, name)


def yes_no_either(name: str, value: object) -> bool | None:
    """True, False, or None for either; else InputError."""
    if value is not None and not isinstance(value, bool):
        raise InputError(name, value, "must be True, False, or None for either")
    return value
