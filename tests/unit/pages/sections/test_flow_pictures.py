"""What is said of the pictures of regions carried by maps is what they show."""

import re

import numpy as np
import pytest
from matplotlib.transforms import Bbox

from tests.helpers.constructed.flows import (
    FAILED,
    circle,
    exact,
    flow,
    image,
    in_degrees,
    outline,
    spiral,
)
from tests.unit.pages.test_page import scene
from verify.errors import InputError
from verify.pages.figures.flow_grid import grid_of
from verify.pages.figures.label_place import choose_place
from verify.pages.plotting import plot_flow
from verify.pages.sections.scene import flow as section
from verify.scenes.results.regions import FlowResult


def finding_of(made: FlowResult) -> str:
    return section.SECTION.view(scene(flows=(made,)), "x").regions[0].finding.replace("\xa0", " ")


def caption_of(made: FlowResult) -> str:
    plot = section.SECTION.view(scene(flows=(made,)), "x").regions[0].plot
    assert plot is not None
    return plot.caption.replace("\xa0", " ")


def test_a_distance_below_its_own_error_is_one_bound() -> None:
    said = finding_of(flow(image(distance="5e-07", distance_error="5.01e-07")))
    assert "Its outlines are at most 1.1 × 10⁻⁶ away" in said, "1.001e-6, rounded up"
    assert "±" not in said.split("Its outlines")[1]


def test_a_change_is_unseen_only_if_its_error_leaves_no_doubt() -> None:
    assert "picture can show" in finding_of(flow(image(area_change="9e-04", probe_error="9e-05")))
    doubtful = image(area_change="9e-04", probe_error="2e-04")
    assert "picture can show" not in finding_of(flow(doubtful))


def test_of_a_map_whose_last_image_failed_the_last_known_change_is_told_too() -> None:
    said = finding_of(flow(image(), image(steps=200), FAILED))
    assert "N = 200 changes the area" in said
    assert "N = 400: no change of area is known" in said
    assert "N = 100" not in said


def test_a_row_without_any_image_is_not_drawn_and_it_is_said() -> None:
    drawn_out = image(outlines=(outline(spiral()),))
    made = flow(drawn_out, FAILED)
    assert [row.partition(",")[0] for row in grid_of(made).counts] == ["N = 100"]
    assert "At N = 400 there is no image." in caption_of(made)
    assert "there is no image" not in caption_of(flow(drawn_out))


@pytest.mark.parametrize(("distance", "near"), [("1e-6", True), ("0.5", False)])
def test_images_are_said_to_be_one_line_only_where_they_are(distance: str, near: bool) -> None:
    caption = caption_of(flow(exact(), image(distance=distance)))
    assert ("All images by lie2 lie within a line’s width" in caption) is near
    assert ("Some images by lie2 lie further" in caption) is not near


def test_an_image_upon_what_was_before_is_said_to_hide_it() -> None:
    still = image(steps=3, outlines=(outline(circle(0.0001)),))
    assert "At N = 3 the image lies within" in caption_of(flow(still, image()))
    assert "hides it" not in caption_of(flow(image()))


def test_an_outline_that_is_drawn_out_is_said_to_be() -> None:
    # five turns of radius 0.5 … 1.5, there and back: about 62 against 2π
    caption = caption_of(flow(image(outlines=(outline(spiral()),))))
    assert re.search(r"After N = 100 steps by lie2 the outline is (9\.\d|10) times", caption)
    assert "times as long" not in caption_of(flow(image()))


def test_each_plane_of_several_degrees_has_a_picture_and_the_table_the_areas_in_all() -> None:
    (region,) = section.SECTION.view(scene(flows=(in_degrees(),)), "x").regions
    first, second = region.plots
    assert "as it is seen in (q1, p1)" in first.lead
    assert "as it is seen in (q2, p2)" in second.lead
    assert "+ is where all of it was before" in second.caption
    assert (
        "circle at (q1, p1) = (0, 0), scale 1, p2 = 0.5, q2 = 0.1"
        in first.lead.replace("\xa0", " ").lower()
    )
    assert region.heads[2:5] == ("change of ∮ p·dq", "mean of W", "by planes")
    assert "0.75" in region.rows[1].cells[4]
    assert "0.25" in region.rows[1].cells[4]


def test_the_plane_that_is_drawn_can_be_chosen() -> None:
    result = in_degrees()
    own, other = grid_of(result), grid_of(result, 2)
    assert (own.axes, other.axes) == (("q1", "p1"), ("q2", "p2"))
    assert other.before[0].tolist() == [[0.1, 0.5]]
    assert {axes.get_xlabel() for axes in plot_flow(result, 2).axes} == {"q2"}
    with pytest.raises(InputError, match="plane=3: must be 1 … 2"):
        plot_flow(result, 3)


def test_a_label_keeps_clear_of_what_is_drawn_and_of_other_labels() -> None:
    named = np.array([[40.0, 40.0], [60.0, 60.0]])
    room = Bbox([[0, 0], [100, 100]])
    free = choose_place((20, 10), named, named, [], room)
    assert free.y0 >= 60, "above, where nothing else is"
    above = np.column_stack([np.linspace(0, 100, 50), np.full(50, 68.0)])
    moved = choose_place((20, 10), named, np.vstack([named, above]), [], room)
    assert not moved.y0 < 68 < moved.y1
    assert choose_place((20, 10), named, named, [free], room).bounds != free.bounds
