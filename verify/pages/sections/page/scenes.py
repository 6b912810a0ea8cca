"""The scenes, each with its own sections."""

from collections.abc import Iterator

from verify.pages.sections.page_contents import SceneView
from verify.pages.sections.section import ContentsEntry, ReportSection

# The contents list the sections of scenes only for at most so many scenes.
_FEW = 3


def _entries(scenes: tuple[SceneView, ...]) -> Iterator[ContentsEntry]:
    for scene in scenes:
        inner = (entry for section in scene.sections for entry in section.entries)
        yield ContentsEntry(
            scene.anchor, scene.result.title, inner=tuple(inner) if len(scenes) <= _FEW else ()
        )


SECTION = ReportSection(
    order=40,
    view=lambda contents: contents.scenes,
    entries=_entries,
    inner=lambda view: (section for scene in view for section in scene.sections),
)
