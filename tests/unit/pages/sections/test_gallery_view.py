"""The page's gallery says what the hunt found, in words that are right, and nothing without one."""

import re
from typing import Any

import pytest

from tests.helpers.constructed.galleries import CROSSED, KEPT, NOTHING, at, gallery, shown, split
from tests.helpers.pages.imported_modules import imported_by
from tests.unit.pages.figures.test_figures import figures
from tests.unit.pages.test_page import EVIL, Reader, claim, report, scene
from tests.unit.pages.text.test_markdown import (
    WORST,
    outline_of_the_page,
    outline_of_the_text,
    strange,
)
from verify.pages.figures.gallery_figure import marks
from verify.pages.markdown.page import render as render_text
from verify.pages.page import render
from verify.pages.sections.gallery_finding import findings, format_power
from verify.scenes.results.exploration import Gallery, GalleryScene


def page_of(*scenes: GalleryScene, **changes: Any) -> str:
    return render(report(gallery=gallery(*scenes, **changes)))


def text_of(page: str) -> str:
    return " ".join("".join(Reader(page).texts).replace("\xa0", " ").split())


# -- where there is none --------------------------------------------------------------------------


def test_without_a_hunt_nothing_of_it_is_shown() -> None:
    page = render(report((scene(),)))
    assert "gallery" not in page.replace(".gallery", "")
    assert "worst" not in text_of(page)


@pytest.mark.parametrize(
    ("made", "absent"),
    [
        ("report((scene(),))", {"verify.pages.figures.gallery_figure", "matplotlib"}),
        ("report(gallery=gallery())", {"verify.pages.figures.gallery_figure", "matplotlib"}),
    ],
)
def test_what_is_not_shown_is_not_imported(made: str, absent: set[str]) -> None:
    assert not absent & imported_by(
        "from tests.helpers.constructed.galleries import gallery", f"render({made})"
    )


# -- the first screen -----------------------------------------------------------------------------


def test_the_first_screen_tells_what_was_hunted_where_and_the_worst() -> None:
    page = page_of(shown(), shown(value=-1.2))
    first = text_of(
        page[page.index('<main id="content"') : page.index('<section id="gallery"')] + "</main>"
    )
    assert (
        "In the worst of 1,200 scenes of seed 7 (|q|, |p| ≤ 2, h from 0.001 to 0.1, 100 steps each)"
        in first
    )
    assert "Hunted for: the greatest rounding part over truncation." in text_of(page)
    assert "rounding is 5.0 × 10³ times the truncation: lie2 with h = 0.001 from q₀ = −2" in first
    assert "no claim" not in first
    assert first.count("≈") == 2, "a tile a scene"
    assert page.count('id="telling"') == 1


def test_a_hunt_that_found_nothing_says_so_and_shows_no_section() -> None:
    page = page_of()
    assert "None of 1,200 scenes of seed 7" in text_of(page)
    assert 'id="gallery"' not in page


def test_with_claims_the_first_screen_speaks_of_them() -> None:
    page = render(report(claims=(claim(),), gallery=gallery(shown())))
    assert "The one claim is proved." in page
    assert "In the worst of" not in page
    assert 'id="worst-1"' in page


