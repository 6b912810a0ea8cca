"""What may be claimed instead, on the page: of each statement that does not hold as printed."""

import re
from typing import Any

from tests.helpers.constructed.papers import P, R, U, each_category, paper, reading, repair
from tests.unit.pages.sections.test_growth_view import text_of
from tests.unit.pages.test_page import EVIL, Reader
from verify.pages.markdown.page import render as render_markdown
from verify.pages.page import render
from verify.prose import read_prose
from verify.scenes.results.report import Report
from verify.verdict import Verdict


def section(page: str) -> str:
    """The section on repairs; "" if there is none."""
    parts = re.findall(r'<section[^>]* id="instead".*?</section>', page, re.DOTALL)
    return "".join(parts)


def entries(report: Report) -> dict[str, str]:
    """What is said of each statement, by its name."""
    parts = re.findall(r"<dt>(.*?)</dt>\s*<dd>(.*?)</dd>", section(render(report)), re.DOTALL)
    return {text_of(name): text_of(words) for name, words in parts}


NOTHING = "Nothing is shown in its place."


def test_each_statement_that_does_not_hold_as_printed_is_listed_with_what_may_take_its_place() -> (
    None
):
    shown = entries(each_category())
    assert [*shown] == ["Eq. B", "Eq. C", "Eq. D", "Eq. E", "Eq. F", "Table G"], "A is as meant"
    assert shown["Eq. B"] == (
        "Printed: It is B. ✓ PROVED It is B². proof Nothing else in the paper changes."
    )
    assert shown["Eq. D"] == (
        "Printed: It is D. ✓ PROVED It is rather D-right. proof A conclusion of the paper changes."
    )
    assert shown["Table G"].endswith(" It is rather G-right. proof The printed table changes.")
    assert shown["Eq. C"] == f"Printed: It is C. {NOTHING}"
    assert shown["Eq. F"] == f"Printed: It is F. {NOTHING}"


def test_a_repair_that_does_not_hold_is_not_shown() -> None:
    assert entries(each_category())["Eq. E"] == f"Printed: It is E. {NOTHING}"
    report = paper(
        reading("A", R), repair("A", id="one", verdict=U, statement="Perhaps."),
        repair("A", id="two", verdict=Verdict.MEASURED, statement="About so."),
    )  # fmt: skip
    assert entries(report) == {"Eq. A": "Printed: It is A. ≈ MEASURED About so. evidence"}


def test_without_any_repair_there_is_no_such_section() -> None:
    page = render(paper(reading("A", R), reading("B", U), reading("", P, id="ours")))
    assert section(page) == ""
    assert "#instead" not in page


def test_nor_is_there_one_where_all_that_is_repaired_holds_as_meant() -> None:
    page = render(paper(reading("A", P, repairs="A", repaired="It is A, for h > 0.")))
    assert section(page) == ""


def test_it_links_to_the_statement_and_to_what_shows_the_repair() -> None:
    page = section(render(paper(reading("A", R), repair("A"))))
    targets = [target for target in Reader(page).all("href") if target != "#instead"]
    assert targets == ["#claim-A", "#claim-A-right"]


def test_it_is_in_the_contents_and_in_markdown() -> None:
    report = paper(reading("A", R), repair("A", repaired=read_prose("It is `h^2`.")))
    assert 'href="#instead">What may be claimed instead</a>' in render(report)
    text, _ = render_markdown(report)
    assert "## What may be claimed instead" in text
    assert "It is h². [proof](#claim-A-right)" in text


def test_what_others_wrote_stays_text() -> None:
    texts: dict[str, Any] = {"source": EVIL, "statement": EVIL}
    claims = (reading("A", R, **texts), repair("A", **texts), repair("A", id="b", repaired=EVIL))
    page = section(render(paper(*claims)))
    assert EVIL not in page
    assert "".join(Reader(page).texts).count(EVIL) == 4
