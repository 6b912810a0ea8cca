"""A study: one question that a scene may ask, what it needs, and what is made of what was found."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from verify.execution.plan import Plan
from verify.scenes.frozen import Frozen
from verify.scenes.scene import Scene

Results = Mapping[str, Frozen]  # by the keys of tasks


@dataclass(frozen=True)
class Section:
    """What a scene may ask of a study; where it does not, a plan says so.

    `place`: of that line among those of all studies.
    """

    place: int
    what: str
    why_not: str
    asked: Callable[[Scene], object]


@dataclass(frozen=True)
class Study:
    """All that is asked of a study, a part of it at a time.

    `order`: among the studies, for their tasks. `need_of_scheme(plan, scene, scheme, preserves)`
    adds to the plan what one of the scene's schemes needs, where `preserves` says whether ΔJ ≡ 0 is
    proved; `need(plan, scene)` what the whole scene does. `found(scene, results)` is the study's
    part of a `SceneResult`, by its keys.
    """

    order: int
    sections: tuple[Section, ...] = ()
    need_of_scheme: Callable[[Plan, Scene, str, bool], None] | None = None
    need: Callable[[Plan, Scene], None] | None = None
    found: Callable[[Scene, Results], dict[str, Any]] | None = None


def called(scene: Scene) -> str:
    """The scene's name in the reasons of a plan."""
    return scene.name or scene.title or "scene"
