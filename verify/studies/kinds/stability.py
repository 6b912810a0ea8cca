"""How stable the schemes are: runs judged, largest steps, maps of verdicts."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

from verify.arithmetic.exact import short
from verify.execution.plan import Plan
from verify.execution.study import Results, Section, Study, called, known_results, toml_section
from verify.execution.task import Task
from verify.scenes.frozen import PLAIN
from verify.scenes.results.stability import (
    LargestStepResult,
    OrbitMapResult,
    StabilityMapResult,
    StabilityResult,
)
from verify.scenes.scene import Scene
from verify.scenes.stability_sections import LargestStepOver, OrbitMap, StabilityMap
from verify.studies.stability.task import (
    LargestStepTask,
    OrbitMapTask,
    StabilityMapTask,
    StabilityTask,
)

Asked = TypeVar("Asked", LargestStepOver, StabilityMap, OrbitMap)


def need_stability(plan: Plan, scene: Scene) -> None:
    """Adds what the scene asks for of stability."""
    for run, judged in stability_tasks(scene):
        plan.need(judged, f"{run}: is it stable, and whose fault is it if not")
    for task, what in _tasks_over(scene):
        plan.need(task, f"{called(scene)}: {what}")


def stability_tasks(scene: Scene) -> Iterator[tuple[str, StabilityTask]]:
    """Each run with its name: scene, section, scheme, step size and which initial value."""
    given = scene.hamiltonian_fields() | {"t0": scene.begin} if scene.stability else {}
    for section in scene.stability:
        for scheme in section.schemes or scene.schemes:
            for k, at in enumerate(section.initial_values, start=1):
                for h in section.step_sizes:
                    parts = [scene.name or "scene", section.name, scheme, f"h={short(h)}"]
                    if len(section.initial_values) > 1:
                        parts.append(f"z0 no. {k}")
                    steps = section.steps_for(h)
                    task = StabilityTask(
                        **given, scheme=scheme, step_size=h, steps=steps, q=at.q, p=at.p
                    )
                    yield "/".join(filter(None, parts)), task


def _of_schemes(scene: Scene, sections: Sequence[Asked]) -> Iterator[tuple[Asked, dict[str, Any]]]:
    """Each section with each of its schemes, and what its task begins with."""
    given = scene.hamiltonian_fields() | {"t0": scene.begin} if sections else {}
    for section in sections:
        start = {"q": section.initial_value.q, "p": section.initial_value.p}
        for scheme in section.schemes or scene.schemes:
            yield section, {**given, "scheme": scheme, **start}


def _tasks_over(scene: Scene) -> Iterator[tuple[Task, str]]:
    """Those that look for largest steps, or over several runs, each with what it looks for."""
    for largest, begun in _of_schemes(scene, scene.largest_step):
        yield LargestStepTask(
            **begun, time=largest.time, energy_error=largest.energy_error,
            symplectic_defect=largest.symplectic_defect,
        ), "the largest step with bounded motion"  # fmt: skip
    for over, begun in _of_schemes(scene, scene.stability_map):
        yield StabilityMapTask(
            **begun, parameter=over.parameter, values=over.values, step_sizes=over.step_sizes,
            steps=over.steps,
        ), f"stability over step size and {over.parameter}"  # fmt: skip
    for starts, begun in _of_schemes(scene, scene.orbit_map):
        yield OrbitMapTask(
            **begun, axes=starts.axes, across=starts.across, upwards=starts.upwards,
            step_size=starts.step_size, steps=starts.count,
            beyond=starts.farthest(scene.exact_hamiltonian()),
        ), f"orbits over {' and '.join(starts.axes)}"  # fmt: skip


@dataclass(frozen=True)
class StabilityFindings:
    """All that was found for some scenes, by the keys of a `SceneResult`."""

    stability: tuple[StabilityResult, ...]
    largest_steps: tuple[LargestStepResult, ...]
    stability_maps: tuple[StabilityMapResult, ...]
    orbit_maps: tuple[OrbitMapResult, ...] = ()

    def as_json(self) -> dict[str, list[dict[str, Any]]]:
        """As a report's JSON has them, under `cases`, `largest_steps`, `maps` and `orbit_maps`."""
        return {
            "cases": [
                {"id": run.id, "verdict": run.verdict}
                | run.model_dump(mode="json", exclude={"id"}, context=PLAIN)
                for run in self.stability
            ],
            "largest_steps": [x.model_dump(mode="json", context=PLAIN) for x in self.largest_steps],
            "maps": [x.model_dump(mode="json") for x in self.stability_maps],
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
    over = [task for scene in scenes for task, _ in _tasks_over(scene)]
    return StabilityFindings(
        tuple(runs),
        tuple(known_results(LargestStepResult, over, results)),
        tuple(known_results(StabilityMapResult, over, results)),
        tuple(known_results(OrbitMapResult, over, results)),
    )


def _asked(scene: Scene) -> bool:
    """Also in the plane, where nobody asks it: nothing is then said of it."""
    return bool(scene.orbit_map) or scene.exact_hamiltonian().planar


_SECTIONS = (
    toml_section(8, "stability, and whose fault it is where there is none", "[[stability]]"),
    toml_section(9, "the largest stable step", "[[largest_step]]"),
    Section(13, "orbits over two initial values", "the scene has no [[orbit_map]]", _asked),
    toml_section(10, "the map of step size and stiffness", "[[stability_map]]"),
)
STUDY = Study(
    9,
    _SECTIONS,
    need=need_stability,
    found=lambda scene, results: dict(vars(findings_of([scene], results))),
)
