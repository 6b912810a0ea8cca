"""What was asked for and not computed, and why."""

from verify.pages.sections.section import Section

SECTION = Section(
    order=50,
    title="What was left out, and why",
    anchor="left-out",
    view=lambda given: given.report.left_out,
)
