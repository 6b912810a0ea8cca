"""`verify report CLAIMS.toml`: a page on somebody's paper, its judgement to paste, an erratum."""

import json
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.end_to_end.test_command_line import here
from verify.scenes.results.report import Report, read_report

CLAIMS = """
title = "“A scheme”: what holds of it"
about = ["The paper: A. Author, “A scheme”, 2026."]
[defaults]
scheme = "lie2"
system = "pendulum"
[[claim]]
id = "eq-7"
source = "Eq. 7"
statement = "The defect of one step is `ΔJ = O(h^4)`."
kind = "defect_order"
defect_order = 4
[[claim]]
id = "eq-7-right"
source = "On Eq. 7"
statement = "The defect of one step is `ΔJ = O(h^3)`, and no smaller."
standing = "ours"
repairs = "eq-7"
effect = "conclusion"
kind = "defect_order"
defect_order = 3
[[claim]]
id = "Table_1"
source = "Table 1"
statement = "The lg of the MSE."
kind = "table"
time = 3
step_sizes = [0.1, 0.05]
initial_values = [{ q = 1.5, p = 0 }]
printed = ["-1.0000", "-2.0000"]
[[claim]]
id = "eq-8"
source = "Eq. 8"
statement = "The scheme is of order 2."
kind = "convergence_order"
convergence_order = 2
[[cause]]
says = "Both count one step too few."
explains = ["eq-7", "Table_1"]
disfavours = "The authors, who do better."
origin = "The first step was left out."
[[assumption]]
says = "The runs end at `T` = 3."
silence = "No time is printed."
decides = [{ claim = "Table_1", otherwise = "eq-8" }]
[[left_out]]
what = "Section 9"
why = "It states nothing."
"""
SCENE = '[[scene]]\nname = "swing"\ntitle = "A swing"\nsystem = "pendulum"\nschemes = ["lie2"]\n'
OF_SCENE = f'{SCENE}[[claim]]\nid = "a"\nscene = "swing"\nscheme = "lie2"\n'
WITHOUT_READINGS = f'{OF_SCENE}kind = "defect_order"\ndefect_order = 3\n'
ERRATA = ["errata.tex", "errata.md", "editor.html", "table-1.py"]
COUNTS = (
    "3 statements of the paper, in 3 readings: 1 holds as meant, 2 are refuted in every reading; 1 "
    "more claim is ours"
)
Call = Callable[..., tuple[int, str, str]]


@pytest.fixture
def call(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Call:
    """Types `verify report` with these arguments in the folder of the claims."""
    monkeypatch.chdir(tmp_path)
    Path("mine.toml").write_text(CLAIMS, encoding="utf-8")
    return lambda *arguments: here(capsys, "report", *arguments)


def report_in(folder: str) -> Report:
    return read_report(Path(folder) / "results.json")


def text_of(path: str) -> str:
    return Path(path).read_text(encoding="utf-8")


# -- the page -------------------------------------------------------------------------------------


def test_a_file_of_claims_becomes_a_page_that_has_its_name(call: Call) -> None:
    status, out, err = call("mine.toml")
    assert (status, err) == (0, "")
    assert out.splitlines()[-2] == COUNTS
    assert {f.name for f in Path("mine-report").iterdir()} == {"index.html", "results.json", "kept"}
    page = text_of("mine-report/index.html")
    assert "“A scheme”: what holds of it" in page
    assert "A. Author, “A scheme”, 2026." in page


def test_the_results_have_what_the_file_says_of_its_paper(call: Call) -> None:
    assert call("mine.toml", "-o", "page")[0] == 0
    report = report_in("page")
    assert [(c.id, c.verdict, c.repairs, c.effect) for c in report.claims] == [
        ("eq-7", "REFUTED", "", ""), ("eq-7-right", "PROVED", "eq-7", "conclusion"),
        ("Table_1", "REFUTED", "", ""), ("eq-8", "PROVED", "", ""),
    ]  # fmt: skip
    (cause,) = report.causes
    assert (cause.disfavours, cause.origin) == (
        "The authors, who do better.", "The first step was left out.",
    )  # fmt: skip
    assert [assumption.says for assumption in report.assumptions] == ["The runs end at T = 3."]
    assert report.not_claimed == (("Section 9", "It states nothing."),)
    assert report.preface == ("The paper: A. Author, “A scheme”, 2026.",)


def test_a_judgement_to_paste_is_markdown(call: Call) -> None:
    status, out, err = call("mine.toml", "-o", "page", "--format", "md")
    assert (status, err) == (0, "")
    assert "page/report.md" in out
    assert not Path("page/index.html").exists()
    text = text_of("page/report.md")
    for sentence in ("The first step was left out.", "No time is printed.", "It states nothing."):
        assert sentence in text


def test_the_json_is_the_report(call: Call) -> None:
    status, out, err = call("mine.toml", "-o", "page", "--json")
    assert (status, err) == (0, "")
    assert json.loads(out) == json.loads(text_of("page/results.json"))


@pytest.mark.parametrize(("names", "titles"), [("", ["A swing"]), ("report_scenes = []\n", [])])
def test_the_page_shows_the_scenes_of_the_file(call: Call, names: str, titles: list[str]) -> None:
    Path("mine.toml").write_text(names + WITHOUT_READINGS)
    assert call("mine.toml", "-o", "page")[0] == 0
    assert [scene.title for scene in report_in("page").scenes] == titles
    assert ("A swing" in text_of("page/index.html")) == bool(titles)


def test_a_second_call_takes_up_what_is_kept_and_says_the_same(call: Call) -> None:
    def results() -> list[Any]:
        return [claim.model_dump() for claim in report_in("page").claims]

    assert call("mine.toml", "-o", "page")[0] == 0
    first = results()
    assert call("mine.toml", "-o", "page")[0] == 0
    assert report_in("page").provenance.computed == 0
    assert results() == first


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("defect_order = 4", "order = 4"), "mine.toml:12: claim eq-7: order=4: unknown key"),
        (('repairs = "eq-7"', 'repairs = "eq-9"'), "mine.toml:18: claim eq-7-right: repairs=eq-9"),
        (('otherwise = "eq-8"', 'otherwise = "b"'), "mine.toml:42: assumption: decides=b: is no"),
    ],
)
def test_a_mistake_in_the_file_is_named_with_its_line(
    call: Call, change: tuple[str, str], message: str
) -> None:
    Path("mine.toml").write_text(CLAIMS.replace(*change), encoding="utf-8")
    status, out, err = call("mine.toml", "-o", "page")
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert err.startswith(f"verify: {message}")
    assert not Path("page").exists()


