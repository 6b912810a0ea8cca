"""`verify plan` has a line for every task that a scene may ask for."""

import pytest

from verify.commands.plan import _DESCRIBERS
from verify.scenes.scene import scene_from_toml
from verify.studies.tasks_of_scenes import plan_scenes

STARTS = "initial_values = [{ q = [0, 0.1], p = [0.4, 0] }]"
PASSES = f"""
system = "henon-heiles"
schemes = ["lie2"]
[[poincare]]
step_size = 0.1
steps = 50
{STARTS}
"""
LOOKS = """
hamiltonian = "p**2/2 - (1 + cos(2*pi*t))*cos(q)"
schemes = ["lie2"]
[[stroboscopic]]
period = 1
step_size = 0.05
periods = 20
initial_values = [{ q = 1, p = 0 }]
"""
JUDGED = """
system = "duffing"
parameters = { delta = 1 }
schemes = ["lie2"]
[[stability]]
step_sizes = [0.1]
steps = 50
initial_values = [{ q = 1, p = 0 }]
"""


@pytest.mark.parametrize(
    ("scene", "said"),
    [
        (JUDGED, "judge lie2, 50 steps of 0.1 from q = 1, p = 0"),
        (PASSES, "follow 1 orbits by lie2, 50 steps of 0.1, to where q1 passes 0"),
        (LOOKS, "follow 1 orbits by lie2, 20 times 20 steps of 0.05"),
    ],
)
def test_orbits_that_are_looked_at_have_a_line(scene: str, said: str) -> None:
    tasks = plan_scenes([scene_from_toml(scene, "mine")]).as_json()["tasks"]
    assert said in [_DESCRIBERS[task["kind"]](task) for task in tasks]
