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


REFERENCE = """[[reference]]
step_sizes = ["1/8"]
initial_values = [{ q = 0, p = 2 }]
steps = [0, 1]
digits = 9
"""


@pytest.mark.parametrize("name", ["manifest.json", "mine.json", "notes.txt"])
def test_reference_data_replace_none_but_reference_data(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, name: str
) -> None:
    scene, folder = tmp_path / "mine.toml", tmp_path / "out"
    scene.write_text(SCENE + REFERENCE)
    folder.mkdir()
    (folder / name).write_text('{"title": "mine"}')
    status, _, err = here(capsys, "reference", "make", str(scene), "-o", str(folder))
    assert (status, [path.name for path in folder.iterdir()]) == (2, [name])
    assert (folder / name).read_text() == '{"title": "mine"}'
    assert f"holds '{name}', which does not belong to these data" in err
    (folder / name).unlink()
    for _ in range(2):
        assert here(capsys, "reference", "make", str(scene), "-o", str(folder))[0] == 0


def test_a_hunt_writes_into_a_folder_of_its_own(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    hunt = ("explore", "--maximise", "growth", "--examples", "4", "--seed", "1", "--steps", "5")
    (tmp_path / "index.html").write_text("mine")
    status, _, err = here(capsys, *hunt, "-o", str(tmp_path))
    assert (status, (tmp_path / "index.html").read_text()) == (2, "mine")
    assert "holds 'index.html', which is not ours; take another folder" in err
    (tmp_path / "index.html").rename(tmp_path / "area-formula.0123abcd.toml")  # as explore names it
    for _ in range(2):
        assert here(capsys, *hunt, "-o", str(tmp_path))[0] == 0


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
