"""The stability of the schemes: verdicts on runs, largest steps, maps of verdicts."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Literal, TypeVar

from verify.arithmetic import AUTO, step_cost
from verify.arithmetic.exact import short
from verify.execution.keeper import Keeper
from verify.execution.plan import (
    Plan,
    Results,
    SceneQuestion,
    Study,
    results_of_tasks,
    scene_name,
    toml_section,
)
from verify.execution.task import StartTask, Task
from verify.hamiltonians.run_domain import point_of
from verify.scenes.frozen import PLAIN
from verify.scenes.results.stability import (
    LargestStepResult,
    OrbitMapResult,
    StabilityMapResult,
    StabilityResult,
)
from verify.scenes.scene import Scene
from verify.scenes.stability_sections import LargestStepOver, OrbitMap, StabilityMap
from verify.scenes.values import ExactNumber, StepSize

# Costs are in float64 steps, and estimates.
_RUN_COST = 40_000_000  # a verdict on one run, however short
_CELL_COST = _RUN_COST // 8  # a cell of a map: one short run judges most of them
_MOTION_COST = 1_000_000  # a unit of time of the exact motion, n degrees of freedom, ω = 1
_COST_OF_CELL_STEP = 4  # a step of a cell's orbit, with its neighbour's step and those with W
AnySection = TypeVar("AnySection", LargestStepOver, StabilityMap, OrbitMap)


class _FromATime(StartTask):
    """A task from one initial value, at a time t0 if H depends on it."""

    t0: ExactNumber | None = None
    """None if H does not depend on time."""


class StabilityTask(_FromATime):
    """Judge one run: is it stable, drifting or unstable, and what is to blame?"""

    result = StabilityResult
    imports = ("verify.studies.stability.verdict_results", "verify.studies.stability.trail")
    kind: Literal["stability"] = "stability"
    step_size: StepSize
    steps: int

    @property
    def cost(self) -> int:
        """About the number of float64 steps that it is worth."""
        return _RUN_COST + self.steps * step_cost(AUTO)

    def compute(self, keeper: Keeper) -> StabilityResult:
        """Return the verdict on the run."""
        from verify.studies.stability.trail import StabilityRun
        from verify.studies.stability.verdict_results import run_result

        hamiltonian, t0 = self.exact_hamiltonian(), self.t0 or Fraction(0)
        state = tuple(point_of(hamiltonian, self.q, self.p).values())
        return run_result(
            StabilityRun(hamiltonian, self.scheme, self.step_size, state, self.steps, t0)
        )


class LargestStepTask(_FromATime):
    """The largest step size with bounded motion until `time`."""

    result = LargestStepResult
    imports = ("verify.studies.stability.verdict_results",)
    price = 3 * _RUN_COST
    kind: Literal["largest_step"] = "largest_step"
    time: ExactNumber
    energy_error: ExactNumber | None = None
    symplectic_defect: ExactNumber | None = None

    def compute(self, keeper: Keeper) -> LargestStepResult:
        """Return the largest step size, with the smallest one that was too large."""
        from verify.studies.stability.verdict_results import largest_step

        return largest_step(self.exact_hamiltonian(), **self.other_fields())


class StabilityMapTask(_FromATime):
    """Verdicts over a parameter's values and step sizes."""

    result = StabilityMapResult
    imports = ("verify.studies.stability.verdict_results",)
    kind: Literal["stability_map"] = "stability_map"
    parameter: str
    values: tuple[ExactNumber, ...]
    step_sizes: tuple[StepSize, ...]
    steps: int

    @property
    def cost(self) -> int:
        """About the number of float64 steps that it is worth."""
        cells = _CELL_COST * len(self.values) * len(self.step_sizes)
        if isinstance(self.q, Fraction):
            return cells
        motion = int(_MOTION_COST * self.steps * max(self.step_sizes))
        return cells + motion * len(self.values)

    def compute(self, keeper: Keeper) -> StabilityMapResult:
        """Return the verdict on the run of each value and step size."""
        from verify.studies.stability.verdict_results import stability_map

        return stability_map(self.exact_hamiltonian(), **self.other_fields())


class OrbitMapTask(_FromATime):
    """Classify orbits over two of their initial values."""

    result = OrbitMapResult
    imports = ("verify.studies.stability.map_of_orbits",)
    kind: Literal["orbit_map"] = "orbit_map"
    axes: tuple[str, str]
    across: tuple[ExactNumber, ...]
    upwards: tuple[ExactNumber, ...]
    step_size: StepSize
    steps: int
    beyond: ExactNumber

    @property
    def cost(self) -> int:
        """About the number of float64 steps that it is worth."""
        cells = len(self.across) * len(self.upwards)
        return _RUN_COST + cells * self.steps * _COST_OF_CELL_STEP

    def compute(self, keeper: Keeper) -> OrbitMapResult:
        """Return the kind of each orbit."""
        from verify.studies.stability.map_of_orbits import orbit_map

        return orbit_map(self.exact_hamiltonian(), **self.other_fields())


