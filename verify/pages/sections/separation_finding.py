"""Sentences on separations of truncation and rounding in Λ; every number is from the data.

A run is represented by the greatest |truncation| and |rounding| along it, since Λ may pass through
0 at its end; the parts themselves are those at the end.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from math import isfinite

from markupsafe import Markup

from verify.pages.figures.logarithm import lg
from verify.pages.figures.separation_caption import PLAIN
from verify.pages.sections.separation_table import greatest_part
from verify.pages.text.typography import between, count_noun, every, join_and, whole
from verify.scenes.results.separation import WAYS, SeparationResult
from verify.scenes.results.separation_parts import AnyEvaluation, EvaluationResult


def finding(points: Sequence[SeparationResult], where: str = "") -> Iterator[str]:
    """Yield sentences on rounding against truncation, its greatest part and the better way.

    `where`: the place of the entries, beginning with a space, for the first sentence.
    """
    evaluations = [point.plain for point in points if point.plain]
    if not evaluations:
        yield "No entry could be separated; the table says why."
        return
    yield _compare_with_truncation(evaluations, where)
    greatest = Counter(part for each in evaluations if (part := greatest_part(each)))
    if greatest:
        ranked = [
            Markup("<code>{}</code> in {}").format(part, _count_of(n, len(evaluations)))
            for part, n in greatest.most_common()
        ]
        yield Markup("Its greatest part is {}.").format(Markup(join_and(ranked)))  # noqa: S704
    pairs = [(p.plain, p.closed_form) for p in points if p.plain and p.closed_form]
    if pairs:
        yield _compare_ways(pairs)
    if len(evaluations) < len(points):
        lost = _count_of(len(points) - len(evaluations), len(points))
        yield f"{lost} could not be separated; the table says why."


def _compare_with_truncation(evaluations: Sequence[EvaluationResult], where: str) -> str:
    gaps = [gap for each in evaluations if (gap := decades_below(each)) is not None]
    below, above = [g for g in gaps if g > 0], [-g for g in gaps if g <= 0]
    clauses = [
        f"{side} truncation in {_count_of(len(distances), len(evaluations))}, "
        f"by {_format_range(distances)} decades"
        for side, distances in (("below", below), ("above", above))
        if distances
    ]
    if not clauses:
        return "Of truncation or of rounding no digit is known, in any entry."
    return f"Evaluated {WAYS[PLAIN]}{where}, the rounding in Λ is {', and '.join(clauses)}."


def _compare_ways(pairs: Sequence[tuple[EvaluationResult, EvaluationResult]]) -> str:
    """Return a sentence on the gain of the closed form with compensated sums of logarithms."""
    gains = [lg(a.largest["total"]) - lg(b.largest["total"]) for a, b in pairs]
    finite = [gain for gain in gains if isfinite(gain)]
    better, worse = [g for g in finite if g > 0], [-g for g in finite if g < 0]
    way = "By the closed form of ΔJ with log1p summation rounding is"
    clauses = [
        f"{kind} in {_count_of(len(distances), len(pairs))}, by {_format_range(distances)} decades"
        for kind, distances in (("smaller", better), ("greater", worse))
        if distances
    ]
    return f"{way} {', and '.join(clauses)}." if clauses else f"{way} as great."


def growth_finding(points: Sequence[SeparationResult]) -> str:
    """Return how often rounding was classified as a random walk, as a drift, or as neither."""
    clauses = []
    for way, name in WAYS.items():
        evaluations = [getattr(point, way) for point in points if getattr(point, way)]
        names = Counter(each.growth["total"].name for each in evaluations)
        if names:
            *most, (last, n) = names.most_common()
            ranked = [f"{kind} in {k}" for kind, k in most]
            clauses.append(
                f"{name}, {join_and([*ranked, f'{last} in {_count_of(n, len(evaluations))}'])}"
            )
    return f"How rounding grows with N: {'; '.join(clauses)}." if clauses else ""


def _count_of(n: int, count: int) -> str:
    if n == count:
        return every(count, "entry", "entries")
    return f"{whole(n)} of {count_noun(count, 'entry', 'entries')}"


def _format_range(values: Sequence[float]) -> str:
    return between(f"{min(values):.1f}", f"{max(values):.1f}")


def decades_below(evaluation: AnyEvaluation) -> float | None:
    """Return the decades by which the greatest |rounding| lies below the greatest |truncation|."""
    gap = lg(evaluation.largest["truncation"]) - lg(evaluation.largest["total"])
    return gap if isfinite(gap) else None
