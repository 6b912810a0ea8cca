"""The requests that were not computed, and why."""

from verify.pages.sections.section import ReportSection

SECTION = ReportSection(
    order=50,
    title="What was left out, and why",
    anchor="left-out",
    view=lambda contents: contents.report.left_out,
)
