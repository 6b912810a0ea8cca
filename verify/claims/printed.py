"""What papers print: decimals, true where a value's whole ball rounds to what is printed.

A value on the border of two roundings counts for both. Where only a part of the ball rounds to what
is printed, the answer is UNDECIDED.
"""

import re
from fractions import Fraction
from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from verify.arithmetic.arb import Ball, bounds, fixed, in_reach, shown
from verify.claims.runs import QUANTITIES
from verify.errors import InputError
from verify.scenes.results.run import RunResult

_PRINTED = re.compile(r"-?\d{1,20}(\.\d{1,1000})?(e[+-]?\d{1,3})?", re.ASCII)


def _as_printed(given: Any) -> str:
    """The text of a number as a paper prints it; TOML's decimals are texts already."""
    shown = str(given) if isinstance(given, int) and not isinstance(given, bool) else given
    if isinstance(shown, str):
        shown = shown.strip().replace("\N{MINUS SIGN}", "-").replace("E", "e")
        if _PRINTED.fullmatch(shown):
            return shown
    raise InputError("number", given, "is not a printed decimal, such as -7.3010 or 1.53e-17")


Printed = Annotated[str, BeforeValidator(_as_printed)]
Row = Annotated[tuple[Printed, ...], Field(min_length=1, max_length=1000)]


# -- rounding -------------------------------------------------------------------------------------


def holds(run: RunResult, quantity: str, printed: str) -> bool | None:
    """Whether the run's value rounds to what is printed; None where its ball does in part."""
    source = run.values[QUANTITIES[quantity].needs[0]]
    if quantity.startswith("lg") and Fraction(source.value) == Fraction(source.bound) == 0:
        return False  # lg 0 is no number
    return rounds_to(QUANTITIES[quantity](run), printed)


def places(printed: str) -> int:
    """How many decimals: the unit of the last digit is 10^−places."""
    mantissa, _, exponent = printed.partition("e")
    return len(mantissa.partition(".")[2]) - int(exponent or 0)


def rounds_to(value: Ball, printed: str) -> bool | None:
    """Whether the value's whole ball rounds to the printed decimal; None where only a part does."""
    if not in_reach(value):
        return None
    half = Fraction(10) ** -places(printed) / 2
    low, high = bounds(value)
    if abs(low - Fraction(printed)) <= half and abs(high - Fraction(printed)) <= half:
        return True
    return None if low - half <= Fraction(printed) <= high + half else False


# -- how values are shown -------------------------------------------------------------------------


def shown_to(run: RunResult, quantity: str, digits: int) -> str:
    """The value to so many digits."""
    value = QUANTITIES[quantity](run)
    if quantity.startswith("lg"):
        return fixed(value, max(1, digits - 2)) if in_reach(value) else "unknown"
    return shown(value, digits)


def cell(run: RunResult, quantity: str, places: int) -> str:
    """The value as a table has it: a logarithm to so many decimals."""
    value = QUANTITIES[quantity](run)
    return fixed(value, max(1, places)) if quantity.startswith("lg") else shown(value)


def short(value: Ball, quantity: str) -> str:
    """The value to a few digits."""
    return fixed(value, 2) if quantity.startswith("lg") else shown(value, 3)
