"""What is told of one claim of a table, the claims that orders and digits make, and hints."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Protocol, Self, TypeVar

from verify.errors import InputError
from verify.integrators.tables.cost import Cost, Severity, cost_of, exact_numbers, severity_of
from verify.prose import Prose
from verify.schemes.printed.asked import Asked
from verify.schemes.printed.judged import Judged, Misprint
from verify.schemes.printed.printed_numbers import PrintedNumbers, rounded_to
from verify.schemes.printed.sentences import (
    Details,
    mended_text,
    of_conditions,
    of_digits,
    of_printed,
)
from verify.verdict import Verdict

_DIGITS = "every digit is right, to one unit of the last"


@dataclass(frozen=True)
class TableClaim:
    """`kind` is the end of its id. `severity`, `nearest` and `cost` are of what is wrong, and None
    where nothing is; `nearest` are texts of exact numbers, by name."""

    kind: str
    statement: str
    verdict: Verdict
    evidence: Prose
    details: Details = ()
    severity: Severity | None = None
    nearest: dict[str, str] | None = None
    cost: Cost | None = None


class Readable(Protocol):
    """A table whose decimals may be read in more than one way."""

    @property
    def printed(self) -> PrintedNumbers: ...

    def read(self, numbers: PrintedNumbers) -> Self: ...


_HALF = Fraction(51, 100)  # of a unit, to which a number is rounded, as far as it is known
T = TypeVar("T", bound=Readable)


def best_reading(table: T, found: Callable[[T], Judged]) -> Judged:
    """As the table holds, if it does in one of its readings; else as it is read last, with short
    decimals taken for rounded, too."""
    readings = table.printed.readings()
    told = found(table.read(readings[0]))
    for numbers in readings[1:]:
        if told.holds and told.digits is not False:
            return told
        told = found(table.read(numbers))
    closely = table.printed.closely
    if told.verdict is Verdict.REFUTED and closely.units != readings[-1].units:
        # Of numbers with three decimals ten units are no digits any more, and half a one is.
        other = found(table.read(closely))
        if other.holds and other.off is not None and other.off <= _HALF:
            return other
    return told


def order_claims(
    kind: str,
    statement: str,
    found: Judged,
    order: int,
    following: "Callable[[PrintedNumbers], Asked] | None" = None,
    severity: Severity = Severity.WRONG_ORDER,
) -> Iterator[TableClaim]:
    """The claim of an order, and where it holds and numbers are rounded that of their digits."""
    after = None
    if following is not None and found.digits is False and found.read is not None:
        with suppress(InputError):  # beyond the orders that are looked at
            after = following(found.read)
    cost = cost_of(found, order, after)
    claim = _told(TableClaim(kind, statement, *of_printed(found, order)), found, severity, cost)
    yield claim
    if claim.verdict is not Verdict.REFUTED and found.read is not None and found.read.units:
        name = "digits" if kind == "order" else f"{kind} digits"
        yield _of_digits(name, _DIGITS, found, severity, cost)


def condition_claims(
    kind: str, statement: str, what: str, found: Judged, severity: Severity
) -> Iterator[TableClaim]:
    """A claim of conditions that are of no order; and of their digits, where these are wrong."""
    cost = cost_of(found, None) if exact_numbers(found) else None
    claim = _told(TableClaim(kind, statement, *of_conditions(found, what)), found, severity, cost)
    yield claim
    if claim.verdict is not Verdict.REFUTED and found.digits is False:
        yield _of_digits(f"{kind} digits", f"{statement}: {_DIGITS}", found, severity, cost)


def _of_digits(
    kind: str, statement: str, found: Judged, severity: Severity, cost: Cost | None
) -> TableClaim:
    claim = TableClaim(kind, statement, *of_digits(found))
    return _told(claim, found, severity_of(found, severity), cost)


def _told(
    claim: TableClaim, found: Judged, severity: Severity | None, cost: Cost | None
) -> TableClaim:
    """The claim, where it is refuted with what kind of mistake that is, and what would be right."""
    if claim.verdict is not Verdict.REFUTED:
        return claim
    return replace(claim, severity=severity, nearest=nearest_texts(found), cost=cost)


def nearest_texts(found: Judged) -> dict[str, str] | None:
    """To a few digits more than are printed."""
    numbers, read = exact_numbers(found), found.read
    if not numbers or read is None:
        return None
    units = read.units
    return {
        name: rounded_to(x, units[name] / 10**6).replace("−", "-") if name in units else str(x)
        for name, x in numbers.items()
    }


# -- hints ----------------------------------------------------------------------------------------


class Hints:
    """At what would be right in one table: told only where all that it claims holds with them.

    Where each of several numbers alone would do, all of them are told, and none is blamed.

    `again`: its claims with these numbers in place of printed ones."""

    def __init__(self, again: Callable[[Mapping[str, str]], Iterable[TableClaim]] | None) -> None:
        self._again = again
        self.some: tuple[Misprint, ...] = ()

    def kept(self, found: Judged) -> Judged:
        """What was found, with the hint that explains all claims, and without one that does not."""
        refuted = found.verdict is Verdict.REFUTED
        if self._again is None or not (refuted or found.digits is False):
            return found
        if not self.some:
            each = ((m, mended_text(found, m)) for m in found.misprints)
            self.some = tuple(m for m, text in each if self._holds({m.name: text}))
        found = replace(found, misprints=self.some)
        if self.some or not refuted or found.nearest is None:
            return found
        if self._holds(nearest_texts(found) or {}):
            return found
        return replace(found, nearest=None, off=None)

    def _holds(self, numbers: Mapping[str, str]) -> bool:
        assert self._again is not None  # noqa: S101 - the caller has looked
        made = self._again({name: text.replace("−", "-") for name, text in numbers.items()})
        # Other numbers may have wrong digits.
        return all(x.verdict is not Verdict.REFUTED or x.kind.endswith("digits") for x in made)


NO_HINTS = Hints(None)
