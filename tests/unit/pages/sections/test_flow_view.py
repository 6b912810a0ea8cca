"""Regions carried by maps: said and drawn as the data are."""

import re
from typing import Any

import pytest

from tests.helpers.constructed.flows import (
    FAILED,
    LONG,
    THREE,
    TWO,
    exact,
    flow,
    image,
    in_degrees,
)
from tests.helpers.pages.imported_modules import imported_by
from tests.unit.pages.figures.test_figures import figures
from tests.unit.pages.sections.test_growth_view import text_of
from tests.unit.pages.test_page import EVIL, SCRIPT, Reader, report, run, scene
from verify.pages.figures.flow_figure import draw_flow
from verify.pages.figures.flow_grid import grid_of
from verify.pages.figures.sheet import page_style
from verify.pages.page import render
from verify.pages.sections.flow_finding import finding, findings
from verify.pages.text.typography import number
from verify.scenes.paper_sections import PaperFigure
from verify.scenes.results.regions import FlowImage, FlowResult


def page_of(*flows: FlowResult, **changes: Any) -> str:
    return render(report((scene(flows=flows),), **changes))


# -- the part of a scene --------------------------------------------------------------------------


def test_a_scene_without_regions_shows_nothing_of_them() -> None:
    page = render(report((scene(runs=(run(),)),)))
    assert "Regions carried" not in page


@pytest.mark.parametrize(
    ("made", "absent"),
    [
        ("scene(runs=(run(),))", {"verify.pages.figures.flow_figure", "numpy"}),
        ("scene(flows=(flow(FAILED),))", {"verify.pages.figures.flow_figure", "matplotlib"}),
    ],
)
def test_what_is_not_shown_is_not_imported(made: str, absent: set[str]) -> None:
    assert not absent & imported_by(
        "from tests.helpers.constructed.flows import FAILED, flow", f"render(report(({made},)))"
    )


def numbers_of(each: FlowImage) -> list[str]:
    """All that a row says of an image, as it is set."""
    pairs = [
        (each.area_change, each.probe_error),
        (each.mean_lambda, each.mean_lambda_error),
        (each.distance, each.distance_error),
    ]
    known = [f"{number(x)} ± {number(e)}" for x, e in pairs if x is not None and e is not None]
    return [text.replace("\xa0", " ") for text in known]


def rows_of(page: str) -> list[str]:
    (table,) = re.findall(r'<table class="numbers carried">.*?</table>', page, re.DOTALL)
    return [text_of(row) for row in re.findall(r"<tr>.*?</tr>", table, re.DOTALL)[1:]]


def wrong_rows(found: FlowResult, page: str) -> list[str]:
    """The images of which a number is not in its row."""
    return [
        f"{each.map} {each.steps}"
        for each, row in zip(found.images, rows_of(page), strict=True)
        if not all(text in row for text in [each.map, f"{each.steps:,}", *numbers_of(each)])
    ]


def test_the_table_has_the_numbers_of_the_results_and_a_planted_one_is_seen() -> None:
    assert wrong_rows(THREE, page_of(THREE)) == []
    first, *rest = THREE.images
    planted = THREE.model_copy(
        update={"images": (first.model_copy(update={"area_change": "3e-12"}), *rest)}
    )
    assert wrong_rows(THREE, page_of(planted)) == ["exact flow 5000"]


IN_THE_PLANE = (
    "The largest relative change of area is that by lie2 with h = 0.01, N = 300: "
    "9.8765 × 10⁻⁴ ± 3.1 × 10⁻¹¹.",
    # 1.2345e-5 / 3.1e-11 = 398225.8…, the lesser of the two
    "The probe’s own error is at least 390,000 times smaller",
    "In all 2 images the mean of Λ over the region",
    "The exact flow preserves area by Liouville’s theorem",
    "lie2 up to 7.77 × 10⁻³ ± 5.6 × 10⁻⁶ (h = 0.01, N = 300)",
    "less than the thousandth that a picture can show",
)
OF_THE_INVARIANT = (
    "The largest relative change of ∮ p·dq is that by lie2",
    "The exact flow keeps ∮ p·dq by Poincaré’s theorem",
    "mean of W over the region, computed without any curve, is the same",
    "the projections to (q1, p1) and (q2, p2) enclose 0.75 and 0.25",
    "less than the thousandth that a picture can show",
)


@pytest.mark.parametrize(
    ("result", "sentences", "absent"),
    [
        (TWO, IN_THE_PLANE, ("∮", "mean of W")),
        (in_degrees(), OF_THE_INVARIANT, ("Λ", "det J")),
    ],
    ids=["plane", "degrees"],
)
def test_the_sentences_are_those_of_the_data(
    result: FlowResult, sentences: tuple[str, ...], absent: tuple[str, ...]
) -> None:
    text, said = text_of(page_of(result)), " ".join((*findings([result]), *finding(result)))
    for sentence in sentences:
        assert sentence in text
    for words in absent:
        assert words not in said
    assert "det J ≡ 1 is proved for" not in text


def test_a_change_that_an_eye_may_see_is_not_said_to_be_unseen() -> None:
    assert "picture can show" not in text_of(page_of(flow(image(area_change="-1.2e-03"))))


