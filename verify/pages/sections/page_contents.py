"""The input of the page's sections: a report, its claims and scenes with their places."""

from dataclasses import dataclass

from verify.pages.sections.claim_view import Anchors, ClaimGroup, ClaimView
from verify.pages.sections.section import VisibleSection
from verify.scenes.results.report import Report, SceneResult


@dataclass(frozen=True)
class SceneView:
    """A scene with its place on the page."""

    result: SceneResult
    anchor: str
    symbols: tuple[str, ...]  # parameters without a value
    rounding_note: str  # a sentence on the step sizes that do not divide the time
    sections: tuple[VisibleSection, ...]


@dataclass(frozen=True)
class PageContents:
    """A report with its claims, groups and scenes; `anchors` holds those in use already."""

    report: Report
    anchors: Anchors
    claims: tuple[ClaimView, ...]
    groups: tuple[ClaimGroup, ...]
    scenes: tuple[SceneView, ...]
