"""What does not hold, by the library that claims it: of a report whose refutations have a severity.

First what matters; the last digits of tables are counted alone.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from verify.pages.sections.claim_view import ClaimView
from verify.verdict import Verdict

_DIGITS = "digits"  # how a severity begins that is counted alone
_NAMED = 6  # methods of a kind that are named


@dataclass(frozen=True)
class Mistake:
    """One kind of mistake in one library: some of the claims, and how many more there are."""

    severity: str
    named: tuple[ClaimView, ...]
    more: int


@dataclass(frozen=True)
class WrongLibrary:
    """`name`: as its section is called."""

    name: str
    mistakes: tuple[Mistake, ...]


@dataclass(frozen=True)
class Wrong:
    """`digits`: tables of which last digits alone are wrong, by library; `right`: libraries of
    which nothing is refuted."""

    libraries: tuple[WrongLibrary, ...]
    digits: tuple[tuple[str, int], ...]
    right: tuple[str, ...]


def wrong_of(claims: Sequence[ClaimView]) -> Wrong | None:
    """None where no refuted claim has a severity."""
    refuted = [c for c in claims if c.result.verdict is Verdict.REFUTED and c.result.severity]
    if not refuted:
        return None
    grave = [c for c in refuted if not c.result.severity.startswith(_DIGITS)]
    sections = dict.fromkeys(c.result.section for c in grave)
    slight = Counter(_name(c.result.section) for c in refuted if c not in grave)
    touched = {c.result.section for c in refuted}
    every = dict.fromkeys(c.result.section for c in claims)
    return Wrong(
        tuple(
            WrongLibrary(
                _name(section), _mistakes([c for c in grave if c.result.section == section])
            )
            for section in sections
        ),
        tuple(slight.items()),
        tuple(_name(section) for section in every if section not in touched),
    )


def _name(section: str) -> str:
    return section.removesuffix(", printed tables")


def _mistakes(claims: Sequence[ClaimView]) -> tuple[Mistake, ...]:
    found = []
    for severity in dict.fromkeys(c.result.severity for c in claims):
        first = {c.result.source: c for c in reversed(claims) if c.result.severity == severity}
        own = [c for c in claims if c is first.get(c.result.source)]
        found.append(Mistake(severity, tuple(own[:_NAMED]), max(len(own) - _NAMED, 0)))
    return tuple(found)
