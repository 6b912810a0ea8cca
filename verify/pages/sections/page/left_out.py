"""The requests that were not computed, and why."""

from verify.pages.sections.section import ReportSection
from verify.scenes.results.report import Report

LeftOut = tuple[str, tuple[tuple[str, str], ...]]


def _groups(report: Report) -> tuple[LeftOut, LeftOut]:
    """Return what of the paper has no claim, and what was not computed, each with its heading."""
    computed = tuple(entry for entry in report.left_out if entry not in report.not_claimed)
    heading = "Of what could be computed" if report.not_claimed else ""
    return ("Of the paper", report.not_claimed), (heading, computed)


def _holds_any(group: LeftOut) -> bool:
    return bool(group[1])


SECTION = ReportSection(
    order=50,
    title="What was left out, and why",
    anchor="left-out",
    view=lambda contents: tuple(filter(_holds_any, _groups(contents.report))),
)
