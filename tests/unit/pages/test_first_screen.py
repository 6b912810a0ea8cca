"""The first screen and the claims: what is told first, and where each claim stands."""

import re
from typing import Any

import pytest

from tests.unit.pages.test_page import claim, page_of, proof, report, run, scene
from verify.pages.page import render
from verify.pages.page_view import page_view
from verify.pages.sections.claim_view import Anchors, groups
from verify.scenes.results.bounded_value import Value
from verify.verdict import Verdict

# -- claims by section ----------------------------------------------------------------------------


def sections_of(*sections: str) -> list[tuple[str, list[str]]]:
    given = tuple(claim(id=str(i), section=name) for i, name in enumerate(sections))
    found = groups(page_view(report(claims=given)).claims, Anchors())
    return [(g.title, [c.result.id for c in g.claims]) for g in found]


def test_claims_stand_by_section_in_the_order_of_the_papers_numbers() -> None:
    assert sections_of("4.10 Z", "4.2 B", "", "4.2 B", "Appendix", "3 A", "10 C") == [
        ("3 A", ["5"]), ("4.2 B", ["1", "3"]), ("4.10 Z", ["0"]), ("10 C", ["6"]),
        ("Appendix", ["4"]), ("Other claims", ["2"]),
    ]  # fmt: skip
    assert sections_of("", "") == [("", ["0", "1"])], "one group without a title"


def test_a_section_has_its_heading_its_counts_and_its_place_in_the_contents() -> None:
    given = (
        claim(section="4.1 D"), claim(id="b", section="4.1 D", verdict=Verdict.REFUTED),
        claim(id="c", section="3 A"),
    )  # fmt: skip
    page = render(report(claims=given))
    assert page.index('id="section-3-A"') < page.index('id="section-4.1-D"')
    assert page.count('href="#section-4.1-D"') == 2, "contents and mark"
    assert re.search(r'4\.1 D</a> <span class="tally">.*1 proved.*1 refuted', page)
    assert "<h3" not in render(report(claims=(claim(),))), "nor is there one without sections"


def test_no_evidence_and_no_picture_stands_twice() -> None:
    page = page_of("real")
    assert page.count("4 of 4 entries are wrong: computed") == 2, "the first screen and its claim"
    assert page.count("MSE increases between all") == 1
    labels = re.findall(r'<svg[^>]* aria-label="([^"]*)"', page)
    assert len(labels) == len(set(labels)) == 4


# -- the first screen ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("verdicts", "sentence"),
    [
        ("PP", "All 2 claims are proved."),
        ("R", "The one claim is refuted."),
        ("PRR", "Of 3 claims, 1 is proved and 2 refuted."),
        ("PPEMRU", "Of 6 claims, 2 are proved, 1 enclosed, 1 measured, 1 refuted and 1 undecided."),
    ],
)
def test_the_finding_counts_the_verdicts(verdicts: str, sentence: str) -> None:
    letters = {v[0]: v for v in Verdict}
    claims = tuple(claim(id=str(i), verdict=letters[v]) for i, v in enumerate(verdicts))
    assert sentence in render(report((), claims=claims))


def test_tiles_say_by_sign_and_word_what_was_found() -> None:
    page = render(report(claims=(claim(), claim(id="b", verdict=Verdict.REFUTED))))
    tiles = re.findall(r'<li class="tile.*?</li>', page)
    assert [re.sub(r"<[^>]*>", "", t).split()[:2] for t in tiles] == [
        ["✓1", "proved:"],
        ["✗1", "refuted:"],
    ]


@pytest.mark.parametrize(
    ("changes", "said", "tile"),
    [
        ({}, "ΔJ of lie2 is of order h³.", "ΔJ ∼ h³"),
        ({"order": None, "area_preserving": True}, "lie2 preserves area exactly", "ΔJ ≡ 0"),
        (
            {"order": None, "area_preserving": None, "verdict": Verdict.UNDECIDED},
            "the order of ΔJ of lie2 is undecided", "its order is undecided",
        ),
    ],
)  # fmt: skip
def test_without_claims_the_first_screen_answers_with_the_proofs(
    changes: dict[str, Any], said: str, tile: str
) -> None:
    page = render(report((scene(proofs=(proof(**changes),)),)))
    first = page[page.index("<h1>") : page.index("</header>")]
    assert said in first
    assert tile in first


def test_without_a_refutation_the_picture_is_a_scenes_own() -> None:
    steps = [run(step_size=h, values={"lambda": Value(value=v, bound="1e-9")})
             for h, v in (("0.01", "-1.23e-05"), ("0.02", "-4.9e-05"))]  # fmt: skip
    page = render(report((scene(runs=tuple(steps)),), claims=(claim(),)))
    telling = page[page.index('id="telling"') : page.index('id="claims"')]
    assert "Cumulative total error |Λ|" in telling
    assert "<svg" in telling
    assert "refutation" not in page
