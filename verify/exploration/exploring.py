"""Properties, or a user's claims, tested on many drawn scenes.

The work is divided into tasks of consecutive scenes. The result does not depend on the division, as
scene k depends on the seed and k alone (see `verify.exploration.scenes_of_seed`). For every
property that fails, the failing scene with the least number is shrunk.
"""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from verify.claims.claim_scenes import slug
from verify.errors import NOT_GIVEN, InputError
from verify.execution.execute import OnResult, Store, execute
from verify.execution.executors import LOCAL_DEFAULT, Placement
from verify.execution.keeper import name_of
from verify.execution.plan import Plan
from verify.exploration.claim_properties import claim_property
from verify.exploration.property import Property
from verify.exploration.sample import Sample
from verify.exploration.sample_space import SampleSpace, check_scenes
from verify.exploration.scenes_of_seed import check_sample, properties_of, scenes_of
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
_MIN_SCENES_OF_TASK = 50
_MAX_TASKS = 1000  # the plan stays small, whatever the number of scenes is


@dataclass(frozen=True)
class Exploration:
    """A request to test properties and claims on `examples` scenes of a seed.

    `claims`: each as JSON, by `verify.exploration.claim_properties`. Raises InputError for an
    unknown property, no property at all, two with one name, fewer than one example, and a space
    from which no scenes can be drawn.
    """

    seed: int
    examples: int
    properties: tuple[str, ...]
    claims: tuple[str, ...] = ()
    drawn: SampleSpace = field(default_factory=SampleSpace)

    def __post_init__(self) -> None:
        check_scenes(self.seed, self.examples, MOST_EXAMPLES)
        names = [look.name for look in self.all_properties]
        if not names:
            raise InputError("properties", NOT_GIVEN, "give one at least")
        for name, count in Counter(names).items():
            if count > 1:
                raise InputError("properties", name, f"{count} of them have this name")
        scenes_of(self.drawn)

    @property
    def all_properties(self) -> tuple[Property, ...]:
        """The properties and the claims, as properties."""
        return properties_of(self.properties, self.claims)

    @cached_property
    def plan(self) -> Plan:
        """The tasks, each for a range of consecutive scenes."""
        plan = Plan()
        size = max(_MIN_SCENES_OF_TASK, -(-self.examples // _MAX_TASKS))
        for first in range(0, self.examples, size):
            count = min(size, self.examples - first)
            task = ExploreTask.from_object(self, first=first, count=count)
            plan.need(task, "a stretch of drawn scenes")
        return plan

    def shrinking(self, failures: Sequence[Failure]) -> Plan:
        """Return the plan of the tasks that shrink these failures."""
        plan = Plan()
        for failure in failures:
            # A failure has the name of its property alone, by which the claim is found.
            claims = tuple(c for c in self.claims if claim_property(c).name == failure.property)
            properties = () if claims else (failure.property,)
            task = ShrinkTask.from_object(
                self, properties=properties, claims=claims, example=failure.example
            )
            plan.need(task, "it failed")
        return plan


# -- the exploration ------------------------------------------------------------------------------


def explore(
    exploration: Exploration,
    store: Store,
    *,
    where: Placement = LOCAL_DEFAULT,
    done: OnResult | None = None,
    earlier: Sequence[tuple[str, Scene]] = (),
) -> ExploreReport:
    """Test all examples, and shrink the first failure of each property.

    `earlier`: scenes of earlier failures, each with the name of the property that failed; they are
    tested first. `done` is called with each result. Results in the store are not computed again.
    The report depends on the request alone, and not on where it is computed.
    """
    earlier_failures = tuple(_check_earlier(exploration, earlier))
    plan = exploration.plan
    results = execute(plan, store, where=where, done=done)
    # In the order of the plan, the first failure of a property is that with the least number.
    explore_results = [r for r in map(results.get, plan.tasks) if isinstance(r, ExploreResult)]
    first: dict[str, Failure] = {}
    for result in explore_results:
        for failure in result.first:
            first.setdefault(failure.property, failure)
    shrinking = exploration.shrinking(list(first.values()))
    shrunk = execute(shrinking, store, where=where)
    return ExploreReport.from_object(
        exploration,
        properties=tuple(
            PropertySummary.from_object(
                each,
                looked_at=sum(r.looked_at[each.name] for r in explore_results),
                failures=sum(r.failed[each.name] for r in explore_results),
            )
            for each in exploration.all_properties
        ),
        failures=tuple(r for r in map(shrunk.get, shrinking.tasks) if isinstance(r, ShrunkResult)),
        again=earlier_failures,
    )


def _check_earlier(
    exploration: Exploration, earlier: Sequence[tuple[str, Scene]]
) -> Iterator[EarlierFailure]:
    for name, scene in earlier:
        for look in exploration.all_properties:
            if slug(look.name) == name:
                message = check_sample(look, Sample.from_scene(scene)).message
                yield EarlierFailure(file=f"{scene.name}.toml", property=look.name, message=message)


# -- the scenes of failures -------------------------------------------------------------------


_FAILURE_FILE = re.compile(r"([A-Za-z0-9_-]+)\.[0-9a-f]{8}\.toml")  # a file of `save_failures`


def save_failures(report: ExploreReport, folder: Path) -> list[Path]:
    """Write each shrunk scene into the folder, as PROPERTY.XXXXXXXX.toml; return the paths.

    XXXXXXXX is the beginning of a hash of the scene's text, so that equal scenes share one file.
    """
    paths = []
    for failure in report.failures:
        path = folder / f"{slug(failure.property)}.{name_of(failure.scene)[:8]}.toml"
        write_atomically(path, failure.scene)
        paths.append(path)
    return paths


def load_failures(folder: Path) -> list[tuple[str, Scene]]:
    """Read the scenes of earlier explorations, each with its property's name in the file's name.

    Raises InputError for a file that is no longer a scene, or has no [grid].
    """
    failures = []
    for path in sorted(folder.glob("*.toml")):
        if match := _FAILURE_FILE.fullmatch(path.name):
            scene = load_scene(path)
            if scene.grid is None:
                raise InputError("scene", str(path), "has no [grid], which gives step and start")
            failures.append((match[1], scene.model_copy(update={"name": path.stem})))
    return failures
