"""The rows of reference data: which columns they have, and the one decimal for each number in them.

Beside the coordinates there is in the plane ΔJ of the next step; in several degrees of freedom H,
and S and W in place of ΔJ.

A number known within a bound is printed as the one decimal that it rounds to, if there is only one.
The text and its radius then depend on the number alone and not on the way to it: whoever computes
it again, with any bound that is small enough, gets the same text.
"""

from fractions import Fraction
from itertools import count
from typing import Any

from verify.arithmetic.exact import decimal, magnitude, rounded_units
from verify.hamiltonians.coordinates import coordinates_in
from verify.scenes.results.reference import Cell, FlowRow, OrbitRow, Rounded
from verify.structures import AREA, SYMPLECTIC, structure_in

Row = tuple[str, ...]
AFTER_A_STEP = ("mse", "symplectic_defect_max")  # what there is not for N = 0
MAY_LACK = ("delta_j", "energy")  # what is of the state alone
_BESIDE_STATE = {
    AREA: ("delta_j", "mse", "lambda"),
    SYMPLECTIC: ("energy", "symplectic_defect_max", "symplectic_defect", "lambda"),
}


def cell(value: Any) -> str:
    """Return the text of a value; empty for None; of entries by name, NAME: VALUE with
    semicolons."""
    if value is None:
        return ""
    if isinstance(value, dict):
        return "; ".join(f"{name}: {x}" for name, x in value.items())
    return str(value).lower() if isinstance(value, bool) else str(value)


def start_columns(degrees: int) -> Row:
    """Return the names of the columns that hold the start: q first; q0, or q0_1 …"""
    names = coordinates_in(degrees)
    return tuple(f"{x[0]}0_{x[1:]}".rstrip("_") for x in (*names[degrees:], *names[:degrees]))


def orbit_columns(degrees: int) -> Row:
    """Return the names of an orbit's columns other than those of its state."""
    return _BESIDE_STATE[structure_in(degrees)]


def values_of(row: OrbitRow | FlowRow, degrees: int) -> dict[str, Cell]:
    """Return the numbers of a row by the names of their columns; None for a missing one."""
    values: dict[str, Cell] = {}
    for letter, numbers in (("p", row.p), ("q", row.q)):
        if isinstance(numbers, tuple):  # a file may have too few or too many
            values |= {f"{letter}{k}": x for k, x in enumerate(numbers, start=1)}
        else:
            values |= {x: numbers for x in coordinates_in(degrees) if x[0] == letter}
    if isinstance(row, OrbitRow):
        columns = orbit_columns(degrees)
        values |= {name: getattr(row, "lam" if name == "lambda" else name) for name in columns}
    return values


# -- correct rounding -----------------------------------------------------------------------------

_TOUCH = 20  # digits beyond those asked for, within which an exact number is looked at like others


def correctly_rounded(value: Fraction, bound: Fraction, digits: int) -> Rounded | None:
    """Return the decimal of so many significant digits that is nearest to every number within
    `bound`.

    Of one digit more if the number is halfway between two of them, as exact decimals can be.
    An exact number (`bound` 0) that has no more digits than that is given itself, with radius 0.
    None if the bound is too large to tell, and so whenever it reaches 0.

    >>> correctly_rounded(Fraction(1, 3), Fraction(1, 10**6), 4)
    Rounded(value='3.333e-01', radius='5e-05')
    >>> correctly_rounded(Fraction(1, 3), Fraction(1, 10**4), 4)
    >>> correctly_rounded(Fraction(1, 4), Fraction(0), 4)
    Rounded(value='2.5e-01', radius='0')
    """
    if bound == 0 and _short(value, digits):
        return exactly(value)
    # An exact number with more digits is treated like one with a tiny bound: so the text does not
    # depend on whether the number was known exactly.
    tolerance = bound or abs(value) / Fraction(10) ** (digits + _TOUCH)
    low, high = value - tolerance, value + tolerance
    if low <= 0 <= high:
        return None
    for many in (digits, digits + 1):
        text = decimal(low, many)
        if text == decimal(high, many):
            last = magnitude(Fraction(text)) - many + 1  # 9.99… may have become 1.00…e+01
            return Rounded(value=text, radius=f"5e{last - 1:+03d}")
    return None


def near_zero(value: Fraction, bound: Fraction, digits: int, size: Fraction) -> Rounded | None:
    """Return 0 ± 10^(−2·digits) times the power of ten in `size`; None if more may be left than
    that.

    `size`: what the number is small against, such as the initial value; 0 counts as 1.

    >>> near_zero(Fraction(0), Fraction(1, 10**20), 8, Fraction(2))
    Rounded(value='0', radius='1e-16')
    """
    exponent = (magnitude(size) if size else 0) - 2 * digits
    if abs(value) + bound > Fraction(10) ** exponent:
        return None
    return Rounded(value="0", radius=f"1e{exponent:+03d}")


def exactly(value: Fraction) -> Rounded:
    """Return a number whose decimals end, with all of them and radius 0.

    >>> exactly(Fraction(-1, 8))
    Rounded(value='-1.25e-01', radius='0')
    """
    if value == 0:
        return Rounded(value="0", radius="0")
    digits = next(n for n in count(1) if _short(value, n))
    return Rounded(value=decimal(value, digits), radius="0")


def _short(value: Fraction, digits: int) -> bool:
    """Return True if a decimal of so many significant digits is that number."""
    if value == 0:
        return True
    units, exponent = rounded_units(value, digits)
    return units * Fraction(10) ** exponent == value
