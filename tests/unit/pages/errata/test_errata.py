"""The erratum's statements: which are listed, and with which words, reasons and effects."""

import re
from pathlib import Path

import pytest

from tests.helpers.constructed.papers import P, R, U, each_category, paper, reading, repair
from tests.helpers.pages.read_errata import corrections, written
from tests.unit.pages.test_page import claim
from tests.unit.pages.test_page import report as plain_report
from verify.errors import InputError
from verify.pages.errata.errata import write_errata
from verify.prose import read_prose
from verify.scenes.paper_sections import Cause


def test_statements_that_do_not_hold_as_they_are_printed_are_listed_and_no_other(
    tmp_path: Path,
) -> None:
    files = written(each_category(), tmp_path)
    listed = ["Eq. B", "Eq. C", "Eq. D", "Eq. E", "Eq. F", "Table G"]
    assert [*corrections(files["errata.md"])] == listed
    assert re.findall(r"^\\item\[\{(.*?)\}\]", files["errata.tex"], re.M) == listed


def test_a_statement_has_its_words_the_repaired_ones_the_reason_and_the_effect(
    tmp_path: Path,
) -> None:
    files = written(each_category(), tmp_path)
    assert corrections(files["errata.md"])["Eq. D"] == [
        "*Printed:* It is D.", "*Correct (proved):* It is rather D-right.",
        "*Why:* Because of D. A conclusion of the paper changes.",
    ]  # fmt: skip
    (item,) = re.findall(r"\\item\[\{Eq\. D\}\] (.*?)\n\\item", files["errata.tex"], re.S)
    assert item == (
        "\\emph{Printed:} It is D.\n\n\\emph{Correct (proved):} It is rather D-right.\n\n"
        "\\emph{Why:} Because of D. A conclusion of the paper changes."
    )


def test_a_reading_says_the_repaired_words_itself_and_its_effect(tmp_path: Path) -> None:
    entry = corrections(written(each_category(), tmp_path)["errata.md"])["Eq. B"]
    assert entry[1] == "*Correct (proved):* It is B²."
    assert entry[2].endswith(" Nothing else in the paper changes.")


@pytest.mark.parametrize("statement", ["C", "E", "F"])
def test_a_statement_of_which_no_repair_holds_says_so(statement: str, tmp_path: Path) -> None:
    files = written(each_category(), tmp_path)
    lines = corrections(files["errata.md"])[f"Eq. {statement}"]
    assert lines[1] == "Nothing is shown in its place."
    assert len(lines) == 3, "what is printed, this, and the reason"
    item = files["errata.tex"].partition(rf"\item[{{Eq. {statement}}}]")[2].partition("\\item")[0]
    assert "\n\nNothing is shown in its place.\n\n" in item
    assert "Correct" not in item


def test_the_reason_is_the_evidence_against_the_printed_words(tmp_path: Path) -> None:
    entries = corrections(written(each_category(), tmp_path)["errata.md"])
    reasons = {name: lines[-1].strip() for name, lines in entries.items()}
    assert reasons["Eq. B"].startswith("*Why:* Because of B-letter.")
    assert reasons["Eq. C"] == "*Why:* Because of C-narrow."
    assert reasons["Eq. F"] == "*Why:* Because of F.", "the only evidence that there is"


def test_the_reason_is_against_the_letter_first_and_then_against_a_fair_reading(
    tmp_path: Path,
) -> None:
    made_by_hand = paper(
        reading("A", P, id="A-right", repairs="A"),
        reading("A", R, id="A-strictly", standing="strict"),
        reading("A", R, id="A-letter", standing="misprint"),
        reading("A", R, id="A-narrow"),
        reading("A", R, id="A-narrower"),
    )
    lines = corrections(written(made_by_hand, tmp_path)["errata.md"])["Eq. A"]
    assert lines[-1].strip() == "*Why:* Because of A-letter. Because of A-narrow."


def test_the_reason_against_a_misprint_that_is_true_to_the_letter_is_its_remark(
    tmp_path: Path,
) -> None:
    made_by_hand = paper(
        reading("A", P, id="A-letter", standing="misprint", remark="The next line says no."),
        reading("A", P, id="A-right", repairs="A"),
    )
    lines = corrections(written(made_by_hand, tmp_path)["errata.md"])["Eq. A"]
    assert lines[-1].strip() == "*Why:* The next line says no."


def test_several_repairs_stand_below_each_other(tmp_path: Path) -> None:
    made_by_hand = paper(
        reading("A", R), repair("A", id="a-1", statement="Less."), repair("A", id="a-2", verdict=U),
        repair("A", id="a-3", statement="More."),
    )  # fmt: skip
    lines = corrections(written(made_by_hand, tmp_path)["errata.md"])["Eq. A"]
    assert lines[1:3] == ["*Correct (proved):* Less.", "*Correct (proved):* More."]
    assert len(lines) == 4


def test_a_statement_without_a_source_goes_by_its_id(tmp_path: Path) -> None:
    files = written(paper(reading("eq-9", R, source=""), repair("eq-9")), tmp_path)
    assert [*corrections(files["errata.md"])] == ["eq-9"]
    assert r"\item[{eq-9}]" in files["errata.tex"]


def test_the_causes_stand_first_with_whom_they_disfavour_and_their_origin(tmp_path: Path) -> None:
    cause = Cause(
        says=read_prose("It is `h^2`."), explains=("D",), disfavours=read_prose("It is worse."),
        origin=read_prose("A slip."),
    )  # fmt: skip
    files = written(each_category(causes=(cause,)), tmp_path)
    assert (
        "\n## What explains the mistakes\n\n1. It is h². It is worse. A slip.\n"
        in (files["errata.md"].partition("## Corrections")[0])
    )
    assert (
        "\\item{} It is h\\ensuremath{^{2}}. It is worse. A slip.\n"
        in (files["errata.tex"].partition("Corrections")[0])
    )
    assert "<li>It is h². It is worse. A slip.</li>" in files["editor.html"]


def test_without_causes_there_is_no_heading_of_them(tmp_path: Path) -> None:
    assert not [text for text in written(each_category(), tmp_path).values() if "explains" in text]


def test_the_title_is_the_papers_where_it_stands_in_quotation_marks(tmp_path: Path) -> None:
    files = written(each_category(), tmp_path)
    assert files["errata.md"].startswith("# Erratum to “A scheme”\n")
    assert r"\section*{Erratum to ``A scheme''}" in files["errata.tex"]
    assert "<h1>For the editor: “A scheme”</h1>" in files["editor.html"]
    (tmp_path / "other").mkdir()
    other = written(each_category(title="On “A scheme”"), tmp_path / "other")
    assert other["errata.md"].startswith("# Erratum to On “A scheme”\n")


def test_the_editor_reads_of_tables_and_conclusions_that_change_alone(tmp_path: Path) -> None:
    page = written(each_category(), tmp_path)["editor.html"]
    below = re.findall(r"<h2>(.*?)</h2>\s*<ul>(.*?)</ul>", page, re.S)
    assert [(head, re.findall("<b>(.*?)</b>: (.*?) *</li>", items)) for head, items in below] == [
        ("Printed tables that change", [("Table G", "It is rather G-right.")]),
        ("Conclusions that change", [("Eq. D", "It is rather D-right.")]),
    ]
    assert "The corrections of all 6 statements" in page
    assert "3 are refuted in every reading" in page


def test_a_report_that_counts_no_statements_has_no_erratum(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no paper whose statements are counted"):
        write_errata(plain_report(claims=(claim(),)), tmp_path)
    assert not [*tmp_path.iterdir()]
