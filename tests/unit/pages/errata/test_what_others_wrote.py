"""Whatever a claims file may say is text in an erratum; and the whole is set by LaTeX."""

import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.constructed.papers import (
    R,
    each_category,
    paper,
    paper_sized,
    reading,
    repair,
    table,
)
from tests.helpers.pages.read_errata import MARKDOWN, Elements, tables, written
from verify.prose import read_prose
from verify.scenes.paper_sections import Cause
from verify.scenes.results.report import Report

EVIL = "<script>alert(1)</script> \\input{/etc/passwd} $x$ 50 % #1 a_b ^^41 & [l](http://e.org) `"


def hostile() -> Report:
    """The worst text wherever a file may have one."""
    texts: dict[str, Any] = {
        "source": EVIL, "statement": EVIL, "evidence": EVIL, "reading": EVIL, "section": EVIL,
    }  # fmt: skip
    details = (("x", "h = 0.1"), ("printed", "1"), (f"[{EVIL}", EVIL), (f"* {EVIL}", "2"))
    return paper(
        reading("A", R, **texts),
        repair("A", effect="conclusion", **texts),
        reading("B", R, **texts),
        repair("B", effect="table", repaired=EVIL),
        table("C", details=details, **{**texts, "id": EVIL}),
        title=EVIL,
        preface=(EVIL,),
        causes=(Cause(says=read_prose(f"[{EVIL}"), explains=("A",), origin=read_prose(EVIL)),),
    )


def test_html_of_others_is_text_on_the_editors_page(tmp_path: Path) -> None:
    page = Elements(written(hostile(), tmp_path)["editor.html"])
    assert not {"script", "a", "img"} & page.tags
    assert page.text.count(EVIL) == 9, "2 titles, preface, 2 of the cause, 2 sources, 2 repairs"


def test_latex_of_others_is_text_in_the_erratum(tmp_path: Path) -> None:
    text = written(hostile(), tmp_path)["errata.tex"]
    assert "\\input" not in text
    shown = r"\textbackslash{}input\{/etc/passwd\} \$x\$ 50 \% \#1 a\_b "
    assert text.count(shown + r"\textasciicircum{}\textasciicircum{}41 \& [l]") == 22
    body = text.partition("\\begin{document}")[2]
    rest = body.replace(r"\$", "").replace(r"\%", "").replace(r"\#", "").replace(r"\_", "")
    assert not re.search("[%#_^]", re.sub(r"\\textasciicircum", "", rest))
    assert not re.search(r"\\(?:item|\\)\s*[\[*](?!\{)", body), "no optional argument"


def test_markdown_of_others_is_text_in_the_erratum(tmp_path: Path) -> None:
    text = written(hostile(), tmp_path)["errata.md"]
    page = Elements(MARKDOWN.render(text))
    assert not {"script", "a", "img"} & page.tags
    assert "\\input" in page.text
    assert page.text.count(EVIL) == 22
    assert [len(row) for row in tables(text)[0]] == [2, 2, 2]


# -- the whole, by LaTeX --------------------------------------------------------------------------


@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="pdflatex is not installed")
@pytest.mark.parametrize("report", [each_category, hostile, paper_sized])
def test_latex_sets_the_erratum_without_an_error(
    report: Callable[[], Report], tmp_path: Path
) -> None:
    written(report(), tmp_path)
    command = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "errata.tex"]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, errors="replace")
    assert run.returncode == 0, run.stdout[-2000:]
    log = (tmp_path / "errata.log").read_text(encoding="utf-8", errors="replace")
    assert "Missing character" not in log
    wide = re.findall(r"Overfull \\hbox \((\d+)\.\d+pt too wide\)", log)
    assert report is hostile or not [width for width in wide if int(width) >= 10]
    assert (tmp_path / "errata.pdf").read_bytes().startswith(b"%PDF")
