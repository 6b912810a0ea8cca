"""`verify report integrators`: the page, the results and JSON alone on standard output."""

import json
from importlib.machinery import ModuleSpec
from pathlib import Path

import pytest

from verify.audits import libraries as others
from verify.audits import library_claims
from verify.commands.main import main


@pytest.fixture(autouse=True)
def without_libraries(monkeypatch: pytest.MonkeyPatch) -> None:
    """As where the extra `peers` is not installed."""
    nothing: ModuleSpec | None = None
    monkeypatch.setattr(others, "find_spec", lambda name: nothing)
    # The tables that libraries have in their sources take most of a minute; they have tests below.
    monkeypatch.setattr(library_claims, "files", list)
    tables = others.get("literature")
    few = [x for x in tables.integrators() if x.name.startswith(("Ruth", "Yoshida 8, solution E"))]
    monkeypatch.setattr(tables, "integrators", lambda: few)


def run(*arguments: str) -> int:
    try:
        # In this process, where what is hidden stays hidden.
        main(["report", "integrators", "--workers", "1", *arguments])
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
    assert "def parts(" in page, "a refuted table has its reproduction"
    assert "```python" in (folder / "report.md").read_text(encoding="utf-8")


def test_the_first_lines_say_what_is_installed_and_what_is_wrong(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("-o", str(tmp_path / "out")) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("Installed here: none")
    assert lines[1].startswith("Left out, as not installed: ")
    assert {"galpy", "OpenMM"} <= {*lines[1].removesuffix(".").replace(":", ",").split(", ")}
    assert lines[2].startswith("Of 6 claims 2 are refuted: 1 of digits that a double notices, 1 of")


def test_findings_are_of_what_was_judged_and_the_rest_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    notes = tmp_path / "notes"
    assert run("-o", str(tmp_path / "out"), "--findings", str(notes), "--json") == 0
    told = capsys.readouterr()
    json.loads(told.out)
    assert list(notes.iterdir()) == [], "none of them is told of these few tables"
    assert told.err.count(".md is not written: none of its claims was judged") >= 15


def test_findings_are_of_integrators_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        main(["report", "stiff", "--findings", str(tmp_path / "notes")])
    assert "--findings" in capsys.readouterr().err


def test_a_cluster_is_bad_input(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("-o", str(tmp_path / "out"), "--cluster", "tcp://127.0.0.1:1") == 2
    assert "--cluster" in capsys.readouterr().err


def test_help_names_it(capsys: pytest.CaptureFixture[str]) -> None:
    main(["report", "--help"])
    assert "`integrators`" in capsys.readouterr().out