# -- numbers in words -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("measure", "value", "said"),
    [
        ("rounding-share", 3.69897, "rounding is 5.0 × 10³ times the truncation"),
        ("rounding-share", 0.0, "rounding is 1.0 times the truncation"),
        ("rounding-share", -2.0, "rounding is 0.010 of the truncation"),
        ("rounding-share", -6.93, "rounding is 1.2 × 10⁻⁷ of the truncation"),
        ("digits-lost", 4.2, "4.2 digits of p and q are lost"),
        ("digits-lost", 1.0, "1.0 digit of p and q is lost"),
        ("digits-lost", -0.5, "no digit of p and q is lost: their error is 0.32 of float64’s"),
        ("digits-lost", 20.0, "no digit of p and q is left"),
        ("growth", -0.18, "|Λ| reaches 0.66"),
        ("growth", 1.4866, "|Λ| reaches 31"),
        ("growth", 150.059, "|Λ| reaches 1.1 × 10¹⁵⁰"),
        ("growth", 400.0, "|Λ| reaches 1.0 × 10⁴⁰⁰"),
        ("of my own", 1.0, "10 : the worst"),
    ],
)
def test_a_value_is_told_in_words(measure: str, value: float, said: str) -> None:
    assert said in findings(measure, "the worst", value).replace("\xa0", " ")
    other = findings(measure, "the worst", value - 5.3)
    assert said not in other.replace("\xa0", " "), "another value says something else"


def test_a_mantissa_that_rounds_up_to_ten_is_one() -> None:
    assert format_power(4.9999).replace("\xa0", " ") == "1.0 × 10⁵"
    assert format_power(1.9999) == "100"
    assert format_power(-3.9999).replace("\xa0", " ") == "1.0 × 10⁻⁴"


# -- Λ in float64 ---------------------------------------------------------------------------------


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("made", "said"),
    [
        (shown(KEPT), "Λ of float64 keeps about 7 digits over 10,000 steps."),
        (
            shown(CROSSED, meaningless_after=100),
            "meaningless after 100 steps, and stays so over all 10,000 steps.",
        ),
        (
            shown(CROSSED, meaningless_after=5),
            "after 5 steps already, the first number of steps looked at, and stays so",
        ),
        (
            shown(CROSSED, meaningless_after=5, meaningful_from=100),
            "until truncation outgrows rounding for good, after 100.",
        ),
        (shown(NOTHING), "Λ is exactly 0 over 10,000 steps, in float64 as in exact arithmetic."),
        (shown(split(at(5, "0", "0"), at(9, "0", "0"))), "is a digit known after 10,000 steps."),
        (
            shown(None, status="left range", reason="float64 leaves its range"),
            "cannot be split over 10,000 steps: float64 leaves its range.",
        ),
        (
            shown(KEPT, longer=shown(None, status="unresolved", reason="").separation),
            "A longer run of 10,000 steps cannot be split: unresolved.",
        ),
    ],
)
def test_what_becomes_of_lambda_is_told(made: GalleryScene, said: str) -> None:
    assert said in text_of(page_of(made))
    assert said not in text_of(page_of(shown(split(at(5, "1", "1e-3"), at(9, "2", "1e-3")))))


def test_where_the_scheme_keeps_area_all_of_lambda_is_rounding() -> None:
    exact = NOTHING.parts.truncation
    only = split(at(5, "0", "1e-16"), at(100, "0", "3e-15"))
    proved = only.model_copy(update={"parts": only.parts.model_copy(update={"truncation": exact})})
    said = "Exactly, Λ is 0; rounding alone makes it as large as 3.0 × 10⁻¹⁵."
    assert said in text_of(page_of(shown(proved, meaningless_after=5)))
    assert said not in text_of(page_of(shown(only, meaningless_after=5))), "0 is not known exactly"


# -- cards and pictures ---------------------------------------------------------------------------


def test_a_card_has_all_that_is_needed_to_verify_it() -> None:
    page = page_of(shown(), shown(hamiltonian="p**2/2 - cos(q)", value=1.0))
    second = page[page.index('id="worst-2"') : page.index('id="terms"')]
    assert "Scene 2: rounding is 10 times the truncation" in second
    assert "<code>verify report worst-2.toml</code>" in second
    assert '<mi mathvariant="normal">cos</mi>' in second
    assert "lie2</code> with h" in second
    assert re.findall(r'<svg[^>]* aria-label="([^"]*)"', second) == [
        "Scene 2: |truncation| and |rounding| in Λ against the number of steps.",
        "Scene 2: the orbit in the (q, p) plane, 100 steps.",
    ]
    assert page.count('href="#worst-2"') == 2, "contents and mark"


