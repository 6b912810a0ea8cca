"""The agreement of a table with the reference data: of a printed number, of a column, and of a run.

A number is compared as finely as it is printed.
"""

import math
import re
import struct
from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import IntEnum
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
    of places does not: only if all cells have the same number of places, and no exponent, is
    that number taken for the precision.

    >>> printing(["0.1000", "0.2500", "3.0000"])
    Printing(digits=None, places=4)
    >>> printing(["0.1", "0.25", "3.14159"])
    Printing(digits=6, places=None)
    """
    cells = {text.strip() for text in texts}
    matches = [match.groups() for match in map(_DIGITS.fullmatch, cells) if match]
    digits = max((len((whole + after).lstrip("0")) for whole, after, _ in matches), default=0)
    if len(matches) < _ENOUGH and digits < _LONG:
        return EXACT
    places = {len(after) for _, after, exponent in matches}
    if len(places) == 1 and places != {0} and not any(exponent for *_, exponent in matches):
        return Printing(None, places.pop())
    return Printing(digits, None)


def number(text: str, name: str) -> Fraction | None:
    """Return the exact value of a cell; None if it is not finite. Raises InputError if it is
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
        return rational(large[1], name) * Fraction(10) ** int(large[2])
    return rational(bare, name)


@dataclass(frozen=True)
class ComparedCell:
    """A submitted number and the published one. `submitted` is None if it is not finite.

    `unit`: what the printing of the submitted one leaves open; `radius`: what that of the
    published one does.
    """

    submitted: Fraction | None
    published: Fraction
    radius: Fraction
    unit: Fraction

    @property
    def distance(self) -> Fraction:
        """The difference of the two beyond what the printing of both leaves open."""
        if self.submitted is None:
            raise ValueError("theirs is not finite")
        return max(Fraction(0), abs(self.submitted - self.published) - self.unit - self.radius)

    @property
    def differs(self) -> bool:
        """True if a printed digit does not agree."""
        return self.submitted is None or self.distance > 0

    @property
    def digits(self) -> float:
        """The number of digits that agree, −log₁₀ of the relative difference; infinite if
        there is no difference."""
        if self.submitted is None:
            return 0.0
        difference = abs(self.submitted - self.published)
        if difference <= self.radius:
            return math.inf
        if self.published == 0:
            return 0.0
        ratio = difference / abs(self.published)
        exponent = magnitude(ratio)
        return max(0.0, -(exponent + math.log10(float(ratio / Fraction(10) ** exponent))))


def cell_of(
    printed: str, published: tuple[Fraction, Fraction], printing: Printing, name: str
) -> ComparedCell:
    """Return the cell of a text; `published`: a value and its radius. Raises InputError if the
    text is no number."""
    value = number(printed, name)
    unit = Fraction(0) if value is None else printing.unit(value)
    return ComparedCell(value, *published, unit)


def is_single(value: Fraction, unit: Fraction) -> bool:
    """Return True if the value is a single-precision number, up to its printing, or one's shortest
    decimal.

    >>> is_single(Fraction("0.100000001490116"), Fraction(0, 1))
    False
    >>> is_single(Fraction("0.100000001490116"), Fraction(1, 10**15))
    True
    """
    nearest = nearest_single(value)
    return nearest is not None and (
        abs(Fraction(float(nearest)) - value) <= unit or _shortest(nearest, value)
    )


def chance_of_single(value: Fraction, unit: Fraction) -> float:
    """Return the probability that a number not of single precision passes for one: those of few
    digits do, and everything that is printed with seven."""
    nearest = nearest_single(value)
    bits = value.denominator.bit_length() + value.numerator.bit_length()
    if nearest is None or bits < _SHORT_BITS:
        return 1.0
    room = 2 * unit  # of the decimals that are no finer than a shortest one, one is
    if _shortest(nearest, value):
        room = Fraction(1, 10 ** len(text(value).partition(".")[2]))
    return min(1.0, max(_LEAST_CHANCE, float(room / Fraction(float(np.spacing(abs(nearest)))))))


def nearest_single(value: Fraction) -> np.float32 | None:
    """Return the single-precision number nearest to a value; None beyond the largest."""
    try:
        nearest = np.float32(struct.unpack("f", struct.pack("f", float(value)))[0])
    except OverflowError:
        return None
    return nearest if np.isfinite(nearest) else None


def _shortest(single: np.float32, value: Fraction) -> bool:
    return Fraction(str(single)) == value


# -- of a column and of a run ---------------------------------------------------------------------

NamedMistake = tuple[str, str]  # a mistake's name, and what it says
DOUBLE, SINGLE = Fraction(1, 2**53), Fraction(1, 2**24)  # unit roundoffs


class ColumnVerdict(IntEnum):
    """The verdict on a column, or on a run, from best to worst."""

    AGREES = 0  # in all digits that are printed
    LOST = 1  # rounding may have taken every digit: nothing is said
    ROUNDING = 2
    PERHAPS = 3  # more than rounding usually does, and less than it may do
    MORE = 4


@dataclass(frozen=True)
class ColumnFindings:
    """The findings on a column of one run: of its `rows`, without those where the run is lost, at
    least `digits` agree, the fewest at `step`.

    `parts_at`: the first step at which it differs by more than rounding.
    """

    verdict: ColumnVerdict
    rows: int
    digits: float
    step: int
    parts_at: int | None


@dataclass
class RunFindings:
    """The findings on one run. `mistakes`: those that fit; one, or several which nothing tells
    apart. `unit`: the unit roundoff that explains it, or would. `lost_from`: the step from which
    rounding may have taken every digit, so that nothing can be said. `overflow_from`: the first
    step of which a number is not finite where doubles may overflow."""

    label: str
    columns: dict[str, ColumnFindings] = field(default_factory=dict)
    mistakes: list[list[NamedMistake]] = field(default_factory=list)
    unit: Fraction = DOUBLE
    lost_from: int | None = None
    overflow_from: int | None = None

    @property
    def verdict(self) -> ColumnVerdict:
        """The worst verdict of its columns."""
        return max((x.verdict for x in self.columns.values()), default=ColumnVerdict.AGREES)


@dataclass
class Fit:
    """The fit of a setting to some columns: a verdict of each, the first place of a column at
    which it fails, and its distance at each place, as far as was looked."""

    verdicts: dict[str, ColumnVerdict]
    parts: dict[str, int] = field(default_factory=dict)
    distances: dict[tuple[int, str], Fraction] = field(default_factory=dict)
    lost_from: int | None = None
    overflow_from: int | None = None

    @property
    def fits(self) -> bool:
        """True if rounding explains all of it."""
        return max(self.verdicts.values(), default=ColumnVerdict.AGREES) <= ColumnVerdict.ROUNDING

    @property
    def place(self) -> tuple[int, str] | None:
        """The first place at which rounding does not usually explain it."""
        return min(((step, name) for name, step in self.parts.items()), default=None)

    def take(self, step: int, name: str, verdict: ColumnVerdict) -> None:
        """Add a verdict on one number, in the order of steps."""
        if verdict >= ColumnVerdict.PERHAPS:
            self.parts.setdefault(name, step)
        self.verdicts[name] = max(self.verdicts[name], verdict)
