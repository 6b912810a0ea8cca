"""How stable the schemes are: runs judged, largest steps, maps of verdicts."""

from typing import Any

from verify.execution.study import Results, Section, Study, toml_section
from verify.scenes.scene import Scene
from verify.studies.stability.plan import findings_of, need_stability


def _found(scene: Scene, results: Results) -> dict[str, Any]:
    found = findings_of([scene], results)
    return {
        "stability": found.runs,
        "largest_steps": found.largest_steps,
        "stability_maps": found.maps,
        "orbit_maps": found.orbit_maps,
    }


def _asked(scene: Scene) -> bool:
    """Also in the plane, where nobody asks it: nothing is then said of it."""
    return bool(scene.orbit_map) or scene.exact_hamiltonian().planar


_SECTIONS = (
    toml_section(8, "stability, and whose fault it is where there is none", "[[stability]]"),
    toml_section(9, "the largest stable step", "[[largest_step]]"),
    Section(13, "orbits over two initial values", "the scene has no [[orbit_map]]", _asked),
    toml_section(10, "the map of step size and stiffness", "[[stability_map]]"),
)
STUDY = Study(9, _SECTIONS, need=need_stability, found=_found)
