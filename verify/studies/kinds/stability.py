"""How stable the schemes are: runs judged, largest steps, maps of verdicts."""

from typing import Any

from verify.execution.study import Results, Section, Study
from verify.scenes.scene import Scene
from verify.studies.stability.findings import findings_of
from verify.studies.stability.plan import need_stability


def _found(scene: Scene, results: Results) -> dict[str, Any]:
    found = findings_of([scene], results)
    return {
        "stability": found.runs,
        "largest_steps": found.largest_steps,
        "stability_maps": found.maps,
    }


_SECTIONS = (
    Section(
        8,
        "stability, and whose fault it is where there is none",
        "the scene has no [[stability]]",
        lambda scene: scene.stability,
    ),
    Section(
        9,
        "the largest stable step",
        "the scene has no [[largest_step]]",
        lambda scene: scene.largest_step,
    ),
    Section(
        10,
        "the map of step size and stiffness",
        "the scene has no [[stability_map]]",
        lambda scene: scene.stability_map,
    ),
)
STUDY = Study(9, _SECTIONS, need=need_stability, found=_found)
