"""The data of a scene are the same, be the results computed now or kept from before."""

import pytest

from tests.helpers.constructed.reference import POLES
from verify.execution.execute import Store, execute
from verify.execution.executors import THIS_PROCESS
from verify.reference.make.data_folder import data_of
from verify.reference.make.scene_plan import plan_references
from verify.scenes.scene import scene_from_toml


@pytest.mark.parametrize("name", POLES)
def test_results_that_were_kept_make_the_same_data(name: str) -> None:
    """Also where a row of the flow has no numbers, and could be of either kind."""
    scene = scene_from_toml(POLES[name].replace("flow = false", ""), "pole")
    results = execute(plan_references([scene]), Store(None), where=THIS_PROCESS)
    kept = {
        k: type(x).model_validate_json(x.model_dump_json(by_alias=True)) for k, x in results.items()
    }
    data = data_of(scene, results)
    assert "not followed" in {row.status for row in data.flow[0].rows}
    assert data_of(scene, kept) == data
