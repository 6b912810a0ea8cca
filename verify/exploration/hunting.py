"""The hunt for the worst scenes for a measure, and their gallery for a report.

The scenes are divided into islands, each with its own seed, that are searched independently. The
worst scenes of all islands are merged, one for each shape of H, so that they are not variants of a
single scene. The gallery shows each with its orbit, and with the parts of Λ, the cumulative area
error: truncation, which exact arithmetic has too, and rounding.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property

from verify.arithmetic.exact import decimal, text
from verify.errors import InputError, unknown_name
from verify.execution.execute import OnResult, Store, execute
from verify.execution.executors import LOCAL_DEFAULT, Placement
from verify.execution.plan import Plan
from verify.exploration import island_search
from verify.exploration.measures import MEASURES, orbit
from verify.exploration.sample import Sample
from verify.exploration.sample_space import SampleSpace, check_scenes
from verify.exploration.tasks import HuntTask
from verify.scenes.results.exploration import Gallery, GalleryScene, HuntResult, Worst
from verify.scenes.results.separation import SeparationResult
from verify.scenes.results.separation_parts import PartsAt
from verify.scenes.scene import scene_text
from verify.studies.kinds.separation import SeparationTask

_MAX_STEPS = 10**6
_SCENES_OF_ISLAND = 200  # at most; an island is one task
# A run of the gallery is longer than that of the hunt by this factor, up to this number of steps.
_LONGER_FACTOR, _MAX_GALLERY_STEPS = 100, 10_000
_POINT_DIGITS = 6  # of a point of an orbit
_PARTS_DIGITS = 8  # of the parts of Λ


@dataclass(frozen=True)
class Hunt:
    """A request to hunt among `examples` scenes of `steps` steps each.

    Raises InputError for an unknown measure, fewer than one example, a seed below 0, and a space
    from which no scenes can be drawn.
    """

    measure: str
    seed: int
    examples: int
    steps: int = 100
    drawn: SampleSpace = field(default_factory=SampleSpace)

    def __post_init__(self) -> None:
        if self.measure not in MEASURES:
            raise unknown_name("maximise", self.measure, MEASURES)
        if self.drawn.degrees > 1 and not MEASURES[self.measure].several:
            names = ", ".join(name for name, x in MEASURES.items() if x.several)
            problem = f"is of one degree of freedom; allowed in more: {names}"
            raise InputError("maximise", self.measure, problem)
        check_scenes(self.seed, self.examples, island_search.MOST_EXAMPLES)
        if not 2 <= self.steps <= _MAX_STEPS:
            raise InputError("steps", self.steps, f"must be 2 … {_MAX_STEPS}")
        # This raises the errors of a space from which nothing can be drawn, before any plan.
        island_search.hunted_scenes(self.drawn, self.steps)

    @cached_property
    def plan(self) -> Plan:
        """The tasks, each for an island of at most 200 scenes."""
        plan = Plan()
        for island, first in enumerate(range(0, self.examples, _SCENES_OF_ISLAND)):
            count = min(_SCENES_OF_ISLAND, self.examples - first)
            task = HuntTask.from_object(self, island=island, count=count)
            plan.need(task, f"an island of the hunt for {self.measure}")
        return plan


def hunt(
    request: Hunt, store: Store, *, where: Placement = LOCAL_DEFAULT, done: OnResult | None = None
) -> HuntResult:
    """Search all islands and return at most six worst scenes that differ from each other.

    Their values are decimal logarithms (see `verify.exploration.measures`), confirmed with twice
    the digits. Islands whose result is in the store are not searched again.
    """
    plan = request.plan
    results = execute(plan, store, where=where, done=done)
    islands = [r for r in map(results.get, plan.tasks) if isinstance(r, HuntResult)]
    # Islands may find the same scene: the best of each shape is taken over all of them.
    together = sorted(
        (worst for island in islands for worst in island.worst), key=island_search.sorting_key
    )
    examples = sum(island.examples for island in islands)
    return HuntResult(
        worst=tuple(
            island_search.select_different(island_search.select_by_shape(together))[
                : island_search.SCENES_IN_RESULT
            ]
        ),
        examples=examples,
    )


# -- the gallery ----------------------------------------------------------------------------------


def gallery(
    request: Hunt,
    hunted: HuntResult,
    store: Store,
    *,
    where: Placement = LOCAL_DEFAULT,
    done: OnResult | None = None,
) -> Gallery:
    """Build the gallery of the worst scenes, with runs longer than those of the hunt.

    If such a run does not finish, the run of the hunt is shown instead.
    """
    longer = min(request.steps * _LONGER_FACTOR, max(request.steps, _MAX_GALLERY_STEPS))

    def separate_all(scenes: Sequence[Worst], steps: int) -> list[SeparationResult]:
        plan, tasks = Plan(), [_task(scene, steps) for scene in scenes]
        for task in tasks:
            plan.need(task, "the gallery of the worst scenes")
        results = execute(plan, store, where=where, done=done)
        of_tasks = [results[task.key] for task in tasks]
        return [result for result in of_tasks if isinstance(result, SeparationResult)]

    runs = separate_all(hunted.worst, longer)
    # A longer run that leaves the range is replaced by one as long as the hunt's.
    unfinished = [w for w, run in zip(hunted.worst, runs, strict=True) if run.status != "finished"]
    short = iter(separate_all(unfinished, request.steps))
    return Gallery.from_object(
        request,
        sentence=MEASURES[request.measure].sentence,
        examples=hunted.examples,
        reach=text(island_search.REACH),
        step_sizes=(text(island_search.STEP_SIZES[0]), text(island_search.STEP_SIZES[1])),
        coefficients=(str(island_search.COEFFICIENTS[0]), str(island_search.COEFFICIENTS[1])),
        scenes=tuple(
            _gallery_scene(worst, run if run.status == "finished" else next(short), run)
            for worst, run in zip(hunted.worst, runs, strict=True)
        ),
    )


def _task(worst: Worst, steps: int) -> SeparationTask:
    sample = Sample.from_scene(island_search.scene_of(worst))
    return SeparationTask(
        **sample.scene.hamiltonian_fields(),
        scheme=sample.scheme.name,
        **sample.run_arguments | {"steps": steps},
        digits=_PARTS_DIGITS,
    )


def _gallery_scene(worst: Worst, run: SeparationResult, longer: SeparationResult) -> GalleryScene:
    points = orbit(Sample.from_scene(island_search.scene_of(worst)))
    lost = find_meaningless_span(run.plain.series if run.plain else ())
    return GalleryScene(
        value=worst.value,
        scene=_text_with_separation(worst),
        orbit=tuple((decimal(q, _POINT_DIGITS), decimal(p, _POINT_DIGITS)) for q, p in points),
        separation=run,
        longer=longer if longer is not run else None,
        meaningless_after=lost.first,
        meaningful_from=lost.over,
    )


def _text_with_separation(worst: Worst) -> str:
    """Return the text of the scene, with the request to separate Λ, as in the gallery."""
    scene = island_search.scene_of(worst)
    assert scene.grid is not None  # noqa: S101 - as drawn
    grid = scene.grid.model_copy(update={"separate": True})
    return scene_text(scene.model_copy(update={"grid": grid}))


@dataclass(frozen=True)
class MeaninglessSpan:
    """The steps between which Λ is meaningless; None if there is no such checkpoint.

    `first`: the first checkpoint, in steps, at which no digit of Λ is right. `over`: the checkpoint
    from which on some digits are right again up to the end of the run.
    """

    first: int | None
    over: int | None


def find_meaningless_span(series: Sequence[PartsAt]) -> MeaninglessSpan:
    """Return the span of checkpoints at which max |rounding| so far ≥ max |truncation| so far.

    `series`: the parts of Λ at checkpoints of one run, in the order of steps. The maxima up to each
    checkpoint are compared, since Λ itself may pass through 0. A part that is exactly 0, or has no
    known digit, is "0"; if the rounding part is "0" so far, the checkpoint does not count.
    """
    lost = [
        checkpoint.steps
        for checkpoint, is_below in zip(series, _rounding_is_smaller(series), strict=True)
        if not is_below
    ]
    if not lost:
        return MeaninglessSpan(None, None)
    later = (checkpoint.steps for checkpoint in series if checkpoint.steps > lost[-1])
    return MeaninglessSpan(lost[0], next(later, None))


def _rounding_is_smaller(series: Sequence[PartsAt]) -> Iterator[bool]:
    rounding = truncation = Fraction(0)
    for checkpoint in series:
        rounding = max(rounding, abs(Fraction(checkpoint.total)))
        truncation = max(truncation, abs(Fraction(checkpoint.truncation)))
        yield rounding < truncation or not rounding
