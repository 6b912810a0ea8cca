"""The claims, by section of the paper; each opens to its evidence, numbers and argument."""

from verify.pages.sections.claim_view import ClaimGroup
from verify.pages.sections.given import Given
from verify.pages.sections.section import Entry, Section


def _view(given: Given) -> tuple[ClaimGroup, ...] | None:
    return given.groups or None


SECTION = Section(
    order=10,
    title="Claims",
    anchor="claims",
    view=_view,
    entries=lambda view: (Entry(g.anchor, g.title, g.counts) for g in view if g.title),
)
