"""A page of many runs: of a bounded size; it says what it leaves out, and leaves out no failure."""

import re
from functools import cache
from typing import Any

import pytest

from tests.unit.pages.figures.test_figures import figures
from tests.unit.pages.sections.test_separation_view import text_of
from tests.unit.pages.test_page import report, run, scene
from verify.pages.figures.step_size_figures import MOST_LINES, LogarithmicLine, select_lines
from verify.pages.page import render
from verify.pages.sections.table_rows import MOST_ROWS, select_members
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.run import RunResult

STEP_SIZES = ("0.01", "0.02", "0.04")


def runs(starts: int, **of_the_last: Any) -> tuple[RunResult, ...]:
    """So many initial values at three step sizes each; the very last run as told."""
    found = [
        run(
            q=str(k + 1),
            step_size=h,
            values={
                "lambda": Value(value=f"{k + 1}.00e-{9 - 2 * j:02}", bound="1.00e-20"),
                "mse": Value(value=f"{k + 1}.00e-{20 - 3 * j}", bound="1.00e-40"),
            },
        )
        for k in range(starts)
        for j, h in enumerate(STEP_SIZES)
    ]
    return (*found[:-1], found[-1].model_copy(update=of_the_last))


def page_of(found: tuple[RunResult, ...]) -> str:
    return render(report((scene(runs=found),)))


@cache
def page_with(starts: int) -> str:
    return page_of(runs(starts))


def rows_of(page: str) -> int:
    return len(re.findall(r'<tr><th scope="row">', page))


@pytest.mark.left_to_ci
def test_a_table_has_room_for_so_many_rows_and_the_page_says_of_how_many() -> None:
    page = text_of(page_with(400))
    assert "All 1,200 runs of lie2" in page
    assert f"{MOST_ROWS} of 1,200 are shown; all are in results.json." in page
    small = text_of(page_with(MOST_ROWS // 3))
    assert "are shown" not in small


def test_five_times_as_many_runs_make_hardly_a_larger_page() -> None:
    few, many = page_with(200), page_with(1000)
    assert rows_of(few) == rows_of(many)
    assert len(many) < 1.02 * len(few)


def test_a_failure_beyond_the_room_is_shown_all_the_same() -> None:
    failed: dict[str, Any] = {"status": "left range", "failed_step": 77, "values": {}}
    page = text_of(page_of(runs(400, **failed)))
    assert "left the range of float64 at step 77" in page
    assert f"{MOST_ROWS} of 1,200 are shown, the 1 that did not end well among them" in page


def test_what_failed_has_room_first_and_the_order_stays() -> None:
    groups = [list(range(500)), list(range(500, 1000))]
    of_groups = list(select_members(groups, lambda k: k % 2))
    assert [sorted(group) for group in of_groups] == of_groups
    held = [k for group in of_groups for k in group]
    assert len(held) == MOST_ROWS
    assert {k for k in range(1000) if k % 2} <= set(held)
    assert [k for k in held if k % 2 == 0] == list(range(0, 200, 2))
    assert len([k for group in select_members(groups, lambda _: True) for k in group]) == MOST_ROWS


def test_a_figure_draws_so_many_lines_with_both_extremes_and_says_so() -> None:
    page = page_with(400)
    assert f"{MOST_LINES} of them are drawn, from the highest to the lowest." in text_of(page)
    drawn = [
        len([e for e in svg.iter() if e.tag == "path" and e.get("d", "").count("L") == 2])
        for svg in figures(page)
    ]
    assert max(drawn) <= 2 * MOST_LINES
    assert "of them are drawn" not in text_of(page_with(MOST_LINES))


@pytest.mark.parametrize("count", [1, 2, MOST_LINES, MOST_LINES + 1, 1000])
def test_thinned_lines_keep_the_highest_and_the_lowest(count: int) -> None:
    made = [LogarithmicLine(str(k), (("1", float(k * 7919 % count)),)) for k in range(count)]
    kept = select_lines(made)
    assert len(kept) == min(count, MOST_LINES)
    heights = [line.points[0][1] for line in kept]
    assert {0.0, float(max(x.points[0][1] for x in made))} <= set(heights)
    assert kept == [line for line in made if line in kept]
