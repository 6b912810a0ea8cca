"""One claim of a table with its verdict, the claims on orders and digits, and hints on the right
numbers."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Protocol, Self, TypeVar

from verify.errors import InputError
from verify.integrators.tables.cost import Cost, Severity, cost_of, exact_numbers, severity_of
from verify.prose import Prose
from verify.schemes.printed.condition_set import ConditionSet
from verify.schemes.printed.judgement import Judgement
from verify.schemes.printed.printed_numbers import PrintedNumbers, rounded_to
from verify.schemes.printed.sentences import (
    Details,
    mended_text,
    ruling_on_conditions,
    ruling_on_digits,
    ruling_on_order,
)
from verify.schemes.printed.solutions import Misprint
from verify.verdict import Verdict

_DIGITS_STATEMENT = "every digit is right, to one unit of the last"


@dataclass(frozen=True)
class TableClaim:
    """A claim of a table with its verdict.

    `kind`: the end of its id; `statement`: the claim in words. `evidence`, a sentence, and
    `details` support the verdict. For a mistake, and otherwise None: `severity`, its kind;
    `nearest`, the texts of the nearest exact numbers by name; `cost`, that of the printed ones.
    """

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


# A number that is rounded right is off by half a unit of its last digit; a little more is allowed,
# since the exact number is known to a few digits only.
_ROUNDING_LIMIT = Fraction(51, 100)
T = TypeVar("T", bound=Readable)


def best_reading(table: T, judge: Callable[[T], Judgement]) -> Judgement:
    """Return the judgement of the first reading in which the table holds; if there is none, that of
    the last one, in which short decimals count as rounded, too."""
    readings = table.printed.readings()
    judgement = judge(table.read(readings[0]))
    for numbers in readings[1:]:
        if judgement.holds and judgement.digits is not False:
            return judgement
        judgement = judge(table.read(numbers))
    closely = table.printed.closely
    if judgement.verdict is Verdict.REFUTED and closely.units != readings[-1].units:
        # Of numbers with three decimals ten units are no digits any more, and half a one is.
        close = judge(table.read(closely))
        if close.holds and close.distance is not None and close.distance <= _ROUNDING_LIMIT:
            return close
    return judgement


def order_claims(
    kind: str,
    statement: str,
    judgement: Judgement,
    order: int,
    following: "Callable[[PrintedNumbers], ConditionSet] | None" = None,
    severity: Severity = Severity.WRONG_ORDER,
) -> Iterator[TableClaim]:
    """Yield the claim of an order, and where it holds and numbers are rounded that of their
    digits."""
    next_conditions = None
    if following is not None and judgement.digits is False and judgement.numbers is not None:
        with suppress(InputError):  # beyond the orders that are looked at
            next_conditions = following(judgement.numbers)
    cost = cost_of(judgement, order, next_conditions)
    claim = _add_mistake(
        TableClaim(kind, statement, *ruling_on_order(judgement, order)), judgement, severity, cost
    )
    yield claim
    if (
        claim.verdict is not Verdict.REFUTED
        and judgement.numbers is not None
        and judgement.numbers.units
    ):
        name = "digits" if kind == "order" else f"{kind} digits"
        yield _of_digits(name, _DIGITS_STATEMENT, judgement, severity, cost)


def condition_claims(
    kind: str, statement: str, property_name: str, judgement: Judgement, severity: Severity
) -> Iterator[TableClaim]:
    """Yield a claim of conditions that are of no order; and of their digits, where these are
    wrong."""
    cost = cost_of(judgement, None) if exact_numbers(judgement) else None
    claim = _add_mistake(
        TableClaim(kind, statement, *ruling_on_conditions(judgement, property_name)),
        judgement,
        severity,
        cost,
    )
    yield claim
    if claim.verdict is not Verdict.REFUTED and judgement.digits is False:
        yield _of_digits(
            f"{kind} digits", f"{statement}: {_DIGITS_STATEMENT}", judgement, severity, cost
        )


def _of_digits(
    kind: str, statement: str, judgement: Judgement, severity: Severity, cost: Cost | None
) -> TableClaim:
    claim = TableClaim(kind, statement, *ruling_on_digits(judgement))
    return _add_mistake(claim, judgement, severity_of(judgement, severity), cost)


def _add_mistake(
    claim: TableClaim, judgement: Judgement, severity: Severity | None, cost: Cost | None
) -> TableClaim:
    """Add to a refuted claim what kind of mistake it is, and what would be right."""
    if claim.verdict is not Verdict.REFUTED:
        return claim
    return replace(claim, severity=severity, nearest=nearest_texts(judgement), cost=cost)


def nearest_texts(judgement: Judgement) -> dict[str, str] | None:
    """Format the right numbers, to a few digits more than are printed."""
    numbers, printed = exact_numbers(judgement), judgement.numbers
    if not numbers or printed is None:
        return None
    units = printed.units
    return {
        name: rounded_to(x, units[name] / 10**6).replace("−", "-") if name in units else str(x)
        for name, x in numbers.items()
    }


# -- hints ----------------------------------------------------------------------------------------


class Hints:
    """Hints on what would be right in one table, reported only where all that it claims holds with
    them.

    Where each of several numbers alone would do, all of them are reported, and none is blamed.

    `judge`: its claims with these numbers in place of printed ones.
    """

    def __init__(self, judge: Callable[[Mapping[str, str]], Iterable[TableClaim]] | None) -> None:
        self._judge = judge
        self.misprints: tuple[Misprint, ...] = ()

    def keep_explaining(self, judgement: Judgement) -> Judgement:
        """Return the judgement with the hint that explains all claims, and without one that does
        not."""
        refuted = judgement.verdict is Verdict.REFUTED
        if self._judge is None or not (refuted or judgement.digits is False):
            return judgement
        if not self.misprints:
            texts = ((m, mended_text(judgement, m)) for m in judgement.misprints)
            self.misprints = tuple(m for m, text in texts if self._holds({m.name: text}))
        judgement = replace(judgement, misprints=self.misprints)
        if self.misprints or not refuted or judgement.nearest is None:
            return judgement
        if self._holds(nearest_texts(judgement) or {}):
            return judgement
        return replace(judgement, nearest=None, distance=None)

    def _holds(self, numbers: Mapping[str, str]) -> bool:
        assert self._judge is not None  # noqa: S101 - the caller has looked
        claims = self._judge({name: text.replace("−", "-") for name, text in numbers.items()})
        # Other numbers may have wrong digits.
        return all(x.verdict is not Verdict.REFUTED or x.kind.endswith("digits") for x in claims)


NO_HINTS = Hints(None)
