"""The page's part on error against run time says what the data say, and only where asked for."""

from typing import Any
from xml.etree import ElementTree

import pytest

from tests.helpers.constructed.work import ladder, line, point, result, system
from tests.helpers.pages.imported_modules import imported_by
from tests.unit.pages.figures.test_figures import figures
from tests.unit.pages.sections.test_growth_view import text_of
from tests.unit.pages.test_page import EVIL, report, run, scene
from verify.pages.figures.work_precision_plots import standalone
from verify.pages.page import render
from verify.scenes.results.work_precision import WorkLine
from verify.studies.work_precision.work_lines import compare_all

FAILED = point(
    limited_by="failed", lambda_limited_by="failed", failed_step=7, seconds=None,
    reason="left the range of float64", step_size="0.2", steps=5,
)  # fmt: skip
ROUNDED = point(limited_by="rounding", error="1e-14", step_size="0.001", seconds=1e-3)


def with_points(name: str, *more: Any) -> WorkLine:
    own = ladder(name)
    return line(*(p for p in more if p is FAILED), *own.points,
                *(p for p in more if p is not FAILED), name=name)  # fmt: skip


def page_of(*lines: WorkLine, **changes: Any) -> str:
    return render(report((scene(work_precision=result(*lines, **changes)),)))


def test_a_scene_that_did_not_ask_shows_nothing_of_it() -> None:
    assert "against run time" not in render(report((scene(runs=(run(),)),)))
    assert "Error against run time" in page_of(ladder())


@pytest.mark.parametrize(
    ("made", "absent"),
    [
        (
            "scene(runs=(run(),))",
            {
                "verify.pages.figures.work_precision_plots",
            },
        ),
        (
            "scene(work_precision=result())",
            {"verify.pages.figures.work_precision_figure", "matplotlib"},
        ),
    ],
)
def test_what_is_not_shown_is_not_imported(made: str, absent: set[str]) -> None:
    assert not absent & imported_by(
        "from tests.helpers.constructed.work import result", f"render(report(({made},)))"
    )


def test_orders_comparisons_and_costs_stand_on_the_page() -> None:
    lines = ladder("lie2"), ladder("stormer-verlet", area_preserving=True)
    text = text_of(page_of(*lines, comparisons=compare_all(lines, "1")))
    assert "2.00 ± 0.00" in text
    assert "At equal run time" in text
    assert "0, proved" in text
    assert "3 +, 4 ×" in text
    assert "known to within 1 × 10⁻⁴⁰" in text


def test_rounded_and_failed_runs_are_named_and_not_dropped() -> None:
    text = text_of(page_of(with_points("lie2", FAILED, ROUNDED)))
    assert "Of 5 runs, 1 is limited by rounding" in text
    assert "1 run left the range of float64" in text
    assert "failed at step 7: left the range of float64" in text
    assert "may be more than 5 % of its error" in text
    clean = text_of(page_of(ladder()))
    assert "limited by rounding: hollow" not in clean
    assert "left the range" not in clean


def test_the_figure_has_hollow_marks_crosses_and_the_floor_only_where_they_occur() -> None:
    found = "".join(figures(page_of(with_points("lie2", FAILED, ROUNDED)))[0].itertext())
    for said in ("hollow: limited by rounding", "× at the edge: failed", "floor: rounding part"):
        assert said in found
    assert "lie2, slope 2.00" in found
    bare = "".join(figures(page_of(ladder()))[0].itertext())
    assert "hollow" not in bare
    assert "failed" not in bare


def test_an_error_without_meaning_is_at_the_edge_and_hides_no_other() -> None:
    lost = point(error="1e200", step_size="0.2", steps=5, seconds=5e-6)
    (errors,) = ("".join(svg.itertext()) for svg in figures(page_of(with_points("lie2", lost))))
    assert "beyond the edge" in errors
    assert "10²⁰⁰" not in errors
    (digits,) = figures(page_of(systems=(system(certified="99.0"),)))
    assert "beyond" not in "".join(digits.itertext()), "digits are no logarithms"
    assert "beyond" not in "".join(figures(page_of(ladder()))[0].itertext())


def test_a_scheme_without_a_slope_shows_none_and_the_caption_says_why() -> None:
    two = line(*ladder().points[:2], name="lie2")
    page = page_of(two)
    assert "slope" not in "".join(figures(page)[0].itertext())
    assert "None is given for lie2 (2 points are limited by truncation)" in text_of(page)


