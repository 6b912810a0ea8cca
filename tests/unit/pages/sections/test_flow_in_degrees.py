"""A region in two degrees of freedom on the page, and Poincaré sections that escape."""

from typing import Any

import numpy as np
import pytest

from tests.helpers.constructed.flows import circle, exact, flow, image, outline
from verify.errors import InputError
from verify.pages.figures.flow_grid import grid_of
from verify.pages.figures.orbit_points_figure import select_points
from verify.pages.plotting import plot_flow
from verify.pages.sections.flow_finding import finding, findings
from verify.pages.sections.scene.flow import SECTION
from verify.scenes.results.orbit_points import MapSections, PoincareOrbit, PoincareResult
from verify.scenes.results.regions import FlowResult, Projection
from verify.scenes.results.report import SceneResult


def seen(steps: int) -> Any:
    projections = tuple(
        Projection(plane=k, area=area, area_error="1e-12", points=circle(steps / 100 + k))
        for k, area in ((1, "0.75"), (2, "0.25"))
    )
    return (outline(circle(steps / 100 + 1), projections=projections),)


def in_degrees(**changes: Any) -> FlowResult:
    none = {
        "mean_lambda": None,
        "mean_lambda_error": None,
        "distance": None,
        "distance_error": None,
    }
    by_lie2 = {"mean_defect": "-1.234e-05", "mean_defect_error": "2.0e-08", **none, **changes}
    images = (exact(outlines=seen(100), distance=None), image(outlines=seen(100), **by_lie2))
    point = {"p1": "0", "p2": "0.5", "q1": "0", "q2": "0.1"}
    return flow(*images, plane=1, point=point)


def test_each_plane_has_a_picture_and_the_table_both_areas() -> None:
    scene = SceneResult(
        name="cat", title="", hamiltonian="", parameters={}, source="", time=None,
        proofs=(), criteria=(), runs=(), series=(), flows=(in_degrees(),),
    )  # fmt: skip
    (region,) = SECTION.view(scene, "of-it").regions
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


def test_sentences_speak_of_the_invariant_and_not_of_area() -> None:
    result = in_degrees()
    said = " ".join((*findings([result]), *finding(result)))
    assert "The largest relative change of ∮ p·dq is that by lie2" in said
    assert "mean of W over the region, computed without any curve, is the same" in said
    assert "the projections to (q1, p1) and (q2, p2) enclose 0.75 and 0.25" in said
    assert "Λ" not in said
    assert "det J" not in said


def test_a_mean_that_differs_is_said_to() -> None:
    said = " ".join(findings([in_degrees(agree=False)]))
    assert "one of the two is wrong there" in said


def test_the_plane_that_is_drawn_can_be_chosen() -> None:
    result = in_degrees()
    own, other = grid_of(result), grid_of(result, 2)
    assert (own.axes, other.axes) == (("q1", "p1"), ("q2", "p2"))
    assert other.before[0].tolist() == [[0.1, 0.5]]
    assert {axes.get_xlabel() for axes in plot_flow(result, 2).axes} == {"q2"}
    with pytest.raises(InputError, match="plane=3: must be 1 … 2"):
        plot_flow(result, 3)


def orbit(*points: tuple[str, str], left: bool = False) -> PoincareOrbit:
    return PoincareOrbit(
        q=("0", "0"), p=("1", "0"), energy="0.5", points=points, known=len(points), error="1e-12",
        left=left,
    )  # fmt: skip


def test_points_of_an_orbit_that_escapes_do_not_blow_up_the_picture() -> None:
    near = tuple((f"{np.cos(k):.4f}", f"{np.sin(k):.4f}") for k in range(100))
    far = orbit(*near[:10], ("1e+120", "-1e+150"), left=True)
    sections = MapSections(map="lie2", orbits=(orbit(*near), far), arithmetic="mpfr", digits=33,
                           seconds=0.1)  # fmt: skip
    result = PoincareResult(
        coordinate="q1", value="0", rising=True, draw=("q2", "p2"), step_size="0.1", steps=9,
        time="0.9", sections=(sections,),
    )  # fmt: skip
    points, outside = select_points(result)
    assert outside == 1
    assert np.nanmax(np.abs(np.concatenate(points[0]))) <= 1
    assert not np.isnan(points[0][0]).any()
