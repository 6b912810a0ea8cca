"""What a paper leaves open, on the page: each verdict that rests on it beside the other one."""

import re

import pytest

from tests.helpers.constructed.papers import P, R, U, paper, reading
from tests.unit.pages.sections.test_growth_view import text_of
from tests.unit.pages.test_page import EVIL, Reader
from verify.pages.markdown.page import render as render_markdown
from verify.pages.page import render
from verify.prose import Prose, read_prose
from verify.scenes.paper_sections import Alternative, Assumption
from verify.scenes.results.report import Report
from verify.verdict import Verdict

PAIR = (Alternative(claim="a", otherwise="b"),)


def assuming(one: Verdict, other: Verdict, **changes: object) -> Report:
    """Claim a, that rests on an assumption, and claim b, the same under another choice."""
    fields = {"says": read_prose("T is `h^-1`."), "decides": PAIR, **changes}
    assumption = Assumption.model_validate(fields)
    claims = (
        reading("A", one, id="a", reading="to T"), reading("B", other, id="b", statement="To T/2."),
        reading("", P, id="settled", statement="Nothing depends on it."),
    )  # fmt: skip
    return paper(*claims, assumptions=(assumption,))


def section(page: str) -> str:
    """The section on what is assumed."""
    (part,) = re.findall(r'<section[^>]* id="assumed".*?</section>', page, re.DOTALL)
    return str(part)


@pytest.mark.parametrize(
    ("one", "other", "flips"),
    [(P, R, "yes"), (R, P, "yes"), (Verdict.ENCLOSED, U, "not decided"), (P, P, "no"), (R, R, "no"),
     (Verdict.ENCLOSED, Verdict.MEASURED, "no")],
)  # fmt: skip
def test_a_verdict_flips_where_one_choice_holds_and_the_other_does_not(
    one: Verdict, other: Verdict, flips: str
) -> None:
    page = section(render(assuming(one, other)))
    (row,) = re.findall(r"<tbody>\s*<tr>(.*?)</tr>\s*</tbody>", page, re.DOTALL)
    name, assumed, otherwise, answer = map(text_of, re.findall("<t[hd][^>]*>(.*?)</t[hd]>", row))
    assert (name, answer) == ("Eq. A", flips)
    assert re.fullmatch(rf"\S {one} to T", assumed), "its reading"
    assert re.fullmatch(rf"\S {other} To T/2\.", otherwise), "its statement, without a reading"


def test_the_assumption_is_said_with_the_papers_silence_and_links() -> None:
    page = section(render(assuming(P, R, silence=read_prose("The figure names no `T`."))))
    assert "T is h⁻¹. The figure names no T." in text_of(page)
    assert [t for t in Reader(page).all("href") if t != "#assumed"] == ["#claim-a", "#claim-b"]


def test_what_settles_it_stands_in_place_of_a_table_with_its_verdict() -> None:
    page = section(render(assuming(P, R, decides=(), settled_by=("settled",))))
    assert "<table" not in page
    assert re.search(r"\S PROVED Nothing depends on it\.$", text_of(page))
    assert 'href="#claim-settled"' in page


def test_a_table_and_what_settles_it_may_stand_together() -> None:
    page = section(render(assuming(P, P, settled_by=("settled",))))
    assert page.index("</table>") < page.index('href="#claim-settled"')


def test_it_is_in_the_contents_and_in_markdown() -> None:
    report = assuming(P, R)
    assert 'href="#assumed">What is assumed</a>' in render(report)
    text, _ = render_markdown(report)
    assert "## What is assumed" in text
    assert re.search(r"^\| .*Eq\. A.* \| yes \|$", text, re.M)


def test_a_report_without_assumptions_has_no_such_section() -> None:
    assert 'id="assumed"' not in render(paper(reading("A", R)))


def test_what_others_wrote_stays_text() -> None:
    hostile = Assumption(says=Prose(EVIL), silence=Prose(EVIL), decides=PAIR, settled_by=("a",))
    texts = {"source": EVIL, "statement": EVIL}
    claims = (reading("A", P, id="a", reading=EVIL, **texts), reading("B", R, id="b", **texts))
    page = section(render(paper(*claims, assumptions=(hostile,))))
    assert EVIL not in page
    assert "".join(Reader(page).texts).count(EVIL) == 6
