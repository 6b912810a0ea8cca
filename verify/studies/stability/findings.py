"""What was found of a scene's stability, in the order in which the scene asks for it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from verify.scenes.frozen import PLAIN, Frozen
from verify.scenes.results.stability import LargestStepResult, StabilityMapResult, StabilityResult
from verify.scenes.scene import Scene
from verify.studies.stability.plan import largest_step_tasks, stability_map_tasks, stability_tasks


@dataclass(frozen=True)
class StabilityFindings:
    """All that was found for some scenes."""

    runs: tuple[StabilityResult, ...]
    largest_steps: tuple[LargestStepResult, ...]
    maps: tuple[StabilityMapResult, ...]

    def as_json(self) -> dict[str, list[dict[str, Any]]]:
        """As a report's JSON has them, under `cases`, `largest_steps` and `maps`."""
        return {
            "cases": [
                {"id": run.id, "verdict": run.verdict}
                | run.model_dump(mode="json", exclude={"id"}, context=PLAIN)
                for run in self.runs
            ],
            "largest_steps": [x.model_dump(mode="json", context=PLAIN) for x in self.largest_steps],
            "maps": [x.model_dump(mode="json") for x in self.maps],
        }


def findings_of(scenes: Sequence[Scene], results: Mapping[str, Frozen]) -> StabilityFindings:
    """Those of all scenes; `results` by the keys of their tasks. What has no result is left out."""
    return StabilityFindings(
        tuple(run for scene in scenes for run in run_verdicts(scene, results)),
        tuple(step for scene in scenes for step in largest_steps(scene, results)),
        tuple(over for scene in scenes for over in stability_maps(scene, results)),
    )


def run_verdicts(scene: Scene, results: Mapping[str, Frozen]) -> tuple[StabilityResult, ...]:
    """The scene's runs, each with its name."""
    found = []
    for name, task in stability_tasks(scene):
        result = results.get(task.key)
        if isinstance(result, StabilityResult):
            found.append(result.model_copy(update={"id": name}))
    return tuple(found)


def largest_steps(scene: Scene, results: Mapping[str, Frozen]) -> tuple[LargestStepResult, ...]:
    """The largest stable steps that were found for the scene."""
    found = (results.get(task.key) for task in largest_step_tasks(scene))
    return tuple(r for r in found if isinstance(r, LargestStepResult))


def stability_maps(scene: Scene, results: Mapping[str, Frozen]) -> tuple[StabilityMapResult, ...]:
    """The maps of stability over step sizes and starts that were found for the scene."""
    found = (results.get(task.key) for task in stability_map_tasks(scene))
    return tuple(r for r in found if isinstance(r, StabilityMapResult))
