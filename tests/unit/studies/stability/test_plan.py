"""What a scene may ask of stability: its keys, bad input in one line, tasks, what is left out."""

from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import verify
from tests.helpers.constructed.scenes import load
from verify.commands.shared.input import load_target
from verify.errors import InputError
from verify.execution.plan import plan_of
from verify.scenes.scene import scene_from
from verify.scenes.stability_sections import Stability, StabilityMap
from verify.studies.kinds.stability import need_stability, stability_tasks
from verify.studies.tasks_of_scenes import plan_scenes

HEAD = """
hamiltonian = "p**2/2 + q**2/2 + d*q**4/4"
parameters = { d = 2 }
schemes = ["lie2", "stormer-verlet"]
"""
CASES = """
[[stability]]
name = "some"
time = 10
step_sizes = [0.1, 0.3]
initial_values = [{ q = 1, p = 0 }, { q = 2, p = 0 }]
"""
LARGEST = """
[[largest_step]]
time = 10
initial_value = { q = 1, p = 0 }
"""
MAP = """
[[stability_map]]
parameter = "d"
values = { from = 0.01, to = 100, count = 5 }
step_sizes = [0.1, 1]
steps = 100
initial_value = { q = 1, p = 0 }
schemes = ["lie4"]
"""


def test_each_case_is_a_task_with_a_name_of_its_own(tmp_path: Path) -> None:
    scene = load(tmp_path, HEAD + CASES)
    found = list(stability_tasks(scene))
    assert len(found) == 2 * 2 * 2
    assert len({name for name, _ in found}) == len(found)
    name, task = found[0]
    assert name.endswith("/some/lie2/h=0.1/z0 no. 1")
    assert (task.scheme, task.step_size, task.steps, task.q) == ("lie2", Fraction(1, 10), 100, 1)
    assert found[1][1].steps == 33  # the whole steps that fit


def test_a_range_is_even_on_a_logarithmic_scale(tmp_path: Path) -> None:
    (over,) = load(tmp_path, HEAD + MAP).stability_map
    assert isinstance(over, StabilityMap)
    assert [str(v) for v in over.values] == ["1/100", "1/10", "1", "10", "100"]


def test_only_what_is_asked_for_is_planned(tmp_path: Path) -> None:
    scene = load(tmp_path, HEAD + CASES + LARGEST + MAP)
    kinds = [task.kind for task in plan_of([scene], need_stability).tasks.values()]
    assert kinds.count("stability") == 8
    assert kinds.count("largest_step") == 2
    assert kinds.count("stability_map") == 1
    assert set(kinds) == {"stability", "largest_step", "stability_map"}
    whole = [task.kind for task in plan_scenes([scene]).tasks.values()]
    assert set(whole) - set(kinds) == {"proof"}


def test_a_scene_that_does_not_ask_is_told_what_is_left_out(tmp_path: Path) -> None:
    plan = plan_scenes([load(tmp_path, HEAD)])
    reasons = {why for _, why in plan.left_out}
    assert {
        "the scene has no [[stability]]",
        "the scene has no [[largest_step]]",
        "the scene has no [[stability_map]]",
    } <= reasons
    asked = plan_scenes([load(tmp_path, HEAD + CASES)])
    assert "the scene has no [[stability]]" not in {why for _, why in asked.left_out}


def test_a_map_gives_its_parameter_the_values_itself(tmp_path: Path) -> None:
    without = HEAD.replace("parameters = { d = 2 }\n", "")
    assert load(tmp_path, without + MAP).stability_map
    with pytest.raises(InputError, match="parameter=d: has no value"):
        load(tmp_path, without + MAP + CASES)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("time = 10", "time = 10\nsteps = 5", "give one of the two"),
        ("time = 10", "", "give one of the two"),
        ("0.1, 0.3", "100", "makes 0 steps"),
        ("0.1, 0.3", "0", "must be greater than 0"),
        ("0.1, 0.3", "1e-15", "steps; allowed: 1 …"),
        ("0.1, 0.3", "", "must be a list of 1 or more"),
        ('name = "some"', "nam = 1", "unknown key"),
        ('name = "some"', 'schemes = ["lie2", "lie2"]', "stands twice"),
        ('name = "some"', 'schemes = ["lie2x"]', "is lie2 meant"),
    ],
)
def test_bad_cases_are_refused_in_one_line(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    assert old in CASES
    with pytest.raises(InputError, match=message) as info:
        load(tmp_path, HEAD + CASES.replace(old, new))
    assert "\n" not in str(info.value)


def largest(system: str, parameters: dict[str, Any], **section: Any) -> dict[str, Any]:
    """A scene that asks for one largest step."""
    scene = {"system": system, "parameters": parameters, "schemes": ["rk4"]}
    return scene | {"largest_step": [{"time": 1} | section]}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"energy_error": "0"}, "energy_error=0: must be greater than 0"),
        ({"initial_value": {"q": 1, "p": 0}}, "p=0: has 1 of 2 numbers"),
    ],
)
def test_a_bad_largest_step_in_two_degrees_is_refused(
    changes: dict[str, Any], message: str
) -> None:
    section = {"initial_value": {"q": [0, "0.1"], "p": [0, 0]}, **changes}
    with pytest.raises(InputError, match=message):
        scene_from(largest("henon-heiles", {}, **section), "mine")


def test_the_form_is_carried_in_up_to_four_degrees_of_freedom() -> None:
    start = {"q": ["0.1"] * 5, "p": [0] * 5}
    chain: Any = "fput", {"n": 5, "alpha": "1/4", "beta": 0}
    with pytest.raises(InputError, match="up to 4 degrees of freedom"):
        scene_from(largest(*chain, initial_value=start, symplectic_defect="0.1"), "mine")
    scene_from(largest(*chain, initial_value=start), "mine")


def test_a_start_of_another_length_is_refused_in_a_call_too() -> None:
    with pytest.raises(InputError, match=r"^q=0: has 1 of 2 numbers"):
        verify.stability("henon-heiles", "rk4", step_size="0.1", time=1, q=[0], p=[0, 0])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("from = 0.01", "from = 200", "from must be less than to"),
        ("from = 0.01", "from = 0", "must be greater than 0"),
        ("count = 5", "count = 1", "2 … 200"),
        ("count = 5", "count = true", "2 … 200"),
        ("count = 5", "number = 5", "allowed: from, to, count"),
        ('parameter = "d"', 'parameter = "e"', "H has no such; it has: d"),
        ("steps = 100", "steps = 0", "must be 1 or more"),
        ("steps = 100", "steps = 1000000", "must be 100000 or less"),
        ('schemes = ["lie4"]', 'schemes = ["lie4", 3]', "must be a text"),
    ],
)
def test_bad_maps_are_refused_in_one_line(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert old in MAP
    with pytest.raises(InputError, match=message) as info:
        load(tmp_path, HEAD + MAP.replace(old, new))
    assert "\n" not in str(info.value)


@pytest.mark.parametrize("suite", ["extreme", "stiff"])
def test_the_suites_are_scenes_that_ask_for_stability(suite: str) -> None:
    scenes = load_target(suite)[1]
    assert len(scenes) >= 5
    assert len({scene.name for scene in scenes}) == len(scenes)
    for scene in scenes:
        assert scene.stability
        assert all(isinstance(section, Stability) for section in scene.stability)
        assert scene.title
