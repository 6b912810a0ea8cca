"""Compare a printed number with a known one: how many digits agree, and how fine the printing
is."""

import math
import re
import struct
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from verify.arithmetic.exact import magnitude, rational, text

_NOT_FINITE = {"nan", "inf", "infinity"}
_DIGITS = re.compile(r"[+-]?([0-9]*)\.?([0-9]*)(?:[eEdD]([+-]?[0-9]+))?")
_ENOUGH, _LONG = 3, 7  # cells, and digits of one
_SHORT_BITS = 16
_LEAST_CHANCE = 0.01  # that a number is one of single precision by chance
_FORTRAN = re.compile(r"[+-]?[0-9.]+[dD][+-]?[0-9]+")
_LARGE = re.compile(r"(.+)[eE]([+-]?[0-9]{4,5})")  # beyond what a user's input may have
_HEXADECIMAL = re.compile(r"[+-]?0[xX].{1,60}")


@dataclass(frozen=True)
class Printing:
    """The printing of a column: so many significant digits, or so many after the point; or
    exact."""

    digits: int | None
    places: int | None

    def unit(self, value: Fraction) -> Fraction:
        """Return a unit of the last place of a number so printed: it may be cut or rounded."""
        if self.places is not None:
            return Fraction(1, 10**self.places)
        if self.digits is None or value == 0:
            return Fraction(0)
        return Fraction(10) ** (magnitude(value) - self.digits + 1)


EXACT = Printing(None, None)


def printing(texts: Iterable[str]) -> Printing:
    """Return the printing of a column, from its cells; exact, where they are too few and too short
    to tell.

    A language's shortest decimal drops zeros, and a format with an exponent or with a fixed number
    of places does not: only where all cells have the same number of places, and no exponent, is
    that number taken for the precision.

    >>> printing(["0.1000", "0.2500", "3.0000"])
    Printing(digits=None, places=4)
    >>> printing(["0.1", "0.25", "3.14159"])
    Printing(digits=6, places=None)
    """
    cells = {text.strip() for text in texts}
    matches = [match.groups() for match in map(_DIGITS.fullmatch, cells) if match]
    most = max((len((whole + after).lstrip("0")) for whole, after, _ in matches), default=0)
    if len(matches) < _ENOUGH and most < _LONG:
        return EXACT
    places = {len(after) for _, after, exponent in matches}
    if len(places) == 1 and places != {0} and not any(exponent for *_, exponent in matches):
        return Printing(None, places.pop())
    return Printing(most, None)


def number(text: str, what: str) -> Fraction | None:
    """Return the exact value of a cell; None where it is not finite. Raises InputError where it is
    no number.

    Hexadecimal floats, as C prints them with %a, are numbers, too, and Fortran's 1.5D+00; exponents
    may be as large as those of the reference data, which go beyond ±1000.

    >>> number("0x1.8p+1", "p"), number("1.5D+00", "p"), number("nan", "p")
    (Fraction(3, 1), Fraction(3, 2), None)
    """
    bare = text.strip()
    if bare.lstrip("+-").casefold() in _NOT_FINITE:
        return None
    if _HEXADECIMAL.fullmatch(bare):
        try:
            return Fraction(float.fromhex(bare))
        except (ValueError, OverflowError):
            pass
    bare = bare.upper().replace("D", "E") if _FORTRAN.fullmatch(bare) else bare
    large = _LARGE.fullmatch(bare)
    if large and large[1].isascii():
        return rational(large[1], what) * Fraction(10) ** int(large[2])
    return rational(bare, what)


@dataclass(frozen=True)
class Cell:
    """One number of theirs and ours. `theirs` is None where it is not finite.

    `unit`: what their printing leaves open; `radius`: what ours does.
    """

    theirs: Fraction | None
    ours: Fraction
    radius: Fraction
    unit: Fraction

    @property
    def distance(self) -> Fraction:
        """The difference of the two beyond what the printing of both leaves open."""
        if self.theirs is None:
            raise ValueError("theirs is not finite")
        return max(Fraction(0), abs(self.theirs - self.ours) - self.unit - self.radius)

    @property
    def differs(self) -> bool:
        """True if a printed digit does not agree."""
        return self.theirs is None or self.distance > 0

    @property
    def digits(self) -> float:
        """The number of digits that agree, −log₁₀ of the relative difference; infinite where
        there is no difference."""
        if self.theirs is None:
            return 0.0
        difference = abs(self.theirs - self.ours)
        if difference <= self.radius:
            return math.inf
        if self.ours == 0:
            return 0.0
        ratio = difference / abs(self.ours)
        exponent = magnitude(ratio)
        return max(0.0, -(exponent + math.log10(float(ratio / Fraction(10) ** exponent))))


def cell_of(theirs: str, ours: tuple[Fraction, Fraction], how: Printing, what: str) -> Cell:
    """Return the cell of a text; `ours`: a value and its radius. Raises InputError where the
    text is no number."""
    value = number(theirs, what)
    unit = Fraction(0) if value is None else how.unit(value)
    return Cell(value, *ours, unit)


def is_single(value: Fraction, unit: Fraction) -> bool:
    """Return True if the value is a single-precision number, up to its printing, or one's shortest
    decimal.

    >>> is_single(Fraction("0.100000001490116"), Fraction(0, 1))
    False
    >>> is_single(Fraction("0.100000001490116"), Fraction(1, 10**15))
    True
    """
    near = nearest_single(value)
    return near is not None and (
        abs(Fraction(float(near)) - value) <= unit or _shortest(near, value)
    )


def chance_of_single(value: Fraction, unit: Fraction) -> float:
    """Return the probability that a number not of single precision passes for one: those of few
    digits do, and everything that is printed with seven."""
    near = nearest_single(value)
    bits = value.denominator.bit_length() + value.numerator.bit_length()
    if near is None or bits < _SHORT_BITS:
        return 1.0
    room = 2 * unit  # of the decimals that are no finer than a shortest one, one is
    if _shortest(near, value):
        room = Fraction(1, 10 ** len(text(value).partition(".")[2]))
    return min(1.0, max(_LEAST_CHANCE, float(room / Fraction(float(np.spacing(abs(near)))))))


def nearest_single(value: Fraction) -> np.float32 | None:
    """Return the single-precision number nearest to a value; None beyond the largest."""
    try:
        near = np.float32(struct.unpack("f", struct.pack("f", float(value)))[0])
    except OverflowError:
        return None
    return near if np.isfinite(near) else None


def _shortest(single: np.float32, value: Fraction) -> bool:
    return Fraction(str(single)) == value
