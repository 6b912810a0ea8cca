"""The page's part on truncation against rounding says what the data say, and only where asked."""

import re
from typing import Any

import pytest

from tests.helpers.constructed.separations import (
    BELOW,
    BOTH,
    CROSSING,
    PARTS,
    evaluation,
    grid,
    point,
)
from tests.helpers.pages.imported_modules import imported_by
from tests.unit.pages.figures.test_figures import figures
from tests.unit.pages.test_page import EVIL, SCRIPT, Reader, proof, report, run, scene
from verify.pages.page import render
from verify.pages.sections.separation_summary import describe_separation
from verify.pages.text.typography import group_digits, step
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.report import SceneResult
from verify.scenes.results.run import SeriesPoint
from verify.scenes.results.separation import SeparationGrid
from verify.studies.separation.truncation_and_rounding import as_grid


def page_of(*own: SeparationGrid, wide: tuple[SeparationGrid, ...] = (), **changes: Any) -> str:
    return render(report((scene(separations=own, crossovers=wide, **changes),)))


def text_of(page: str) -> str:
    return " ".join("".join(Reader(page).texts).replace("\xa0", " ").split())


# -- absence --------------------------------------------------------------------------------------


def test_a_scene_without_separations_shows_nothing_of_them() -> None:
    page = render(report((scene(runs=(run(), run(step_size="0.02"))),)))
    assert not re.search(r"[Tt]runcation|[Cc]rossover|trajectory", page)


def test_a_page_without_runs_has_no_terms_of_runs() -> None:
    assert "Number systems" not in render(report((scene(),)))
    assert "Number systems" in render(report((scene(runs=(run(),)),)))


@pytest.mark.parametrize(
    ("made", "absent"),
    [
        ("scene(runs=(run(),))", {"verify.pages.figures.step_size_figures", "matplotlib"}),
        ("scene(separations=(BELOW,))", {"verify.pages.figures.step_size_figures", "matplotlib"}),
    ],
)
def test_what_is_not_shown_is_not_imported(made: str, absent: set[str]) -> None:
    assert not absent & imported_by(
        "from tests.helpers.constructed.separations import BELOW", f"render(report(({made},)))"
    )


# -- what it says ---------------------------------------------------------------------------------


def test_the_first_sentence_counts_what_the_data_say() -> None:
    text = text_of(page_of(BELOW, CROSSING))
    assert (
        "on the grid of runs, the rounding in Λ is below truncation in 5 of 6 entries, by 1.0 to "
        "5.0 decades, and above truncation in 1 of 6 entries, by 1.0 decades." in text
    )
    assert "Its greatest part is determinant in all 6 entries." in text
    assert "rounding is smaller in all 6 entries, by 5.0 to 8.0 decades." in text
    assert "the plain way, drift in all 6 entries; closed form, drift in all 6 entries" in text


def test_the_closed_form_is_not_said_to_be_better_where_it_is_worse() -> None:
    text = text_of(page_of(grid(["1.000e-07"] * 3, ["1.000e-07", "1.000e-06", "1.000e-08"])))
    assert "smaller in 1 of 3 entries, by 1.0 decades, and greater in 1 of 3 entries" in text


def test_an_entry_without_known_digits_is_no_number_and_no_decade() -> None:
    nothing = evaluation("0", "0", dict.fromkeys(PARTS, "0"))
    text = text_of(page_of(as_grid([point("0.1", nothing, nothing)])))
    assert "Of truncation or of rounding no digit is known" in text
    assert "|·| ≤ 1.00 × 10⁻⁴⁰" in text
    assert "decades below" not in text


def test_an_entry_that_left_the_range_says_so() -> None:
    gone = point("0.5", None, None, status="left range", failed_step=3, reason="left it at step 3")
    text = text_of(page_of(as_grid([*BELOW.points, gone])))
    assert "left it at step 3" in text
    assert "1 of 4 entries could not be separated" in text
    assert "No entry could be separated" in text_of(page_of(as_grid([gone])))


def test_a_run_whose_det_j_has_no_logarithm_has_no_closed_form() -> None:
    only = as_grid([point("0.1", evaluation("1.000e-02", "1.000e-07"), None)])
    assert "log1p" not in text_of(page_of(only))


def test_every_part_in_the_table_has_its_known_digits_and_the_greatest_is_bold() -> None:
    parts = {"input": "-1.23456e-21", "product": "9.8e-05"}
    page = page_of(as_grid([point("0.1", evaluation("1.000e-02", "1.000e-07", parts), None)]))
    text = text_of(page)
    assert "−1.235 × 10⁻²¹" in text
    assert "<b>9.8\xa0×\xa010⁻⁵</b>" in page
    assert "5.0 decades below" in text


def test_what_others_wrote_in_a_separation_stays_text() -> None:
    evil = point("0.1", None, None, scheme=EVIL, reason=EVIL)
    fine = point("0.2", evaluation("1.000e-02", "1.000e-07"), None, scheme=EVIL, error_method=EVIL,
                 arithmetic=EVIL)  # fmt: skip
    page = page_of(as_grid([evil, fine]), proofs=(proof(scheme=EVIL),))
    reader = Reader(page)
    assert reader.scripts == [SCRIPT]
    assert "".join(reader.texts).count(EVIL) > 4


# -- the figure -----------------------------------------------------------------------------------


