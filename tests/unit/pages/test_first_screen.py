"""The first screen and the claims: what is told first, and where each claim stands."""

import re
from typing import Any

import pytest

from tests.unit.pages.test_page import claim, page_of, proof, report, run, scene
from verify.pages.page import page_view, render
from verify.pages.sections.page_contents import Anchors, groups
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.claim import statements_of
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
    said = "one of the 2 printed values is the lg MSE from any of the 2 initial values: computed"
    assert page.count(said) == 2, "the first screen and its claim"
    assert page.count("MSE increases between all") == 1
    labels = re.findall(r'<svg[^>]* aria-label="([^"]*)"', page)
    assert len(labels) == len(set(labels)) == 3


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


# -- statements and readings -----------------------------------------------------------------------

P, R = Verdict.PROVED, Verdict.REFUTED


def read(*readings: tuple[str, str, Verdict], **more: Any) -> Any:
    """A report of readings: each its id, its statement and its verdict; "" for a claim of ours."""
    claims = tuple(
        claim(
            id=id_, source=f"Eq. {of}", statement=f"It is {of}.", statement_id=of, verdict=verdict,
            reading=f"as {id_}", standing="fair" if of else "ours",
        )
        for id_, of, verdict in readings
    )  # fmt: skip
    return report(claims=claims, statements=statements_of(claims), **more)


def test_statements_are_counted_and_not_their_readings() -> None:
    made = read(("a", "A", R), ("b", "A", P), ("c", "C", R), ("d", "D", P), ("e", "", R))
    page = render(made)
    assert (
        "3 statements of the paper, in 4 readings: 1 holds as meant, 1 depends on the "
        "reading, 1 is refuted in every reading; 1 more claim is ours." in page
    )
    tiles = [(t.figure, t.word, t.verdict) for t in page_view(made).first.tiles]
    assert tiles == [
        ("1", "holds as meant", P), ("1", "depends on the reading", Verdict.MEASURED),
        ("1", "refuted", R),
    ]  # fmt: skip


def test_the_reading_that_holds_stands_before_the_others_of_its_statement() -> None:
    made = read(("a", "A", R), ("x", "X", P), ("b", "A", P), ("c", "A", Verdict.UNDECIDED))
    found = page_view(made).claims
    assert [c.result.id for c in found] == ["b", "a", "c", "x"]
    assert [c.is_later_reading for c in found] == [False, True, True, False]
    assert [c.outcome for c in found] == ["3 readings: depends on the reading", "", "", ""]
    page = render(made)
    assert page.count("It is A.") == 1
    assert all(f"as {id_}" in page for id_ in "abcx")


def test_no_refutation_is_told_of_a_statement_that_holds_in_some_reading() -> None:
    some = page_view(read(("a", "A", R), ("b", "A", P), ("e", "", R)))
    assert some.first.refutation is None
    every = page_view(read(("a", "A", R), ("b", "A", P), ("c", "C", R)))
    assert every.first.refutation is not None
    assert every.first.refutation.claim.result.id == "c"


def test_what_the_paper_does_not_say_is_marked_as_ours() -> None:
    assert "ours, not the paper’s" in render(read(("a", "A", P), ("e", "", R)))
    assert "ours, not the paper’s" not in render(read(("a", "A", P)))


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
    assert "|Λ| over all steps against the step size h" in telling
    assert "<svg" in telling
    assert ", printed and computed</h2>" not in page
    assert ", refuted</h2>" not in page
