"""What the sections of the page are given: a report, its claims and scenes with their places."""

from dataclasses import dataclass

from verify.pages.sections.claim_view import Anchors, ClaimGroup, ClaimView
from verify.pages.sections.section import Shown
from verify.scenes.results.report import Report, SceneResult


@dataclass(frozen=True)
class SceneView:
    """A scene with its place on the page."""

    result: SceneResult
    anchor: str
    symbols: tuple[str, ...]  # parameters without a value
    floors: str  # a sentence on the step sizes that do not divide the time
    sections: tuple[Shown, ...]


@dataclass(frozen=True)
class Given:
    """`anchors`: those that are taken already."""

    report: Report
    anchors: Anchors
    claims: tuple[ClaimView, ...]
    groups: tuple[ClaimGroup, ...]
    scenes: tuple[SceneView, ...]