def test_the_pictures_have_axes_a_start_and_the_crossing() -> None:
    parts, orbit = figures(page_of(shown(CROSSED, meaningless_after=100)))
    said = "".join(parts.itertext()).replace("\xa0", " ")
    for text in ("steps N", "|part of Λ|", "truncation", "rounding overtakes, N = 100"):
        assert text in said
    said = "".join(orbit.itertext())
    for text in ("q", "p", "start", "after 100"):
        assert text in said


def test_only_a_crossing_is_marked_as_one() -> None:
    def labels(**changes: int) -> list[int]:
        return [round(10**x) for x, _ in marks(shown(CROSSED, **changes))]

    assert labels() == []
    assert labels(meaningless_after=5) == [], "rounding was the larger from the first"
    assert labels(meaningless_after=5, meaningful_from=100) == [100]
    assert labels(meaningless_after=100) == [100]


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("series", "count"),
    [
        ((at(5, "0", "0"), at(9, "0", "0")), 1),
        ((at(5, "0", "1e-16"), at(9, "0", "2e-16")), 2),
        ((at(5, "1e-9", "0"), at(9, "0", "2e-16"), at(20, "1e-500", "0")), 2),
        ((at(5, "1e-9", "1e-16"),), 1),
    ],
)
def test_zeros_have_no_place_on_the_axes_and_break_nothing(series: Any, count: int) -> None:
    page = page_of(shown(split(*series)))
    assert len(figures(page)) == count, "the orbit, and the parts where two can be drawn"
    said = "What is 0, or of what no digit is known, has no place on these axes."
    assert (said in page) == (count == 2)
    assert said not in page_of(shown(KEPT))


@pytest.mark.parametrize(
    "points", [[("0", "0")] * 3, [("1e-3", "5")] * 3, [("1", "0"), ("1", "2")]]
)
def test_an_orbit_that_stays_is_told_and_one_along_an_axis_is_drawn(points: Any) -> None:
    page, still = page_of(shown(None, orbit=points)), len(set(points)) == 1
    found = figures(page)
    assert len(found) == (0 if still else 1), "a dot is no picture"
    assert "nan" not in "".join(text for svg in found for text in svg.itertext()).lower()
    assert ("The orbit stays where it starts." in page) is still


def test_no_orbit_and_no_parts_are_a_card_without_pictures() -> None:
    page = page_of(shown(None, orbit=(), status="unresolved", reason="why"))
    assert figures(page) == []
    assert 'id="telling"' not in page


# -- what others wrote ----------------------------------------------------------------------------


def evil(text: str) -> Gallery:
    return gallery(
        shown(KEPT, hamiltonian=text, scheme=text, scene=text),
        shown(None, hamiltonian=text, scheme=text, reason=text, status="unresolved"),
        measure=text,
        sentence=text,
    )


def test_hostile_text_stays_text() -> None:
    page = render(report(gallery=evil(EVIL)))
    assert EVIL not in page
    assert len(Reader(page).scripts) == 1
    assert EVIL in "".join(Reader(page).texts)


@pytest.mark.sample(2)
@pytest.mark.parametrize("text", WORST)
def test_hostile_text_stays_text_in_a_repository(text: str) -> None:
    assert not list(strange(render_text(report(gallery=evil(text)))[0]))


@pytest.mark.left_to_ci
def test_the_text_shows_what_the_page_shows() -> None:
    made = report(gallery=gallery(shown(), shown(CROSSED, meaningless_after=100, value=1.0)))
    heads, labels = outline_of_the_page(made)
    own_heads, own_labels = outline_of_the_text(made)
    assert own_heads == heads
    assert len(labels) == 4
    assert [x.rstrip(".") for x in own_labels] == [x.rstrip(".") for x in labels]
    assert outline_of_the_text(report(gallery=gallery(shown()))) != (heads, labels)
