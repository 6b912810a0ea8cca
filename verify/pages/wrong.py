"""The refuted claims by library, for a report whose refutations have a severity.

Grave mistakes come first; tables that are wrong in their last digits only are counted.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from verify.pages.sections.claim_view import ClaimView
from verify.verdict import Verdict

# Severities that begin so are about the last digits of tables; they are counted, not named.
_DIGITS = "digits"
# At most so many methods are named for each kind of mistake; the others are counted.
_MAX_NAMED = 6


@dataclass(frozen=True)
class MistakeKind:
    """One kind of mistake in one library: some of the claims, and how many more there are."""

    severity: str
    claims: tuple[ClaimView, ...]
    more_count: int


@dataclass(frozen=True)
class WrongLibrary:
    """The mistakes of one library; `name` is the title of its section."""

    name: str
    mistakes: tuple[MistakeKind, ...]


@dataclass(frozen=True)
class Wrong:
    """The mistakes of all libraries.

    `digits`: by library, the number of tables whose last digits alone are wrong; `faultless`: the
    libraries without a refuted claim.
    """

    libraries: tuple[WrongLibrary, ...]
    digits: tuple[tuple[str, int], ...]
    faultless: tuple[str, ...]


def find_mistakes(claims: Sequence[ClaimView]) -> Wrong | None:
    """Return the mistakes by library, or None where no refuted claim has a severity."""
    refuted = [c for c in claims if c.result.verdict is Verdict.REFUTED and c.result.severity]
    if not refuted:
        return None
    grave = [c for c in refuted if not c.result.severity.startswith(_DIGITS)]
    sections = dict.fromkeys(c.result.section for c in grave)
    # The order of the sections is that of the claims, since dictionaries keep their order.
    slight = Counter(_name(c.result.section) for c in refuted if c not in grave)
    touched = {c.result.section for c in refuted}
    all_sections = dict.fromkeys(c.result.section for c in claims)
    return Wrong(
        tuple(
            WrongLibrary(
                _name(section), _mistakes([c for c in grave if c.result.section == section])
            )
            for section in sections
        ),
        tuple(slight.items()),
        tuple(_name(section) for section in all_sections if section not in touched),
    )


def _name(section: str) -> str:
    return section.removesuffix(", printed tables")


def _mistakes(claims: Sequence[ClaimView]) -> tuple[MistakeKind, ...]:
    mistakes = []
    for severity in dict.fromkeys(c.result.severity for c in claims):
        # Of several claims with one source and severity the first is named.
        first = {c.result.source: c for c in reversed(claims) if c.result.severity == severity}
        sources = [c for c in claims if c is first.get(c.result.source)]
        mistakes.append(
            MistakeKind(severity, tuple(sources[:_MAX_NAMED]), max(len(sources) - _MAX_NAMED, 0))
        )
    return tuple(mistakes)
