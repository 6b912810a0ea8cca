"""The catalogue's properties over drawn scenes: the same that `verify explore` looks at.

What each of them must catch is in tests/unit/exploration/properties/test_properties.py.
"""

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis.strategies import SearchStrategy

from tests.examples import drawn
from verify import strategies
from verify.exploration import properties
from verify.exploration.sample import Sample
from verify.scenes.scene import Scene

SCENES = strategies.scenes(steps=(1, 8))
IN_TIME = strategies.scenes(steps=(1, 8), time_dependent=True)


@pytest.mark.sample(15)
@pytest.mark.parametrize("scenes", [SCENES, IN_TIME], ids=["still", "in time"])
@pytest.mark.parametrize("name", properties.names())
def test_a_property_holds_of_drawn_scenes(name: str, scenes: SearchStrategy[Scene]) -> None:
    asked = properties.get(name)

    @settings(drawn(12), suppress_health_check=[HealthCheck.too_slow])
    @given(scenes)
    def holds(scene: Scene) -> None:
        asked.holds(Sample.from_scene(scene))

    holds()