def dashed(svg: Any) -> list[str]:
    """The texts of the labels of crossovers."""
    return [e.text for e in svg.iter() if e.tag == "text" and (e.text or "").startswith("h* ≈")]


def test_each_crossover_is_marked_once_and_told_with_its_bracket() -> None:
    page = page_of(wide=(CROSSING, BOTH, BELOW))
    one, two, none = figures(page)
    assert [len(dashed(svg)) for svg in (one, two, none)] == [1, 2, 0]
    text = text_of(page)
    assert "The plain way: h* ≈ 3.2 × 10⁻³, between 0.001 and 0.01." in text
    assert "Closed form: no crossover; truncation is larger at every step size." in text
    assert "Either way: no crossover; truncation is larger at every step size." in text
    assert "N = 20 … 2,000 steps. In place of exact arithmetic: mpfr." in text
    assert "Error bounds all enclosed: rounding counted." in text


def test_the_figure_is_themed_and_its_lines_differ_by_more_than_colour() -> None:
    (svg,) = figures(page_of(wide=(BOTH,)))
    lines = [e for e in svg.iter() if e.get("style", "").startswith("stroke: var(--series")]
    assert len({e.get("style") for e in lines}) == 3
    assert len({e.get("stroke-dasharray") for e in lines if e.tag == "path"}) == 3
    assert all(e.get("fill") == "currentColor" for e in svg.iter() if e.tag == "text")
    assert svg.get("aria-label").startswith("Truncation and rounding in Λ against h")


def test_a_grid_of_one_step_size_has_no_figure() -> None:
    only = as_grid([point("0.1", evaluation("1.000e-02", "1.000e-07"), None)])
    assert not figures(page_of(wide=(only,)))


def test_a_small_step_size_is_a_power_of_ten() -> None:
    given = ("0.000002", "0.00001", "0.0001", "0.1", "1/3")
    assert [step(h) for h in given] == ["2\xa0×\xa010⁻⁶", "10⁻⁵", "0.0001", "0.1", "1/3"]


# -- runs and series ------------------------------------------------------------------------------


def certified(**changes: Any) -> SceneResult:
    digits = {"lambda": Value(value="-1.32096189159046688939637825375e-06", bound="3.78e-36")}
    own = {"arithmetic": "fixed", "error_kind": "enclosed", "values": digits, "digits": 30}
    return scene(runs=(run(**own | changes), run(**own | {"step_size": "0.02"})))


def test_thirty_digits_stand_in_groups_and_none_is_lost() -> None:
    shown = str(group_digits("-1.32096189159046688939637825375e-06"))
    assert re.sub("<[^>]*>", "", shown) == "−1.32096189159046688939637825375\xa0×\xa010⁻⁶"
    assert shown.count("<br>") == 1
    assert "<span>−1.32096</span><span>18915</span>" in shown
    assert group_digits("1.25e-05") == "1.25\xa0×\xa010⁻⁵"
    assert group_digits("123456789012345678901234567890") == "123456789012345678901234567890"


def test_the_table_of_runs_says_which_of_them_are_certified() -> None:
    assert "All 2 runs are certified" in render(report((certified(),)))
    assert "1 of 2 runs are certified" in render(report((certified(error_kind="estimated"),)))
    assert "estimates, not certificates" in render(report((scene(runs=(run(), run())),)))


def test_a_fallback_says_why_and_for_which_runs() -> None:
    page = render(report((certified(arithmetic="mpfr", fallback="the orbit is too wide"),)))
    assert "One run (h = 0.01) went to mpfr instead: the orbit is too wide." in text_of(page)


def test_a_run_that_leaves_where_h_is_defined_says_so() -> None:
    left = "by step 14 the orbit has left where H is defined: q > 0"
    page = text_of(render(report((certified(left_domain=left),))))
    assert f"h = 0.01: {left}." in page
    assert "has left" not in text_of(render(report((certified(),))))


def test_a_run_of_which_no_digit_is_known_says_so() -> None:
    page = render(report((certified(status="unresolved", values={}, error_method="too few"),)))
    assert "no digit could be confirmed: too few" in page


def test_a_series_names_what_it_repeats_only_where_the_scene_says_so() -> None:
    points = tuple(
        SeriesPoint(first=i, last=i, delta_j=("-1e-9", "1e-9"), lam=("0", "1e-8"))
        for i in range(1, 4)
    )
    page = render(report((scene(series=(run(series=points, source="Figure 10"),)),)))
    assert "p₀ = −0.5 (for Figure 10)." in text_of(page)
    assert "Figure" not in text_of(render(report((scene(series=(run(series=points),)),))))


@pytest.mark.parametrize("unknown", [0, 1, 2])
def test_how_often_the_closed_form_gains_is_said_of_all_that_have_it(unknown: int) -> None:
    """Of an entry of which no digit is known nothing is gained, and it counts among the others."""
    gained = [evaluation("1.000e-02", "1.000e-05"), evaluation("1.000e-02", "1.000e-12")]
    silent = [evaluation("1.000e-02", "0"), evaluation("1.000e-02", "0")]
    points = [point("0.1", *gained), point("0.2", *gained)]
    points += [point(f"0.{3 + k}", *silent) for k in range(unknown)]
    said = " ".join(describe_separation(points))
    among = f"{2 + unknown} entries" if unknown else "all 2 entries"
    said = said.partition("log1p summation")[2]
    assert f"smaller in {f'2 of {among}' if unknown else among}" in said
