"""The worst scenes of a hunt as a report shows them: each with its orbit and its Λ, split."""

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
    asked: Hunt,
    found: HuntResult,
    store: Store,
    *,
    where: Placement = ANYWHERE,
    done: OnResult | None = None,
) -> Gallery:
    """The scenes with what is shown of them, over runs longer than those of the hunt.

    Where such a run does not end, the hunt's own is shown.
    """
    longer = min(asked.steps * _LONGER, max(asked.steps, _MOST_STEPS))

    def separated(scenes: Sequence[Worst], steps: int) -> list[SeparationResult]:
        plan, tasks = Plan(), [_task(each, steps) for each in scenes]
        for task in tasks:
            plan.need(task, "the gallery of the worst scenes")
        results = execute(plan, store, where=where, done=done)
        of_tasks = [results[task.key] for task in tasks]
        return [result for result in of_tasks if isinstance(result, SeparationResult)]

    runs = separated(found.worst, longer)
    again = [w for w, run in zip(found.worst, runs, strict=True) if run.status != "finished"]
    short = iter(separated(again, asked.steps))
    return Gallery(
        measure=asked.measure,
        sentence=MEASURES[asked.measure].sentence,
        seed=asked.seed,
        examples=found.examples,
        steps=asked.steps,
        reach=text(REACH),
        step_sizes=(text(STEP_SIZES[0]), text(STEP_SIZES[1])),
        coefficients=(str(COEFFICIENTS[0]), str(COEFFICIENTS[1])),
        scenes=tuple(
            _shown(worst, run if run.status == "finished" else next(short), run)
            for worst, run in zip(found.worst, runs, strict=True)
        ),
    )


def _task(worst: Worst, steps: int) -> SeparationTask:
    sample = Sample.of(scene_of(worst))
    return SeparationTask(
        **sample.scene.hamiltonian_fields(),
        scheme=sample.scheme.name,
        **sample.run_arguments | {"steps": steps},
        digits=_DIGITS,
    )


def _shown(worst: Worst, run: SeparationResult, longer: SeparationResult) -> GalleryScene:
    points = orbit(Sample.of(scene_of(worst)))
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
    """The scene's text, which asks for what the gallery shows."""
    scene = scene_of(worst)
    assert scene.grid is not None  # noqa: S101 - as drawn
    grid = scene.grid.model_copy(update={"separate": True})
    return scene_text(scene.model_copy(update={"grid": grid}))


@dataclass(frozen=True)
class Meaningless:
    """The first checkpoint, in steps, at which no digit of Λ is right, and that from which on some
    are again, to the end of the run; None where there is none."""

    first: int | None
    over: int | None


def meaningless(series: Sequence[PartsAt]) -> Meaningless:
    """Where the greatest |rounding| so far is not below the greatest |truncation| so far.

    `series`: Λ's parts at checkpoints of one run, in the order of steps.

    The greatest ones, as Λ itself may pass through 0. A part that is exactly 0, or of which no
    digit is known, is "0": one that is known is then the greater, and nothing is said of two.
    """
    lost = [at.steps for at, below in zip(series, _below(series), strict=True) if not below]
    if not lost:
        return Meaningless(None, None)
    over = (at.steps for at in series if at.steps > lost[-1])
    return Meaningless(lost[0], next(over, None))


def _below(series: Sequence[PartsAt]) -> Iterator[bool]:
    rounding = truncation = Fraction(0)
    for at in series:
        rounding = max(rounding, abs(Fraction(at.total)))
        truncation = max(truncation, abs(Fraction(at.truncation)))
        yield rounding < truncation or not rounding
