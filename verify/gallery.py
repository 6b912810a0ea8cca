"""The worst scenes of a hunt as a report shows them: each with its orbit and its Λ, split."""

from collections.abc import Sequence
from fractions import Fraction
from tomllib import loads

from verify.exact import decimal
from verify.example import Example
from verify.execute import Done, Store, execute
from verify.executors import ANYWHERE, Where
from verify.explore_results import Gallery, GalleryScene, Worst
from verify.hunting import REACH, STEP_SIZES, Hunt
from verify.measures import MEASURES, orbit
from verify.planned import Plan
from verify.results import EvaluationResult, SeparationResult
from verify.scene import scene_from
from verify.tasks import SeparationTask, key

_LONGER, _MOST_STEPS = 100, 10_000  # the run that is shown, in runs of the hunt, and its most steps
_SHOWN = 6  # digits of a point
_DIGITS = 8


def gallery(
    asked: Hunt,
    worst: Sequence[Worst],
    store: Store,
    *,
    where: Where = ANYWHERE,
    done: Done | None = None,
) -> Gallery:
    """The scenes with what is shown of them, over runs longer than those of the hunt."""
    plan, tasks = Plan(), [_task(each, asked) for each in worst]
    for task in tasks:
        plan.need(task, "the gallery of the worst scenes")
    results = execute(plan, store, where=where, done=done)
    found = [results[key(task)] for task in tasks]
    return Gallery(
        measure=asked.measure,
        sentence=MEASURES[asked.measure].sentence,
        seed=asked.seed,
        examples=asked.examples,
        steps=asked.steps,
        reach=decimal(REACH, 1),
        step_sizes=(str(STEP_SIZES[0]), str(STEP_SIZES[1])),
        scenes=tuple(
            _shown(each, result)
            for each, result in zip(worst, found, strict=True)
            if isinstance(result, SeparationResult)
        ),
    )


def _example(worst: Worst) -> Example:
    return Example.of(scene_from(loads(worst.scene, parse_float=str), "scene"))


def _task(worst: Worst, asked: Hunt) -> SeparationTask:
    example = _example(worst)
    return SeparationTask(
        **example.scene.given(),
        scheme=example.scheme.name,
        q=example.q,
        p=example.p,
        step_size=example.step_size,
        steps=min(asked.steps * _LONGER, max(asked.steps, _MOST_STEPS)),
        digits=_DIGITS,
    )


def _shown(worst: Worst, separation: SeparationResult) -> GalleryScene:
    points = orbit(_example(worst))
    return GalleryScene(
        value=worst.value,
        scene=worst.scene,
        orbit=tuple((decimal(q, _SHOWN), decimal(p, _SHOWN)) for q, p in points),
        separation=separation,
        meaningless_after=_meaningless(separation.plain),
    )


def _meaningless(found: EvaluationResult | None) -> int | None:
    """The first checkpoint at which rounding is as large as truncation; None where at none."""
    for at in found.series if found else ():
        if abs(Fraction(at.total)) >= abs(Fraction(at.truncation)):
            return at.steps
    return None
