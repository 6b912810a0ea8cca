"""The first screen of a paper: what explains its mistakes first, then its statements counted."""

import re

import pytest

from tests.helpers.constructed.papers import P, R, U, each_category, paper, reading, table
from tests.unit.pages.test_page import Reader, claim, report
from verify.pages.markdown.page import render as render_markdown
from verify.pages.page import page_view, render
from verify.prose import read_prose
from verify.scenes.paper_sections import Cause
from verify.scenes.results.report import Report
from verify.verdict import Verdict

CAUSES = (
    Cause(says=read_prose("It is `h^2`."), explains=("D", "G"), disfavours=read_prose("Us.")),
    Cause(says=read_prose("<b>So.</b>"), explains=("E",)),
)


def with_causes() -> Report:
    return each_category(causes=CAUSES)


def first_of(page: str) -> str:
    return page[page.index("<h1>") : page.index("</header>")]


# -- causes ---------------------------------------------------------------------------------------


def test_what_explains_the_mistakes_stands_before_all_that_was_found() -> None:
    first = first_of(render(with_causes()))
    places = [first.index(each) for each in ("What explains", 'class="finding"', 'class="tiles"')]
    assert places == sorted(places)
    (causes,) = re.findall(r'<section class="causes".*?</section>', first, re.DOTALL)
    assert re.sub(r"\s+", " ", "".join(Reader(causes).texts)).strip() == (
        "What explains what does not hold It is h². Us. Eq. D, Table G <b>So.</b> Eq. E"
    )


def test_each_cause_links_to_what_it_explains() -> None:
    page = render(with_causes())
    (causes,) = re.findall(r'<section class="causes".*?</section>', page, re.DOTALL)
    targets = [target.removeprefix("#") for target in Reader(causes).all("href")]
    assert targets == ["claim-D", "claim-G", "claim-E"]
    assert {*targets} <= {*Reader(page).all("id")}


def test_the_causes_stand_in_the_markdown_too_and_are_escaped() -> None:
    text, _ = render_markdown(with_causes())
    head = text.partition("7 statements of the paper")[0]
    assert "## What explains what does not hold" in head
    assert "1. It is h². Us. [Eq. D](#claim-D), [Table G](#claim-G)\n" in head
    assert "&lt;b&gt;So.&lt;/b&gt; [Eq. E](#claim-E)" in head


def test_without_a_cause_there_is_no_heading_of_them() -> None:
    assert "What explains" not in render(each_category())
    assert page_view(each_category()).first.causes == ()


# -- tiles and questions --------------------------------------------------------------------------


def test_tiles_count_the_statements_of_each_category() -> None:
    tiles = page_view(each_category()).first.tiles
    assert [(tile.sign, tile.figure, tile.word, tile.verdict, tile.weight) for tile in tiles] == [
        ("✓", "1", "holds as meant", P, 1),
        ("✓", "1", "holds with a misprint", Verdict.ENCLOSED, 1),
        ("≈", "1", "depends on the reading", Verdict.MEASURED, 1),
        ("✗", "3", "refuted", R, 3),
        ("?", "1", "undecided", U, 1),
    ]
    assert all(tile.meaning for tile in tiles)


@pytest.mark.parametrize(
    ("verdicts", "word"),
    [("P", "holds as meant"), ("PP", "hold as meant"), ("R", "refuted"), ("RR", "refuted"),
     ("U", "undecided"), ("UU", "undecided")],
)  # fmt: skip
def test_the_word_of_a_tile_is_in_the_number_of_its_count(verdicts: str, word: str) -> None:
    letters = {"P": P, "R": R, "U": U}
    claims = (reading(f"s{k}", letters[letter]) for k, letter in enumerate(verdicts))
    (tile,) = page_view(paper(*claims)).first.tiles
    assert (tile.figure, tile.word) == (str(len(verdicts)), word)


def test_a_claim_is_counted_by_the_tile_of_its_statement() -> None:
    claims = page_view(each_category()).claims
    words = {view.result.id: view.tile_word for view in claims if view.statement}
    assert words == {
        "A": "proved", "A-strictly": "proved", "B": "enclosed", "B-letter": "enclosed",
        "C-broad": "measured", "C-narrow": "measured", "D": "refuted", "E": "refuted",
        "F": "undecided", "G": "refuted",
    }  # fmt: skip


def test_what_needs_a_repair_is_named_with_links() -> None:
    first = first_of(render(with_causes()))
    (answer,) = re.findall(r"<p>Of 7 statements on every H,.*?</p>", first)
    said = re.sub("<[^>]*>", "", answer)
    assert said == (
        "Of 7 statements on every H, 1 holds as meant, 1 holds with a misprint, 1 depends on the "
        "reading, 3 are refuted in every reading and 1 is undecided. What needs a repair: Eq. D, "
        "Eq. E, Eq. F, Table G"
    )
    assert re.findall('href="#(.*?)"', answer) == ["claim-D", "claim-E", "claim-F", "claim-G"]


# -- the refutation -------------------------------------------------------------------------------


def heading(page: str) -> str:
    (text,) = re.findall(r'<h2 id="telling-title">(.*?)</h2>', page)
    return str(text)


def test_a_refuted_table_is_shown_as_printed_and_computed() -> None:
    assert heading(render(paper(reading("A", R), table("B")))) == "Table B, printed and computed"


def test_another_refutation_is_only_called_refuted() -> None:
    assert heading(render(report(claims=(claim(verdict=R),)))) == "Eq. 1, refuted"
