"""Commands and suites are found by themselves."""

from pathlib import Path

import pytest

from verify.commands import Commands, main
from verify.commands.reference import reference
from verify.commands.reference_compare import compare
from verify.commands.shared import input as given


def test_each_is_called_as_its_file_and_what_it_shares_is_none() -> None:
    found = {command.name for command in Commands().values()}
    assert found == set(main.cli.commands) == set(Commands())
    assert {"run", "check-integrator", "reference"} <= found
    assert not found & {"input", "output", "tasks", "compare", "hunt"}
    assert compare in reference.commands.values()
    for name in ("reference-compare", "main", "nothing"):
        assert name not in main.cli.commands


def test_a_folder_with_a_title_is_a_suite(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert given.suites()["stiff"] == "Stiff scenes, judged"
    folder = tmp_path / "reports" / "suites" / "mine"
    folder.mkdir(parents=True)
    monkeypatch.setattr(given, "content", lambda *names: tmp_path.joinpath(*names))
    assert given.suites() == {}
    (folder / "title.txt").write_text("Mine\n")
    assert given.suites() == {"mine": "Mine"}
    (folder / "one.toml").write_text('system = "duffing"\nschemes = ["lie2"]\n')
    title, scenes, claims = given.load_target("mine")
    assert (title, [scene.name for scene in scenes], claims) == ("Mine", ["one"], None)