def test_a_scheme_that_preserves_area_does_so_by_proof() -> None:
    text = text_of(page_of(THREE))
    assert "det J ≡ 1 is proved for symplectic-euler and the exact flow" in text
    assert "what the probe measures there is below its own error, at most 8.8 × 10⁻¹²" in text
    assert "keeps the area of the circle by proof (measured: 2 × 10⁻¹³ ± 8.8 × 10⁻¹²)" in text


@pytest.mark.parametrize(
    ("result", "differs"),
    [
        (flow(image(agree=False), image(steps=200)),
         "Λ over the region, computed without any area, differs from it in 1 of 2 images"),
        (in_degrees(agree=False), "W over the region, computed without any curve, differs from it "
         "in 1 of 1 images: one of the two is wrong there"),
    ],
    ids=["plane", "degrees"],
)  # fmt: skip
def test_measures_that_disagree_are_told_and_never_glossed_over(
    result: FlowResult, differs: str
) -> None:
    text = text_of(page_of(result))
    assert differs in text
    assert "the two measures disagree" in text
    assert "is the same within the errors" not in text


def test_of_one_image_both_measures_are_told_and_of_the_exact_flow_that_the_probe_is_wrong() -> (
    None
):
    of_one = text_of(page_of(flow(image(agree=False))))
    assert "which must be the same, is −1.234 × 10⁻⁵ ± 2.0 × 10⁻⁸: one of the two" in of_one
    wrong = text_of(page_of(flow(exact(area_change="1e-06"))))
    assert "the probe is wrong there" in wrong
    assert "below its own error" not in wrong


def test_an_image_that_is_missing_says_why() -> None:
    page = page_of(flow(image(), FAILED))
    text = text_of(page)
    assert "1 image has no known change of area" in text
    assert text.count("left the range of float64 at step 7") == 2, "its sentence and its row"
    assert "(a) lie2; no image at N = 400" in page
    alone = page_of(flow(FAILED))
    assert "<svg" not in alone
    assert "not known" in text_of(alone)


def test_names_that_are_markup_stay_text() -> None:
    evil = flow(
        image(map=EVIL, problem=EVIL, arithmetic=EVIL), exact(), shape=EVIL, source=EVIL,
        before=TWO.before,
    )  # fmt: skip
    figure = PaperFigure(label=EVIL, caption=EVIL, scene="mine", shows="flow", assumed=EVIL)
    page = page_of(evil, figures=(figure,))
    assert Reader(page).scripts == [SCRIPT]
    assert page.count("&lt;script&gt;") > 10


# -- the drawing ----------------------------------------------------------------------------------


@pytest.mark.parametrize("made", [TWO, THREE, flow(image(), FAILED)])
def test_all_panels_have_equal_axes_and_one_scale(made: FlowResult) -> None:
    with page_style():
        drawn = draw_flow(grid_of(made))
        drawn.canvas.draw()
    assert len({axes.get_xlim() for axes in drawn.axes}) == 1
    assert len({axes.get_ylim() for axes in drawn.axes}) == 1
    for axes in drawn.axes:
        box = axes.get_window_extent()
        (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
        assert box.width / (x1 - x0) == pytest.approx(box.height / (y1 - y0), rel=1e-6)
        assert box.width > 0.2 * drawn.bbox.width


def test_what_keeps_its_shape_stands_together_and_what_does_not_upon_the_exact_image() -> None:
    together, apart = grid_of(TWO), grid_of(THREE)
    assert ([panel.name for panel in together.panels], together.counts) == (
        ["exact flow", "lie2"], (),
    )  # fmt: skip
    assert [len(panel.images) for panel in together.panels] == [2, 2]
    assert apart.counts == ("N = 5,000, t = 50.0", "N = 10,000, t = 100.0")
    assert [panel.name for panel in apart.panels] == ["lie2", "symplectic-euler"] * 2
    assert [len(panel.images) for panel in apart.panels] == [1] * 4
    assert all(panel.exact_curves for panel in apart.panels), (
        "under each image that of the exact flow"
    )
    stretched = grid_of(flow(image(**LONG), image(steps=200, **LONG)))
    assert len(stretched.counts) == 2
    assert not any(panel.exact_curves for panel in stretched.panels)


def test_of_many_numbers_of_steps_a_few_are_drawn_and_it_is_said() -> None:
    many = flow(*(image(steps=n, **LONG) for n in range(100, 2100, 100)))
    assert len(grid_of(many).counts) == 6
    assert "6 of 20 are drawn." in text_of(page_of(many))


def test_the_image_is_at_its_place() -> None:
    """The circle about (1, 0) of radius 1, read back from the path that is drawn."""
    with page_style():
        (axes,) = draw_flow(grid_of(flow(image(steps=100)))).axes
    before, after = (axes.patches[i].get_path().get_extents() for i in (0, 1))
    assert before.extents == pytest.approx((-1, -1, 1, 1), abs=1e-3)
    assert after.extents == pytest.approx((0, -1, 2, 1), abs=1e-3)


def test_the_picture_has_words_and_the_names_of_its_axes() -> None:
    (svg,) = figures(page_of(THREE))
    assert svg.get("aria-label", "").startswith("Circle at (q, p) = (0, 0), scale 1, carried by")
    texts = [e.text for e in svg.iter() if e.tag == "text"]
    assert {"q", "p", "lie2", "symplectic-euler"} <= set(texts)
