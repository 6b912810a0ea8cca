"""`verify init`: the files to begin with are right as they are."""

from pathlib import Path

import pytest

from verify.commands.main import main

ANSWERS = {
    "claims": ("check {}", "4 claims: 3 PROVED, 1 ENCLOSED"),
    "scene": ("plan {}", "10 tasks"),
    "table": ("check-table {}", "4 claims: 4 PROVED"),
}


@pytest.mark.parametrize("kind", ANSWERS)
def test_a_file_to_begin_with_is_taken(
    kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    command, answer = ANSWERS[kind]
    main(["init", kind, "-o", "mine.toml"])
    text = (tmp_path / "mine.toml").read_text("utf-8")
    assert f"verify {command.format('mine.toml')}" in text, "its own name stands in it"
    assert "verify" in capsys.readouterr().out
    main(command.format("mine.toml").split())
    assert answer in capsys.readouterr().out


def test_nothing_is_written_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.toml").write_text("mine", "utf-8")
    with pytest.raises(SystemExit, match="2"):
        main(["init", "scene"])
    assert "is there already; give another with -o" in capsys.readouterr().err
    assert (tmp_path / "scene.toml").read_text("utf-8") == "mine"
