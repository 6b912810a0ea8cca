"""Plans of tasks, and the studies that scenes request: each study adds the tasks that it needs.

A plan has each task once, with its reasons, and the parts that are left out, each with its reason.
A study answers one question that a scene may ask: it has the tasks and the use of their results.

Tasks with the same `ensemble` take the same steps from other initial values, or with other step
sizes and parameters. They go to a worker in groups, the costliest group first, and within a group
in the order of `turn`. They are computed in lockstep: when their runs are in a kernel at the same
time, each takes one lane of the vector unit. The results are the same as those of each task by
itself.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from itertools import islice
from operator import attrgetter
from typing import Any, TypeVar

from verify.execution.task import Task
from verify.scenes.frozen import Frozen
from verify.scenes.scene import Scene

_STEP_SECONDS = 4e-9  # of one float64 step
# Tasks of a group that are under way together: three sets of lanes, so that the lanes are full even
# when some runs have ended.
MOST_AT_ONCE = 24
# Groups have two sets of lanes at least. Larger ones than the second number would delay results,
# and leave workers without a group.
_MIN_GROUP_SIZE, _MAX_GROUP_SIZE = 16, 64
Results = Mapping[str, Frozen]  # by the keys of tasks
Result = TypeVar("Result", bound=Frozen)
Group = dict[str, Task]


def keys_supplied_by(tasks: Iterable[Task]) -> set[str]:
    """Return the keys of the tasks whose results come with those of these tasks."""
    return {supplied.key for task in tasks for supplied in task.gives}


@dataclass
class Plan:
    """Tasks in the order of their requests, each with every reason for it."""

    tasks: dict[str, Task] = field(default_factory=dict)
    reasons: dict[str, list[str]] = field(default_factory=dict)
    left_out: list[tuple[str, str]] = field(default_factory=list)

    def need(self, task: Task, reason: str) -> None:
        """Add the task, once, and the reason for it."""
        name = task.key
        self.tasks.setdefault(name, task)
        reasons = self.reasons.setdefault(name, [])
        if reason not in reasons:
            reasons.append(reason)

    def leave_out(self, what: str, why: str) -> None:
        """Note what is not computed, and why."""
        if (what, why) not in self.left_out:
            self.left_out.append((what, why))

    @property
    def seconds(self) -> float:
        """The approximate processor time of the tasks, on a machine on which a float64 step takes
        4 ns; it is right within a factor of about four."""
        supplied = keys_supplied_by(self.tasks.values())
        # Tasks whose results come with others cost nothing more.
        remaining = (task for name, task in self.tasks.items() if name not in supplied)
        costs = (task.cost for task in remaining if task.result_by_proof() is None)
        return _STEP_SECONDS * sum(costs)

    def as_json(self) -> dict[str, Any]:
        return {
            "seconds": f"{self.seconds:.2g}",
            "tasks": [
                {**task.model_dump(mode="json"), "reasons": self.reasons[name]}
                for name, task in self.tasks.items()
            ],
            "left_out": [{"what": what, "why": why} for what, why in self.left_out],
        }


# -- studies -------------------------------------------------------------------------------------

Need = Callable[[Plan, Scene], None]  # adds the tasks that the scene requests to the plan


@dataclass(frozen=True)
class SceneQuestion:
    """A question that a scene may ask of a study; a plan has a line for one that it does not ask.

    `place`: the position of this line among those of all studies.
    """

    place: int
    what: str
    why_not: str
    is_requested: Callable[[Scene], object]


def toml_section(place: int, what: str, header: str) -> SceneQuestion:
    """Return the section for a table of the scene's file, with a header such as `[[flow]]`."""
    is_requested = attrgetter(header.strip("[]"))
    return SceneQuestion(place, what, f"the scene has no {header}", is_requested)


@dataclass(frozen=True)
class Study:
    """The description of a study by the functions that make its parts.

    `order`: its position among the studies, for their tasks. `need_of_scheme(plan, scene, scheme,
    preserves)`: adds the tasks for one scheme of the scene; `preserves` is True if ΔJ ≡ 0 is
    proved. `need(plan, scene)`: adds the tasks for the whole scene. `results_for_scene(scene,
    results)`: returns the study's part of a `SceneResult`, by its keys. `takes_field`: it also
    takes scenes of equations without an H.
    """

    order: int
    sections: tuple[SceneQuestion, ...] = ()
    need_of_scheme: Callable[[Plan, Scene, str, bool], None] | None = None
    need: Need | None = None
    results_for_scene: Callable[[Scene, Results], dict[str, Any]] | None = None
    takes_field: bool = False


def scene_name(scene: Scene) -> str:
    """Return the scene's name in the reasons of a plan."""
    return scene.name or scene.title or "scene"


def plan_of(scenes: Iterable[Scene], need: Need) -> Plan:
    """Return the plan of the tasks that `need` adds for each scene; equal tasks stand once."""
    plan = Plan()
    for scene in scenes:
        need(plan, scene)
    return plan


def results_of_tasks(model: type[Result], tasks: Iterable[Task], results: Results) -> list[Result]:
    """Return the results of these tasks, in their order, without those that are missing."""
    available = (results.get(task.key) for task in tasks)
    return [result for result in available if isinstance(result, model)]


# -- groups of tasks that are computed together --------------------------------------------------


def groups(tasks: Mapping[str, Task], workers: int) -> list[Group]:
    """Return the groups of tasks that are computed together, the costliest first."""
    by_ensemble: dict[str, Group] = {}
    for name in sorted(tasks, key=lambda name: -tasks[name].cost):
        by_ensemble.setdefault(tasks[name].ensemble or name, {})[name] = tasks[name]
    parts: list[Group] = []
    for group in by_ensemble.values():
        share = -(-len(group) // max(workers, 1))
        size = min(max(share, _MIN_GROUP_SIZE), _MAX_GROUP_SIZE)
        names = iter(group)
        while part := sorted(islice(names, size), key=lambda name: tasks[name].turn):
            parts.append({name: tasks[name] for name in part})
    return sorted(parts, key=lambda part: -sum(task.cost for task in part.values()))
