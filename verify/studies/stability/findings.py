"""What was found of a scene's stability, in the order in which the scene asks for it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from verify.execution.study import Results, known_results
from verify.scenes.frozen import PLAIN
from verify.scenes.results.stability import (
    LargestStepResult,
    OrbitMapResult,
    StabilityMapResult,
    StabilityResult,
)
from verify.scenes.scene import Scene
from verify.studies.stability.plan import (
    largest_step_tasks,
    orbit_map_tasks,
    stability_map_tasks,
    stability_tasks,
)


@dataclass(frozen=True)
class StabilityFindings:
    """All that was found for some scenes."""

    runs: tuple[StabilityResult, ...]
    largest_steps: tuple[LargestStepResult, ...]
    maps: tuple[StabilityMapResult, ...]
    orbit_maps: tuple[OrbitMapResult, ...] = ()

    def as_json(self) -> dict[str, list[dict[str, Any]]]:
        """As a report's JSON has them, under `cases`, `largest_steps`, `maps` and `orbit_maps`."""
        return {
            "cases": [
                {"id": run.id, "verdict": run.verdict}
                | run.model_dump(mode="json", exclude={"id"}, context=PLAIN)
                for run in self.runs
            ],
            "largest_steps": [x.model_dump(mode="json", context=PLAIN) for x in self.largest_steps],
            "maps": [x.model_dump(mode="json") for x in self.maps],
            "orbit_maps": [x.model_dump(mode="json") for x in self.orbit_maps],
        }


def findings_of(scenes: Sequence[Scene], results: Results) -> StabilityFindings:
    """Those of all scenes; what has no result is left out."""
    named = ((name, task) for scene in scenes for name, task in stability_tasks(scene))
    runs = (
        run.model_copy(update={"id": name})
        for name, task in named
        for run in known_results(StabilityResult, [task], results)
    )
    steps = (task for scene in scenes for task in largest_step_tasks(scene))
    maps = (task for scene in scenes for task in stability_map_tasks(scene))
    orbits = (task for scene in scenes for task in orbit_map_tasks(scene))
    return StabilityFindings(
        tuple(runs),
        tuple(known_results(LargestStepResult, steps, results)),
        tuple(known_results(StabilityMapResult, maps, results)),
        tuple(known_results(OrbitMapResult, orbits, results)),
    )
