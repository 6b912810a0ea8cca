"""The catalogue's properties over drawn scenes: the same that `verify explore` looks at.

What each of them must catch is in tests/unit/exploration/properties/test_properties.py.
"""

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis.strategies import SearchStrategy

from tests.campaigns.drawn_in_degrees import KINDS, looked
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


@pytest.mark.left_to_ci
@pytest.mark.parametrize(("degrees", "timed"), KINDS)
def test_no_property_fails_of_a_sample_of_the_campaign_in_degrees(
    degrees: int, timed: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    failed = looked(degrees, timed, 5, seed=20)
    said = capsys.readouterr().out
    assert not failed, said
    assert f"5 scenes of {degrees} degrees of freedom" in said
    assert "results-read-back: of 5" in said
