"""Plans of tasks, and the studies that scenes ask for: what a study needs, it adds to a plan.

A plan has each task once, with its reasons, and what is left out and why. A study is one question
that a scene may ask, what it needs, and what becomes of the results.

Tasks that name the same `ensemble` take the same steps from other initial values, or with other
step sizes and parameters. They go to a worker in groups, longest first, and in a group each has its
`turn`. They are computed in lockstep: where their runs meet in a kernel, the lanes of the vector
unit have one run each. The results are what each task gives by itself.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from itertools import islice
from operator import attrgetter
from typing import Any, TypeVar

from verify.execution.task import Task
from verify.scenes.frozen import Frozen
from verify.scenes.scene import Scene

_STEP_SECONDS = 4e-9
MOST_AT_ONCE = 24  # tasks under way: three sets of lanes, full even where runs have ended
_LEAST_IN_GROUP = 16  # two sets, so that lanes are full
_MOST_IN_GROUP = 64  # so that results come in, and every worker has some
Results = Mapping[str, Frozen]  # by the keys of tasks
Result = TypeVar("Result", bound=Frozen)
Group = dict[str, Task]


def keys_supplied_by(tasks: Iterable[Task]) -> set[str]:
    """Return the keys of the tasks whose results come with these."""
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
        """The approximate processor time of the tasks: by their costs, within a factor of four
        or so, on a machine on which a float64 step takes 4 ns."""
        supplied = keys_supplied_by(self.tasks.values())
        # Tasks whose results come with others' are not counted twice.
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

Need = Callable[[Plan, Scene], None]  # adds to the plan what the scene asks for


@dataclass(frozen=True)
class SceneQuestion:
    """A question that a scene may ask of a study; where it does not, a plan says so.

    `place`: of that line among those of all studies.
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
    """The description of a study, a part of it at a time.

    `order`: among the studies, for their tasks. `need_of_scheme(plan, scene, scheme, preserves)`
    adds to the plan what one of the scene's schemes needs, where `preserves` says whether ΔJ ≡ 0 is
    proved; `need(plan, scene)` what the whole scene does. `results_for_scene(scene, results)` is
    the study's part of a `SceneResult`, by its keys.
    """

    order: int
    sections: tuple[SceneQuestion, ...] = ()
    need_of_scheme: Callable[[Plan, Scene, str, bool], None] | None = None
    need: Need | None = None
    results_for_scene: Callable[[Scene, Results], dict[str, Any]] | None = None


def scene_name(scene: Scene) -> str:
    """Return the scene's name in the reasons of a plan."""
    return scene.name or scene.title or "scene"


def plan_of(scenes: Iterable[Scene], need: Need) -> Plan:
    """Plan the requests of the scenes that `need` covers; a task of several is done once."""
    plan = Plan()
    for scene in scenes:
        need(plan, scene)
    return plan


def results_of_tasks(model: type[Result], tasks: Iterable[Task], results: Results) -> list[Result]:
    """Return the results of these tasks, in their order; a task that was not done is left out."""
    available = (results.get(task.key) for task in tasks)
    return [result for result in available if isinstance(result, model)]


# -- what is computed together --------------------------------------------------------------------


def groups(tasks: Mapping[str, Task], workers: int) -> list[Group]:
    """Return the groups of tasks that are computed together, the costliest first."""
    by_ensemble: dict[str, Group] = {}
    for name in sorted(tasks, key=lambda name: -tasks[name].cost):
        by_ensemble.setdefault(tasks[name].ensemble or name, {})[name] = tasks[name]
    parts: list[Group] = []
    for group in by_ensemble.values():
        # Every worker gets a part, but no part is so small that lanes stay empty, and none so large
        # that results come in late.
        share = -(-len(group) // max(workers, 1))
        size = min(max(share, _LEAST_IN_GROUP), _MOST_IN_GROUP)
        names = iter(group)
        while part := sorted(islice(names, size), key=lambda name: tasks[name].turn):
            parts.append({name: tasks[name] for name in part})
    return sorted(parts, key=lambda part: -sum(task.cost for task in part.values()))
