"""The scenes, each with its own sections."""

from collections.abc import Iterator

from verify.pages.sections.page_contents import SceneView
from verify.pages.sections.section import Entry, Section

# The contents list the sections of scenes only for at most so many scenes.
_FEW = 3


def _entries(scenes: tuple[SceneView, ...]) -> Iterator[Entry]:
    for scene in scenes:
        inner = (entry for each in scene.sections for entry in each.entries)
        yield Entry(
            scene.anchor, scene.result.title, inner=tuple(inner) if len(scenes) <= _FEW else ()
        )


SECTION = Section(
    order=40,
    view=lambda contents: contents.scenes,
    entries=_entries,
    inner=lambda view: (each for scene in view for each in scene.sections),
)
