"""The findings on a run of theirs: how each column differs, and which mistakes fit."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from fractions import Fraction

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
class Spread:
    """The distance by which rounding moves a number, in units of roundoff or not: usually, and
    at worst."""

    usual: float | Fraction
    worst: float | Fraction


Spreads = Mapping[str, Spread]  # by the number's column


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
