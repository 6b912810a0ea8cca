"""The worst scenes of a hunt for a report: each with its orbit, and Λ split into its parts."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from verify.arithmetic.exact import decimal, text
from verify.execution.execute import OnResult, Store, execute
from verify.execution.executors import ANYWHERE, Placement
from verify.execution.plan import Plan
from verify.exploration.different_scenes import scene_of
from verify.exploration.hunting import Hunt
from verify.exploration.island_search import COEFFICIENTS, REACH, STEP_SIZES
from verify.exploration.measures import MEASURES, orbit
from verify.exploration.sample import Sample
from verify.scenes.results.exploration import Gallery, GalleryScene, HuntResult, Worst
from verify.scenes.results.separation import SeparationResult
from verify.scenes.results.separation_parts import PartsAt
from verify.scenes.toml_text import scene_text
from verify.studies.separation.task import SeparationTask

_LONGER, _MOST_STEPS = 100, 10_000  # the run that is shown, in runs of the hunt, and its most steps
_SHOWN = 6  # digits of a point
_DIGITS = 8


def gallery(
    request: Hunt,
    hunted: HuntResult,
    store: Store,
    *,
    where: Placement = ANYWHERE,
    done: OnResult | None = None,
) -> Gallery:
    """Build the gallery of the worst scenes, with runs longer than those of the hunt.

    If such a run does not finish, the run of the hunt is shown instead.
    """
    longer = min(request.steps * _LONGER, max(request.steps, _MOST_STEPS))

    def separate_all(scenes: Sequence[Worst], steps: int) -> list[SeparationResult]:
        plan, tasks = Plan(), [_task(each, steps) for each in scenes]
        for task in tasks:
            plan.need(task, "the gallery of the worst scenes")
        results = execute(plan, store, where=where, done=done)
        of_tasks = [results[task.key] for task in tasks]
        return [result for result in of_tasks if isinstance(result, SeparationResult)]

    runs = separate_all(hunted.worst, longer)
    # A longer run that leaves the range is replaced by one as long as the hunt's.
    again = [w for w, run in zip(hunted.worst, runs, strict=True) if run.status != "finished"]
    short = iter(separate_all(again, request.steps))
    return Gallery(
        measure=request.measure,
        sentence=MEASURES[request.measure].sentence,
        seed=request.seed,
        examples=hunted.examples,
        steps=request.steps,
        reach=text(REACH),
        step_sizes=(text(STEP_SIZES[0]), text(STEP_SIZES[1])),
        coefficients=(str(COEFFICIENTS[0]), str(COEFFICIENTS[1])),
        scenes=tuple(
            _gallery_scene(worst, run if run.status == "finished" else next(short), run)
            for worst, run in zip(hunted.worst, runs, strict=True)
        ),
    )


def _task(worst: Worst, steps: int) -> SeparationTask:
    sample = Sample.from_scene(scene_of(worst))
    return SeparationTask(
        **sample.scene.hamiltonian_fields(),
        scheme=sample.scheme.name,
        **sample.run_arguments | {"steps": steps},
        digits=_DIGITS,
    )


def _gallery_scene(worst: Worst, run: SeparationResult, longer: SeparationResult) -> GalleryScene:
    points = orbit(Sample.from_scene(scene_of(worst)))
    lost = meaningless(run.plain.series if run.plain else ())
    return GalleryScene(
        value=worst.value,
        scene=_separating(worst),
        orbit=tuple((decimal(q, _SHOWN), decimal(p, _SHOWN)) for q, p in points),
        separation=run,
        longer=longer if longer is not run else None,
        meaningless_after=lost.first,
        meaningful_from=lost.over,
    )


def _separating(worst: Worst) -> str:
    """Return the scene's text, with the request to separate Λ as the gallery does."""
    scene = scene_of(worst)
    assert scene.grid is not None  # noqa: S101 - as drawn
    grid = scene.grid.model_copy(update={"separate": True})
    return scene_text(scene.model_copy(update={"grid": grid}))


@dataclass(frozen=True)
class Meaningless:
    """The steps between which Λ is meaningless; None where there is no such checkpoint.

    `first`: the first checkpoint, in steps, at which no digit of Λ is right. `over`: the checkpoint
    from which on some digits are right again up to the end of the run.
    """

    first: int | None
    over: int | None


def meaningless(series: Sequence[PartsAt]) -> Meaningless:
    """Find the checkpoints at which max |rounding| so far is not below max |truncation| so far.

    `series`: Λ's parts at checkpoints of one run, in the order of steps.

    The greatest parts so far are compared, as Λ itself may pass through 0. A part that is exactly
    0, or has no known digit, is "0": a part with known digits is then the greater one, and two such
    parts are not compared.
    """
    lost = [
        checkpoint.steps
        for checkpoint, below in zip(series, _below(series), strict=True)
        if not below
    ]
    if not lost:
        return Meaningless(None, None)
    over = (checkpoint.steps for checkpoint in series if checkpoint.steps > lost[-1])
    return Meaningless(lost[0], next(over, None))


def _below(series: Sequence[PartsAt]) -> Iterator[bool]:
    rounding = truncation = Fraction(0)
    for checkpoint in series:
        rounding = max(rounding, abs(Fraction(checkpoint.total)))
        truncation = max(truncation, abs(Fraction(checkpoint.truncation)))
        yield rounding < truncation or not rounding
