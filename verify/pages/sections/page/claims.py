"""The claims, by section of the paper; each opens to its evidence, numbers and argument."""

from verify.pages.sections.section import ContentsEntry, ReportSection

SECTION = ReportSection(
    order=10,
    title="Claims",
    anchor="claims",
    view=lambda contents: contents.groups,
    entries=lambda view: (ContentsEntry(g.anchor, g.title, g.counts) for g in view if g.title),
)
