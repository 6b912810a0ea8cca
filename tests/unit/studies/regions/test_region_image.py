"""Regions carried by maps: a scene's section, its plan, what is found, and what is no result."""

from fractions import Fraction
from pathlib import Path

import pytest

from tests.helpers.carried_regions import carried, within
from tests.helpers.constructed.scenes import load
from verify.errors import InputError
from verify.execution.keeper import NOTHING
from verify.execution.plan import plan_of
from verify.scenes.results.regions import EXACT_FLOW, FlowResult
from verify.studies.kinds.regions import FlowTask, flow_json, flows_of, need_flows
from verify.studies.regions import outline_images
from verify.studies.regions.hausdorff import Distance
from verify.studies.regions.outline_images import format_with_error

HEAD = 'system = "duffing"\nparameters = { delta = 1 }\nschemes = ["lie2", "stormer-verlet"]\n'
FLOW = """
[[flow]]
shape = "circle"
centre = { q = 1, p = 0 }
scale = 0.5
step_size = 0.1
steps = [5, 10]
"""


# -- a scene's section ----------------------------------------------------------------------------

BAD = {
    "unknown-shape": (("circle", "dog"), r"shape=dog: .*cat.*circle"),
    "two-shapes": (('scale = 0.5', 'path = "M 0 0 L 1 0 L 0 1 Z"'), "give one of shape, polygon"),
    "no-shape": (('shape = "circle"\n', ""), "give one of shape, polygon"),
    "scale-zero": (("0.5", "0"), "scale=0: must be greater than 0"),
    "scale-negative": (("0.5", "-1"), "scale=-1: must be greater than 0"),
    "steps-and-times": (("steps", "times = [1]\nsteps"), "give one of the two"),
    "neither": (("steps = [5, 10]", ""), "give one of the two"),
    "time-too-short": (("steps = [5, 10]", "times = [0.001]"), ": makes 0 steps; allowed: 1"),
    "times-alike": (("steps = [5, 10]", "times = [0.25, 0.26]"), "make the same number of steps"),
    "time-zero": (("steps = [5, 10]", "times = [0]"), "times"),
    "no-steps": (("[5, 10]", "[5, 0]"), "steps"),
    "steps-twice": (("[5, 10]", "[5, 5]"), "stands twice"),
    "times-twice": (("steps = [5, 10]", 'times = [1, "2/2"]'), "make the same number of steps"),
    "schemes-twice": (("scale", 'schemes = ["lie2", "lie2"]\nscale'), "stands twice"),
    "unknown-scheme": (("scale", 'schemes = ["lie"]\nscale'), "lie"),
    "digits": (("scale", "digits = 1001\nscale"), "must be at most 1000"),
    "two-points": (('shape = "circle"', "polygon = [[0, 0], [1, 1]]"), "allowed: 3"),
    "on-a-line": (('shape = "circle"', "polygon = [[0, 0], [1, 1], [2, 2]]"), "on one line"),
    "not-closed": (('shape = "circle"', 'path = "M 0 0 L 1 0 L 0 1"'), "path"),
    "no-path": (('shape = "circle"', 'path = "round"'), "path"),
    "h-zero": (("step_size = 0.1", "step_size = 0"), "must be greater than 0"),
    "unknown-key": (("scale", "size"), "unknown key"),
    "exact-no-bool": (("scale", "exact = 1\nscale"), "exact"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_bad_input_is_one_line_that_names_it(name: str, tmp_path: Path) -> None:
    (old, new), problem = BAD[name]
    assert old in FLOW
    with pytest.raises(InputError, match=problem) as info:
        load(tmp_path, HEAD + FLOW.replace(old, new))
    assert "\n" not in str(info.value)
    load(tmp_path, HEAD + FLOW)


def tasks(folder: Path, *sections: str, head: str = HEAD) -> list[FlowTask]:
    plan = plan_of([load(folder, head + section) for section in sections], need_flows)
    return [t for t in plan.tasks.values() if isinstance(t, FlowTask)]


def test_the_plan_has_each_map_and_number_of_steps(tmp_path: Path) -> None:
    found = [(t.map, t.steps, t.mean_lambda, t.distance) for t in tasks(tmp_path, FLOW)]
    assert found == [
        (EXACT_FLOW, 5, False, False), (EXACT_FLOW, 10, False, False),
        ("lie2", 5, True, True), ("lie2", 10, True, True),
        ("stormer-verlet", 5, False, True), ("stormer-verlet", 10, False, True),
    ]  # fmt: skip
    less = FLOW + 'exact = false\nmean_lambda = false\nschemes = ["lie2"]\n'
    found = [(t.map, t.steps, t.mean_lambda, t.distance) for t in tasks(tmp_path, less)]
    assert found == [("lie2", 5, False, False), ("lie2", 10, False, False)]


def test_tasks_are_shared_between_scenes_and_times_are_steps(tmp_path: Path) -> None:
    timed = FLOW.replace("steps = [5, 10]", "times = [1]").replace("0.5", '"1/2"')
    assert len(tasks(tmp_path, FLOW, timed)) == len(tasks(tmp_path, FLOW)) == 6
    assert len(tasks(tmp_path, FLOW, FLOW.replace("0.5", "0.6"))) == 12


def test_what_is_left_out_has_its_reason(tmp_path: Path) -> None:
    plan = plan_of([load(tmp_path, HEAD + FLOW)], need_flows)
    assert plan.left_out == [
        (
            "mine: mean of Λ over the region for stormer-verlet",
            "ΔJ ≡ 0 is proved: Λ is exactly 0",
        )
    ]
    assert not plan_of([load(tmp_path, HEAD + FLOW + "mean_lambda = false\n")], need_flows).left_out


# -- what is found --------------------------------------------------------------------------------


def test_every_printed_number_carries_the_rounding_of_its_text() -> None:
    for value, error in ((1.5049, 0.001), (1.5, 1e-30), (-9.96e-7, 4e-9), (1e-9, 3e-9)):
        text, bound = format_with_error(Fraction(value), Fraction(error))
        off = abs(Fraction(text) - Fraction(value))
        assert off + Fraction(error) <= Fraction(bound) <= 3 * Fraction(error) + Fraction(1, 10**11)


def test_numbers_are_decimal_strings_and_survive_json(tmp_path: Path) -> None:
    scene = load(tmp_path, HEAD + FLOW)
    plan = plan_of([scene], need_flows)
    results = {n: t.compute(NOTHING) for n, t in plan.tasks.items()
               if isinstance(t, FlowTask)}  # fmt: skip
    (found,) = flows_of(scene, results)
    assert FlowResult.model_validate_json(found.model_dump_json()) == found
    shown = flow_json([("mine", found)])
    assert (shown["map"], shown["steps"]) == ("lie2", 10)
    for name in ("area_change", "probe_error", "mean_lambda"):
        assert isinstance(shown[name], str)
        assert Fraction(shown[name]) != 0
    maps = [t.map for t in plan.tasks.values() if isinstance(t, FlowTask)]
    assert [i["map"] for i in shown["images"]] == maps
    by_map = {i["map"]: i for i in shown["images"]}
    assert by_map["stormer-verlet"]["mean_lambda"] is None
    assert by_map["stormer-verlet"]["area_preserving"]
    assert Fraction(by_map["lie2"]["distance"]) > Fraction(by_map["lie2"]["distance_error"])
    assert flows_of(scene, {}) == ()
    assert next(iter(plan.tasks.values())).key in results


def test_a_clockwise_path_has_a_positive_area_and_the_same_change() -> None:
    one = carried(shape={"path": "M 0 0 L 1 0 L 1 1 Z"})
    two = carried(shape={"path": "M 0 0 L 1 1 L 1 0 Z"})
    assert one.outlines[0].area == two.outlines[0].area == "5.00000000000e-01"
    assert within(one, Fraction(two.area_change or 0))


# -- what is no result ----------------------------------------------------------------------------


@pytest.mark.left_to_ci
def test_where_float64_cannot_tell_the_change_33_digits_do() -> None:
    found = carried(scheme="lie6", h="0.001", steps=3, mean_lambda=False)
    assert (found.arithmetic, found.digits) == ("fixed", 33)
    assert not found.problem
    assert 0 < abs(Fraction(found.area_change or 0)) < Fraction(1, 10**20)
    assert abs(Fraction(found.area_change or 0)) > 100 * Fraction(found.probe_error or 1)


def test_a_change_that_33_digits_cannot_tell_is_a_problem_and_no_number() -> None:
    triangle = {"polygon": [["1", "0"], ["2", "0"], ["1", "1"]]}
    asked = {"scheme": "lie2", "h": "1e-13", "steps": 3, "mean_lambda": False, "shape": triangle}
    found = carried(**asked)
    assert found.area_change is None
    assert "is not 100 times below the change of area" in found.problem
    more = carried(**asked, digits=60)
    assert not more.problem
    assert more.area_change is not None


def test_points_that_leave_and_flows_that_blow_up_are_told_in_one_line() -> None:
    soft = {"hamiltonian": "p**2/2 - q**4/4", "shape": {"shape": "circle", "scale": 3}}
    left = carried(**soft, steps=400)
    assert "leaves the range of float64" in left.problem
    blown = carried(**soft, scheme=EXACT_FLOW, steps=400)
    assert "blows up at t = " in blown.problem
    for image in (left, blown):
        assert (image.area_change, image.outlines) == (None, ())
        assert "\n" not in image.problem


def test_a_figure_of_eight_is_told() -> None:
    found = carried(shape={"path": "M -1 -1 L 1 1 L 1 -1 L -1 1 Z"})
    assert "bounds no area" in found.problem


def test_a_region_away_from_the_shapes_origin_needs_no_map_there() -> None:
    """Rays from the origin would cross what the map cannot carry."""
    well = {"hamiltonian": "p**2/2 + 1/q + q", "h": "0.01", "scheme": "lie2"}
    found = carried(**well, shape={"polygon": ((1, 0), ("1.2", 0), (1, "0.2"))})
    assert found.agree
    assert not found.problem


# -- planted errors -------------------------------------------------------------------------------


def test_a_distance_is_that_of_the_exact_flow_for_the_same_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    still = {"hamiltonian": "p", "scheme": "lie1", "mean_lambda": False, "distance": True}
    found = carried(**still)  # q' = 1: the scheme is exact
    assert Fraction(found.distance or 1) <= Fraction(found.distance_error or 0) < 1e-5
    right = outline_images.ExactFlowCarrier
    monkeypatch.setattr(
        outline_images, "ExactFlowCarrier", lambda h, t, *t0: right(h, t + Fraction(1, 8), *t0)
    )
    found = carried(**still)
    off = abs(Fraction(found.distance or 0) - Fraction(1, 8))
    assert off <= Fraction(found.distance_error or 0)


def test_the_greatest_distance_of_all_outlines_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    told = iter([0.00025, 0.0005, 0.000125])  # less than of points that belong together
    monkeypatch.setattr(outline_images, "hausdorff", lambda *_: Distance(next(told), 1e-9))
    path = "M 0 0 L 1 0 L 0 1 Z M 2 0 L 3 0 L 2 1 Z M 4 0 L 5 0 L 4 1 Z"
    found = carried(shape={"path": path, "scale": "0.1"}, distance=True, mean_lambda=False)
    assert Fraction(found.distance or 0) == Fraction(1, 2000)
