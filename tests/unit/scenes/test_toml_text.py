"""A scene written as TOML reads back, whatever its texts and the comment above it hold."""

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from tests.examples import drawn
from verify.scenes.scene import Scene, load_scene
from verify.scenes.toml_text import scene_text

SCENE = Scene(
    name="scene",
    title="τ",
    hamiltonian="p**2/2 + a*q**4",
    parameters={"a": "1/3"},
    schemes=("lie2",),
)


def read(text: str, folder: pytest.TempPathFactory) -> Scene:
    path = folder.mktemp("scene") / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return load_scene(path)


@drawn(60)
@given(st.text(st.characters(exclude_categories=("Cs",)), max_size=30))
@example("\x1b]0;x\x07 and \x00, \x7f, \x85, \u2028\nschemes = []")
@example('"""\r\n[grid]')
def test_a_comment_of_any_text_changes_nothing(
    tmp_path_factory: pytest.TempPathFactory, comment: str
) -> None:
    assert read(scene_text(SCENE, comment=comment), tmp_path_factory) == SCENE


@drawn(60)
@given(st.text(st.characters(exclude_categories=("C", "Z")), min_size=1, max_size=30))
@example("quotes \"\\\" and [[tables]] # '''")
def test_a_title_reads_back(tmp_path_factory: pytest.TempPathFactory, title: str) -> None:
    scene = SCENE.model_copy(update={"title": title})
    assert read(scene_text(scene), tmp_path_factory) == scene
