"""`verify report integrators`: the page, the results and JSON alone on standard output."""

import json
from importlib.machinery import ModuleSpec
from pathlib import Path

import pytest

from verify.commands.main import main
from verify.integrators.others import libraries as others
from verify.integrators.others import printed_libraries


@pytest.fixture(autouse=True)
def without_libraries(monkeypatch: pytest.MonkeyPatch) -> None:
    """As where the extra `peers` is not installed."""
    nothing: ModuleSpec | None = None
    monkeypatch.setattr(others, "find_spec", lambda name: nothing)
    # The tables that libraries have in their sources take most of a minute; they have tests below.
    monkeypatch.setattr(printed_libraries, "files", list)


def run(*arguments: str) -> int:
    try:
        main(["report", "integrators", *arguments])
    except SystemExit as done:
        return int(done.code or 0)
    return 0


def test_the_report_is_written_and_json_stands_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "out"
    assert run("-o", str(folder), "--json", "--format", "html", "--format", "md") == 0
    printed = json.loads(capsys.readouterr().out)
    kept = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    assert kept["claims"] == printed["claims"]
    assert {"id", "verdict", "evidence"} <= set(printed["claims"][0])
    page = (folder / "index.html").read_text(encoding="utf-8")
    for text in ("Installed here: none", "Left out, as not installed: ", "rebound", "galpy"):
        assert text in page
    assert "def step(p, q, h):" in page, "a refuted table has its reproduction"
    assert "```python" in (folder / "report.md").read_text(encoding="utf-8")


def test_the_first_lines_say_what_is_installed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    tables = others.get("literature")
    one = [x for x in tables.integrators() if x.name == "OrdinaryDiffEq McAte4"]
    monkeypatch.setattr(tables, "integrators", lambda: one)
    assert run("-o", str(tmp_path / "out")) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("Installed here: none")
    assert lines[1].startswith("Left out, as not installed: galpy")
    assert lines[2].startswith("Not as claimed: printed tables: ")


def test_a_cluster_is_bad_input(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("-o", str(tmp_path / "out"), "--cluster", "tcp://127.0.0.1:1") == 2
    assert "--cluster" in capsys.readouterr().err


def test_help_names_it(capsys: pytest.CaptureFixture[str]) -> None:
    main(["report", "--help"])
    assert "`integrators`" in capsys.readouterr().out