def need_stability(plan: Plan, scene: Scene) -> None:
    """Add the scene's tasks of stability to the plan."""
    for run, stability_task in stability_tasks(scene):
        plan.need(stability_task, f"{run}: is it stable, and whose fault is it if not")
    for task, description in _tasks_over(scene):
        plan.need(task, f"{scene_name(scene)}: {description}")


def stability_tasks(scene: Scene) -> Iterator[tuple[str, StabilityTask]]:
    """Yield each run with its name: scene, section, scheme, step size and initial value."""
    common = scene.hamiltonian_fields() | {"t0": scene.begin} if scene.stability else {}
    for section in scene.stability:
        for scheme in section.schemes or scene.schemes:
            for k, initial_value in enumerate(section.initial_values, start=1):
                for h in section.step_sizes:
                    parts = [scene.name or "scene", section.name, scheme, f"h={short(h)}"]
                    # A run's name is its id in results: a single initial value is not numbered.
                    if len(section.initial_values) > 1:
                        parts.append(f"z0 no. {k}")
                    steps = section.steps_for(h)
                    task = StabilityTask(
                        **common, **dict(initial_value), scheme=scheme, step_size=h, steps=steps
                    )
                    yield "/".join(filter(None, parts)), task


def _pair_with_schemes(
    scene: Scene, sections: Sequence[AnySection]
) -> Iterator[tuple[AnySection, dict[str, Any]]]:
    """Yield each section with each of its schemes, and the first fields of its task."""
    common = scene.hamiltonian_fields() | {"t0": scene.begin} if sections else {}
    for section in sections:
        start = {"q": section.initial_value.q, "p": section.initial_value.p}
        for scheme in section.schemes or scene.schemes:
            yield section, {**common, "scheme": scheme, **start}


def _tasks_over(scene: Scene) -> Iterator[tuple[Task, str]]:
    """Yield the tasks of largest steps and of several runs, each with its description."""
    for largest, common in _pair_with_schemes(scene, scene.largest_step):
        yield LargestStepTask.from_object(largest, **common), "the largest step with bounded motion"
    for over, common in _pair_with_schemes(scene, scene.stability_map):
        task = StabilityMapTask.from_object(over, **common)
        yield task, f"stability over step size and {over.parameter}"
    for starts, common in _pair_with_schemes(scene, scene.orbit_map):
        beyond = starts.farthest(scene.exact_hamiltonian())
        map_task = OrbitMapTask.from_object(starts, **common, steps=starts.count, beyond=beyond)
        yield map_task, f"orbits over {' and '.join(starts.axes)}"


@dataclass(frozen=True)
class StabilityFindings:
    """The results of stability for some scenes, by the keys of a `SceneResult`."""

    stability: tuple[StabilityResult, ...]
    largest_steps: tuple[LargestStepResult, ...]
    stability_maps: tuple[StabilityMapResult, ...]
    orbit_maps: tuple[OrbitMapResult, ...] = ()

    def as_json(self) -> dict[str, list[dict[str, Any]]]:
        """Return a report's JSON, under `cases`, `largest_steps`, `maps` and `orbit_maps`."""
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
    """Return the findings of all scenes; tasks without a result are left out."""
    named_tasks = ((name, task) for scene in scenes for name, task in stability_tasks(scene))
    runs = (
        run.model_copy(update={"id": name})
        for name, task in named_tasks
        for run in results_of_tasks(StabilityResult, [task], results)
    )
    over = [task for scene in scenes for task, _ in _tasks_over(scene)]
    return StabilityFindings(
        tuple(runs),
        tuple(results_of_tasks(LargestStepResult, over, results)),
        tuple(results_of_tasks(StabilityMapResult, over, results)),
        tuple(results_of_tasks(OrbitMapResult, over, results)),
    )


def _needs_map_section(scene: Scene) -> bool:
    """Return True if the scene has an orbit map, or a plane H, which needs none."""
    return bool(scene.orbit_map) or scene.exact_hamiltonian().planar


_SECTIONS = (
    toml_section(8, "stability, and whose fault it is where there is none", "[[stability]]"),
    toml_section(9, "the largest stable step", "[[largest_step]]"),
    SceneQuestion(
        13, "orbits over two initial values", "the scene has no [[orbit_map]]", _needs_map_section
    ),
    toml_section(10, "the map of step size and stiffness", "[[stability_map]]"),
)
STUDY = Study(
    9,
    _SECTIONS,
    need=need_stability,
    results_for_scene=lambda scene, results: dict(vars(findings_of([scene], results))),
)
