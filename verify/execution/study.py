"""A study: one question that a scene may ask, what it needs, and what becomes of the results."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from operator import attrgetter
from typing import Any, TypeVar

from verify.execution.plan import Plan
from verify.execution.task import Task
from verify.scenes.frozen import Frozen
from verify.scenes.scene import Scene

Results = Mapping[str, Frozen]  # by the keys of tasks
Need = Callable[[Plan, Scene], None]  # adds to the plan what the scene asks for
Result = TypeVar("Result", bound=Frozen)


@dataclass(frozen=True)
class Section:
    """A question that a scene may ask of a study; where it does not, a plan says so.

    `place`: of that line among those of all studies.
    """

    place: int
    what: str
    why_not: str
    is_requested: Callable[[Scene], object]


def toml_section(place: int, what: str, header: str) -> Section:
    """Return the section for a table of the scene's file, with a header such as `[[flow]]`."""
    is_requested = attrgetter(header.strip("[]"))
    return Section(place, what, f"the scene has no {header}", is_requested)


@dataclass(frozen=True)
class Study:
    """The description of a study, a part of it at a time.

    `order`: among the studies, for their tasks. `need_of_scheme(plan, scene, scheme, preserves)`
    adds to the plan what one of the scene's schemes needs, where `preserves` says whether ΔJ ≡ 0 is
    proved; `need(plan, scene)` what the whole scene does. `results_for_scene(scene, results)` is
    the study's part of a `SceneResult`, by its keys.
    """

    order: int
    sections: tuple[Section, ...] = ()
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
    matches = (results.get(task.key) for task in tasks)
    return [result for result in matches if isinstance(result, model)]