def test_area_of_a_scheme_that_preserves_it_is_drawn_as_rounding_or_told_to_be_exact() -> None:
    kept = ladder("stormer-verlet", area_preserving=True)
    text = text_of(page_of(ladder("lie2"), kept))
    assert "For stormer-verlet ΔJ ≡ 0 is proved and Λ is 0; what is drawn, hollow" in text
    gone = kept.model_copy(
        update={"points": tuple(p.model_copy(update={"lam_plain": None}) for p in kept.points)}
    )
    assert "is exactly 1 and has no place here" in text_of(page_of(ladder("lie2"), gone))


def test_peers_stand_beside_the_schemes_or_are_named_as_left_out() -> None:
    peer = line(
        point(step_size=None, tolerance="1e-06", limited_by="tolerance", lam=None, lam_plain=None),
        name="DOP853", peer=True, claimed=None,
    )  # fmt: skip
    page = page_of(ladder(), peer)
    assert "DOP853" in "".join(figures(page)[0].itertext())
    assert "its tolerance" in text_of(page)
    assert "Not drawn" not in text_of(page)
    left = text_of(page_of(ladder(), left_out=(("DOP853", "scipy is not installed"),)))
    assert "Not drawn: DOP853 (scipy is not installed)." in left


@pytest.mark.left_to_ci
def test_number_systems_have_a_table_and_a_panel_of_their_own() -> None:
    lost = system(certified=None, reason="left range", seconds_min=None, seconds_median=None)
    fixed = system(arithmetic="fixed", seconds_median=1e-4)
    page = page_of(ladder(), systems=(system(), fixed, lost))
    assert "Certified digits of the end state" in text_of(page)
    assert "(d) certified digits" in drawn(page)
    assert "certified digits" not in drawn(page_of(ladder()))
    assert "– (left range)" in text_of(page)


def drawn(page: str) -> str:
    """All words of its one figure."""
    (svg,) = figures(page)
    return " ".join(svg.itertext())


def test_each_line_has_its_name_beside_it_in_each_panel() -> None:
    """Beside the legend: both errors and Λ have a line of each scheme."""
    names = [
        t.text for t in figures(page_of(ladder("a"), ladder("c")))[0].iter() if t.tag == "text"
    ]
    assert names.count("a") == names.count("c") == 3


def test_a_line_keeps_its_look_in_every_figure() -> None:
    """The second of three lines has no area to draw; the third looks the same without it."""
    gone = ladder("b", area_preserving=True)
    gone = gone.model_copy(
        update={"points": tuple(p.model_copy(update={"lam_plain": None}) for p in gone.points)}
    )
    (three,) = figures(page_of(ladder("a"), gone, ladder("c")))
    colours = {t.text: t.get("style") for t in three.iter() if t.tag == "text" and t.get("style")}
    assert "--series-3" in (colours["c"] or "")
    panels = [source(g) for g in three.iter() if g.get("id", "").endswith("axes_3")]
    assert not any("--series-2" in panel for panel in panels)


def source(svg: Any) -> str:
    return ElementTree.tostring(svg, encoding="unicode")


@pytest.mark.left_to_ci
def test_more_schemes_than_colours_are_all_drawn() -> None:
    many = [ladder(f"scheme{k}") for k in range(11)]
    shown = "".join(figures(page_of(*many))[0].itertext())
    assert all(f"scheme{k}, slope" in shown for k in range(11))


def test_the_figures_are_one_file_too() -> None:
    full, empty = (
        ElementTree.fromstring(standalone(each))  # noqa: S314 - our own
        for each in (result(ladder(), systems=(system(),)), result())
    )
    assert len(full.findall("{http://www.w3.org/2000/svg}svg")) == 1
    assert empty.tag == "{http://www.w3.org/2000/svg}svg"


def test_what_others_wrote_stays_text() -> None:
    lines = with_points(EVIL, FAILED), ladder("lie2")
    page = page_of(
        *lines, comparisons=compare_all(lines, "1"), clock=EVIL, reference=EVIL,
        systems_scheme=EVIL, left_out=((EVIL, EVIL),),
        systems=(system(arithmetic=EVIL, reason=EVIL),),
    )  # fmt: skip
    assert EVIL not in page
