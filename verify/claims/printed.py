"""Printed decimals, which are right if the value's whole ball rounds to them.

A value on the border of two roundings counts for both. If only a part of the ball rounds to the
printed decimal, the answer is UNDECIDED.
"""

import re
from fractions import Fraction
from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from verify.arithmetic.arb import Ball, bounds, format_ball, format_fixed, is_representable
from verify.claims.runs import QUANTITIES
from verify.errors import InputError
from verify.scenes.results.run import RunResult

_PRINTED = re.compile(r"-?\d{1,20}(\.\d{1,1000})?(e[+-]?\d{1,3})?", re.ASCII)


def _normalize(value: Any) -> str:
    """Normalize a number as a paper prints it; TOML's decimals are texts already."""
    # TOML has already turned decimals into texts; a bool is an int in Python and no number here.
    text = str(value) if isinstance(value, int) and not isinstance(value, bool) else value
    if isinstance(text, str):
        text = text.strip().replace("\N{MINUS SIGN}", "-").replace("E", "e")
        if _PRINTED.fullmatch(text):
            return text
    raise InputError("number", value, "is not a printed decimal, such as -7.3010 or 1.53e-17")


Printed = Annotated[str, BeforeValidator(_normalize)]
Row = Annotated[tuple[Printed, ...], Field(min_length=1, max_length=1000)]


# -- rounding -------------------------------------------------------------------------------------


def holds(run: RunResult, quantity: str, printed: str) -> bool | None:
    """Return True if the run's value rounds to the printed one; None if only in part."""
    source = run.values[QUANTITIES[quantity].needs[0]]
    if quantity.startswith("lg") and Fraction(source.value) == Fraction(source.bound) == 0:
        return False  # lg 0 is no number
    return rounds_to(QUANTITIES[quantity](run), printed)


def places(printed: str) -> int:
    """Return the number of decimals: the unit of the last digit is 10^−places."""
    mantissa, _, exponent = printed.partition("e")
    return len(mantissa.partition(".")[2]) - int(exponent or 0)


def rounds_to(value: Ball, printed: str) -> bool | None:
    """Return True if the whole ball rounds to the printed decimal; None if only a part does."""
    if not is_representable(value):
        return None
    # A number rounds to the printed one if it differs by at most half a unit of the last digit;
    # the border counts, since papers round halves either way.
    half = Fraction(10) ** -places(printed) / 2
    low, high = bounds(value)
    if abs(low - Fraction(printed)) <= half and abs(high - Fraction(printed)) <= half:
        return True
    return None if low - half <= Fraction(printed) <= high + half else False


# -- how values are shown -------------------------------------------------------------------------


def shown_to(run: RunResult, quantity: str, digits: int) -> str:
    """Format the run's value of a quantity to so many digits."""
    value = QUANTITIES[quantity](run)
    if quantity.startswith("lg"):
        return format_fixed(value, max(1, digits - 2)) if is_representable(value) else "unknown"
    return format_ball(value, digits)


def cell(run: RunResult, quantity: str, places: int) -> str:
    """Format the value for a table: a logarithm to so many decimals."""
    value = QUANTITIES[quantity](run)
    return format_fixed(value, max(1, places)) if quantity.startswith("lg") else format_ball(value)


def short(value: Ball, quantity: str) -> str:
    """Format the value to a few digits."""
    return format_fixed(value, 2) if quantity.startswith("lg") else format_ball(value, 3)
