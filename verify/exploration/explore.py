"""Properties, or a user's claims, held against many drawn scenes.

The work is cut into tasks of a stretch of scenes each. What is found does not depend on how it is
cut, as scene k is made of the seed and k alone (see `verify.exploration.scenes`). Of every property
that fails the first scene by number is shrunk.
"""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from verify.claims.scenes import slug
from verify.errors import NOT_GIVEN, InputError
from verify.execution.execute import OnResult, Store, execute
from verify.execution.executors import ANYWHERE, Placement
from verify.execution.keeping import name_of
from verify.execution.plan import Plan
from verify.exploration.claims import claim_property
from verify.exploration.property import Property
from verify.exploration.property_checks import outcome, properties_of
from verify.exploration.sample import Sample
from verify.exploration.sample_space import SampleSpace, check_scenes
from verify.exploration.scenes import scenes_of
from verify.exploration.tasks import ExploreTask, ShrinkTask
from verify.files import write_atomically
from verify.scenes.results.exploration import (
    EarlierFailure,
    ExploreReport,
    ExploreResult,
    Failure,
    PropertySummary,
    ShrunkResult,
)
from verify.scenes.scene import Scene, load_scene

MOST_EXAMPLES = 10**12
_STRETCH = 50  # scenes of a task, at least
_MOST_TASKS = 1000  # so that a plan stays small however many scenes are drawn


@dataclass(frozen=True)
class Exploration:
    """What is asked for: so many scenes of a seed, held against properties and claims.

    `claims`: each as JSON, by `verify.exploration.claims`. Raises InputError for an unknown
    property, none at all, two of one name, fewer than one example, and what scenes cannot be drawn
    of.
    """

    seed: int
    examples: int
    properties: tuple[str, ...]
    claims: tuple[str, ...] = ()
    drawn: SampleSpace = field(default_factory=SampleSpace)

    def __post_init__(self) -> None:
        check_scenes(self.seed, self.examples, MOST_EXAMPLES)
        names = [each.name for each in self.looks]
        if not names:
            raise InputError("properties", NOT_GIVEN, "give one at least")
        for name, count in Counter(names).items():
            if count > 1:
                raise InputError("properties", name, f"{count} of them have this name")
        scenes_of(self.drawn)

    @property
    def looks(self) -> tuple[Property, ...]:
        """The properties and the claims, as properties."""
        return properties_of(self.properties, self.claims)

    @cached_property
    def plan(self) -> Plan:
        """The tasks, each of a stretch of scenes."""
        plan = Plan()
        size = max(_STRETCH, -(-self.examples // _MOST_TASKS))
        for first in range(0, self.examples, size):
            count = min(size, self.examples - first)
            task = ExploreTask(
                drawn=self.drawn,
                seed=self.seed,
                properties=self.properties,
                claims=self.claims,
                first=first,
                count=count,
            )
            plan.need(task, "a stretch of drawn scenes")
        return plan

    def shrinking(self, failures: Sequence[Failure]) -> Plan:
        """The tasks that shrink these failures."""
        plan = Plan()
        for failure in failures:
            claims = tuple(c for c in self.claims if claim_property(c).name == failure.property)
            task = ShrinkTask(
                drawn=self.drawn,
                seed=self.seed,
                properties=() if claims else (failure.property,),
                claims=claims,
                example=failure.example,
            )
            plan.need(task, "it failed")
        return plan


# -- the whole ------------------------------------------------------------------------------------


def explore(
    asked: Exploration,
    store: Store,
    *,
    where: Placement = ANYWHERE,
    done: OnResult | None = None,
    earlier: Sequence[tuple[str, Scene]] = (),
) -> ExploreReport:
    """Looks at all examples, and shrinks the first failure of each property.

    `earlier`: scenes found before, each with the name of the property that failed; they are looked
    at first. `done` hears of each result. What the store has of the tasks is not computed again.
    The report depends on what is asked alone, and not on where it is computed.
    """
    again = tuple(_again(asked, earlier))
    plan = asked.plan
    results = execute(plan, store, where=where, done=done)
    found = [r for r in map(results.get, plan.tasks) if isinstance(r, ExploreResult)]
    first: dict[str, Failure] = {}
    for result in found:
        for failure in result.first:
            first.setdefault(failure.property, failure)
    shrinking = asked.shrinking(list(first.values()))
    shrunk = execute(shrinking, store, where=where)
    return ExploreReport(
        seed=asked.seed,
        examples=asked.examples,
        properties=tuple(
            PropertySummary(
                name=each.name,
                sentence=each.sentence,
                looked_at=sum(r.looked_at[each.name] for r in found),
                failures=sum(r.failed[each.name] for r in found),
            )
            for each in asked.looks
        ),
        failures=tuple(r for r in map(shrunk.get, shrinking.tasks) if isinstance(r, ShrunkResult)),
        again=again,
    )


def _again(asked: Exploration, earlier: Sequence[tuple[str, Scene]]) -> Iterator[EarlierFailure]:
    for name, scene in earlier:
        for each in asked.looks:
            if slug(each.name) == name:
                wrong = outcome(each, Sample.of(scene))[1]
                yield EarlierFailure(file=f"{scene.name}.toml", property=each.name, message=wrong)


# -- the scenes that were found -------------------------------------------------------------------


_FOUND = re.compile(r"([A-Za-z0-9_-]+)\.[0-9a-f]{8}\.toml")  # what is written, and no other file


def save_failures(report: ExploreReport, folder: Path) -> list[Path]:
    """Writes each shrunk scene into the folder, as PROPERTY.XXXXXXXX.toml; returns the paths.

    X are digits of a hash of the scene's text: what is found twice is one file.
    """
    written = []
    for failure in report.failures:
        path = folder / f"{slug(failure.property)}.{name_of(failure.scene)[:8]}.toml"
        write_atomically(path, failure.scene)
        written.append(path)
    return written


def load_failures(folder: Path) -> list[tuple[str, Scene]]:
    """The scenes that earlier explorations wrote there, each with its property's name as the file
    has it. InputError for one that was changed into what is no scene, or has no [grid]."""
    found = []
    for path in sorted(folder.glob("*.toml")):
        if own := _FOUND.fullmatch(path.name):
            scene = load_scene(path)
            if scene.grid is None:
                raise InputError("scene", str(path), "has no [grid], which gives step and start")
            found.append((own[1], scene.model_copy(update={"name": path.stem})))
    return found
