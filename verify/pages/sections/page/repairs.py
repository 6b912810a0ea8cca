"""What may be claimed in place of each statement that does not hold as it is printed."""

from collections.abc import Sequence
from dataclasses import dataclass

from verify.pages.sections.page_contents import ClaimView, PageContents
from verify.pages.sections.section import ReportSection
from verify.prose import Prose
from verify.scenes.results.claim import Category, ClaimResult

EFFECTS = {
    "": "",
    "none": "Nothing else in the paper changes.",
    "table": "The printed table changes.",
    "conclusion": "A conclusion of the paper changes.",
}


@dataclass(frozen=True)
class RepairView:
    """A statement by its first claim, with what may take its place.

    `repairs`: a claim, the words that may be printed, and a sentence on what else changes or "".
    """

    statement: ClaimView
    repairs: tuple[tuple[ClaimView, Prose, str], ...]


def repaired_words(claim: ClaimResult) -> Prose:
    """Return the words that may stand in place of the repaired statement."""
    return claim.repaired or claim.statement


def repair_views(contents: PageContents) -> Sequence[RepairView]:
    """Return the statements that need a repair, if any claim of the report is one.

    A repair that does not hold itself is left out.
    """
    if not any(claim.result.repairs for claim in contents.claims):
        return []
    first = {c.statement.id: c for c in reversed(contents.claims) if c.statement}
    return [
        RepairView(
            first[statement.id],
            tuple(
                (c, repaired_words(c.result), EFFECTS[c.result.effect])
                for c in contents.claims
                if c.result.repairs == statement.id and c.result.verdict.holds
            ),
        )
        for statement in contents.report.statements
        if statement.category is not Category.AS_MEANT
    ]


SECTION = ReportSection(
    order=6, title="What may be claimed instead", anchor="instead", view=repair_views
)
