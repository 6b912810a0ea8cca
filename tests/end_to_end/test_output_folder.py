"""A report goes into a folder of its own: what is not ours stays as it is."""

from pathlib import Path

import pytest

from tests.end_to_end.test_command_line import here

SCENE = 'hamiltonian = "p**2/2"\nschemes = ["lie1"]\n'


@pytest.mark.parametrize("name", ["index.html", "results.json", "notes.txt", ".hidden"])
def test_a_folder_with_files_that_are_not_ours_is_refused_unless_forced(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, name: str
) -> None:
    scene, folder = tmp_path / "mine.toml", tmp_path / "out"
    scene.write_text(SCENE)
    folder.mkdir()
    (folder / name).write_text('{"title": "mine"}')
    status, _, err = here(capsys, "report", str(scene), "-o", str(folder))
    assert (status, [path.name for path in folder.iterdir()]) == (2, [name])
    assert (folder / name).read_text() == '{"title": "mine"}'
    assert f"holds '{name}', which is not ours" in err
    assert here(capsys, "report", str(scene), "-o", str(folder), "--force")[0] == 0
    assert here(capsys, "report", str(scene), "-o", str(folder))[0] == 0, "it is ours by now"


@pytest.mark.parametrize("path", ["", " "])
@pytest.mark.parametrize(
    "command",
    [
        ["report", "mine.toml", "-o"], ["explore", "-o"], ["reference", "make", "-o"],
        ["bench", "mine.toml", "-o"], ["flow", "mine.toml", "--keep"],
        ["prove", "--system", "pendulum", "--scheme", "lie2", "--certificate"],
    ],
)  # fmt: skip
def test_an_empty_path_is_not_the_current_folder(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    command: list[str], path: str,
) -> None:  # fmt: skip
    (tmp_path / "mine.toml").write_text(SCENE)
    monkeypatch.chdir(tmp_path)
    status, _, err = here(capsys, *command, path)
    assert (status, "is empty; give a path" in err) == (2, True)
    assert [each.name for each in tmp_path.iterdir()] == ["mine.toml"]
