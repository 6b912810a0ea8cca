"""What was left out, on the page: of the paper, and of what could be computed."""

import re

from tests.unit.pages.sections.test_growth_view import text_of
from tests.unit.pages.test_page import EVIL, Reader, report
from verify.pages.markdown.page import render as render_markdown
from verify.pages.page import render
from verify.scenes.results.report import Report

PAPER = (("Section 1", "It is history."), ("Figure 9", "It has no axes."))
RUNS = (("a run of h = 0.1", "it would take a year"),)


def groups(made_of: Report) -> list[tuple[str, list[tuple[str, str]]]]:
    """Each group that can be unfolded: its heading, and what with why."""
    (section,) = re.findall(r'<section[^>]* id="left-out".*?</section>', render(made_of), re.DOTALL)
    parts = re.findall(r"<summary>(.*?)</summary>(.*?)</details>", section, re.DOTALL)
    pair = re.compile(r"<dt>(.*?)</dt><dd>(.*?)</dd>")
    return [
        (text_of(head), [(text_of(what), text_of(why)) for what, why in pair.findall(body)])
        for head, body in parts
    ]


def test_what_has_no_claim_and_what_was_not_computed_are_two_groups() -> None:
    assert groups(report(left_out=(*PAPER, *RUNS), not_claimed=PAPER)) == [
        ("Of the paper: all 2 entries", [*PAPER]),
        ("Of what could be computed: the one entry", [*RUNS]),
    ]


def test_of_a_paper_of_which_all_was_computed_one_group_is_left() -> None:
    only = report(left_out=PAPER[:1], not_claimed=PAPER[:1])
    assert groups(only) == [("Of the paper: the one entry", [*PAPER[:1]])]


def test_without_a_paper_what_was_not_computed_needs_no_heading() -> None:
    assert groups(report(left_out=RUNS)) == [("The one entry", [*RUNS])]


def test_nothing_left_out_has_no_section() -> None:
    assert 'id="left-out"' not in render(report())


def test_both_groups_stand_in_the_markdown() -> None:
    text, _ = render_markdown(report(left_out=(*PAPER, *RUNS), not_claimed=PAPER))
    assert re.findall("<summary>(Of .*?)</summary>", text) == [
        "Of the paper: all 2 entries", "Of what could be computed: the one entry",
    ]  # fmt: skip


def test_what_others_wrote_stays_text() -> None:
    page = render(report(left_out=((EVIL, EVIL), *RUNS), not_claimed=((EVIL, EVIL),)))
    assert EVIL not in page
    assert "".join(Reader(page).texts).count(EVIL) == 2