# -- the erratum ----------------------------------------------------------------------------------


def test_an_erratum_is_two_texts_a_page_and_a_program_for_each_refuted_table(call: Call) -> None:
    status, out, err = call("mine.toml", "-o", "page", "--errata", "errata")
    assert (status, err) == (0, "")
    assert sorted(f.name for f in Path("errata").iterdir()) == sorted(ERRATA)
    written = ", ".join(["page/index.html", *(f"errata/{name}" for name in ERRATA)])
    assert out.splitlines()[-1].startswith(written)


@pytest.mark.parametrize("name", ["errata.md", "errata.tex", "editor.html"])
def test_the_erratum_has_the_paper_the_counts_and_what_explains_them(call: Call, name: str) -> None:
    assert call("mine.toml", "-o", "page", "--errata", "errata")[0] == 0
    text = text_of(f"errata/{name}").replace("``", "“").replace("''", "”")
    for sentence in (COUNTS, "Both count one step too few.", "“A scheme”, 2026."):
        assert sentence in text


def test_the_erratum_has_no_statement_that_holds_as_it_is_printed(call: Call) -> None:
    assert call("mine.toml", "-o", "page", "--errata", "errata")[0] == 0
    headings = re.findall(r"^### (.*)$", text_of("errata/errata.md"), re.MULTILINE)
    assert headings == ["Eq. 7", "Table 1"]


def test_the_erratum_has_what_is_printed_beside_what_is_right(call: Call) -> None:
    assert call("mine.toml", "-o", "page", "--errata", "errata")[0] == 0
    text = text_of("errata/errata.md")
    printed, right = text.index("ΔJ = O(h⁴)"), text.index("ΔJ = O(h³), and no smaller")
    assert printed < right < text.index("A conclusion of the paper changes.")


def test_the_program_beside_the_erratum_prints_the_table(call: Call) -> None:
    assert call("mine.toml", "-o", "page", "--errata", "errata")[0] == 0
    done = subprocess.run(
        [sys.executable, "-I", "errata/table-1.py"], capture_output=True, text=True, timeout=60
    )
    assert (done.returncode, done.stderr) == (0, "")
    printed = [float(x) for x in done.stdout.partition(":")[2].split()]
    (row,) = (c.details[2][1:] for c in report_in("page").claims if c.id == "Table_1")
    assert printed == pytest.approx([float(cell) for cell in row], abs=6e-4)


def test_without_the_option_there_is_no_erratum(call: Call) -> None:
    assert call("mine.toml", "-o", "page")[0] == 0
    assert not [*Path("page").glob("err*")]


REFUSED = {
    "a-scene": (["scene.toml"], "errata", "is of claims that are readings of statements"),
    "no-readings": (["plain.toml"], "errata", "is of claims that are readings of statements"),
    "integrators": (["integrators"], "errata", "is of claims that are readings of statements"),
    "no-parent": (["mine.toml"], "none/errata", "there is no folder none; make it first"),
    "a-file": (["mine.toml"], "taken", "File exists, and is no folder; give a folder"),
    "named-as-a-file": (["mine.toml"], "errata.md", "names a file; give a folder"),
    "read-only": (["mine.toml"], "/sys", ".*; give a folder that can be written to"),
}


@pytest.mark.parametrize(("scene", "folder", "problem"), REFUSED.values(), ids=REFUSED)
def test_an_erratum_that_cannot_be_is_refused_before_anything_is_computed(
    call: Call, scene: list[str], folder: str, problem: str
) -> None:
    Path("scene.toml").write_text('system = "pendulum"\nschemes = ["lie2"]\n')
    Path("plain.toml").write_text(WITHOUT_READINGS)
    Path("taken").touch()
    status, out, err = call(*scene, "-o", "page", "--errata", folder)
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert re.match(f"verify: --errata={folder}: {problem}", err)
    assert not Path("page").exists()
    assert not Path("errata").exists()


def test_an_erratum_of_a_scene_in_one_line_is_refused(call: Call) -> None:
    start = ["--step-size", "0.1", "--steps", "3", "--q", "1", "--p", "0"]
    line = ["--system", "pendulum", "--scheme", "lie2", *start, "-o", "page", "--errata", "errata"]
    status, out, err = call(*line)
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert err.startswith("verify: --errata=errata: is of claims")
    assert not Path("page").exists()
