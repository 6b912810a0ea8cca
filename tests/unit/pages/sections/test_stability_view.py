"""The page's part on stability says what the data say, and only where it was asked for."""

from typing import Any

import pytest

from tests.helpers.constructed.stability import LARGEST, LEFT, MAP, NEVER, case
from tests.helpers.pages.imported_modules import imported_by
from tests.unit.pages.sections.test_growth_view import text_of
from tests.unit.pages.test_page import report, run, scene
from verify.pages.page import render


def page_of(**changes: Any) -> str:
    return render(report((scene(**changes),)))


def test_a_scene_that_did_not_ask_shows_nothing_of_it() -> None:
    assert "Stability" not in render(report((scene(runs=(run(),)),)))


@pytest.mark.parametrize(
    ("made", "absent"),
    [
        ("scene(runs=(run(),))", {"verify.pages.figures.kind_map_figure"}),
        ("scene(stability=(LEFT,))", {"verify.pages.figures.kind_map_figure", "matplotlib"}),
    ],
)
def test_what_is_not_shown_is_not_imported(made: str, absent: set[str]) -> None:
    assert not absent & imported_by(
        "from tests.helpers.constructed.stability import LEFT", f"render(report(({made},)))"
    )


def test_the_verdicts_are_counted_and_what_occurs_is_explained() -> None:
    text = text_of(page_of(stability=(case(), case(), LEFT)))
    assert "Of 3 runs: 2 drifting and 1 unstable by the scheme." in text
    assert "drifts (1.25e-04 of its energy scale per unit time)" in text
    assert "leaves at step 7" in text
    assert "the scheme’s doing" in text
    assert "float64’s rounding" not in text


@pytest.mark.parametrize(
    ("id_", "named"),
    [
        ("mine/some/lie2/h=0.1", "some"),
        ("mine/some/lie2/h=0.1/z0 no. 2", "some, z0 no. 2"),
        ("mine/lie2/h=0.1", ""),
    ],
)
def test_a_case_is_named_by_its_section_and_initial_value(id_: str, named: str) -> None:
    page = page_of(stability=(case(id=id_),))
    assert f'<th scope="row">{named}</th><td><code>lie2</code></td>' in page


def test_the_fastest_drift_is_told() -> None:
    slow = case(rate="-1.00e-09", scheme="lie4")
    text = text_of(page_of(stability=(slow, case())))
    assert "The fastest drift is that of lie2 at h = 0.1" in text
    assert "fastest drift" not in text_of(page_of(stability=(LEFT,)))


def test_measured_steps_stand_beside_those_of_linear_theory() -> None:
    text = text_of(page_of(largest_steps=(LARGEST, NEVER)))
    assert "0.95 to 0.95 times the one that it predicts" in text
    assert "For lie2 it allows none" in text
    assert "none is stable" in text
    assert "until t = 100" in text


def test_a_map_is_a_figure_with_counts_and_the_line_of_linear_theory() -> None:
    page = page_of(stability_maps=(MAP,))
    text = text_of(page)
    assert "Stability of lie4 over the step size h and a." in text
    assert "2 stable, 1 drifting, 1 unstable by the scheme, 1 escaping and 1 overflowing" in text
    assert "The line is where h times the orbit’s greatest frequency" in text
    assert "limit of linear theory" in page


def test_without_a_limit_the_map_has_no_line() -> None:
    page = page_of(stability_maps=(MAP.model_copy(update={"linear": ("0", "0")}),))
    assert "linear theory has no stable step." in text_of(page)
    assert "limit of linear theory" not in page


def test_names_that_are_markup_stay_text() -> None:
    evil = case(id="mine/<script>/lie2/h=0.1", detail="<script>alert(1)</script>")
    assert "<script>alert" not in page_of(stability=(evil,))
