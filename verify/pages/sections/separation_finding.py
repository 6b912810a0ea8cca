"""What separations of truncation and rounding in Λ say, in sentences; every number is the data's.

What stands for a run is the greatest |truncation| and |rounding| along it, since Λ may pass through
0 at its end; the parts themselves are those at the end.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from math import isfinite

from markupsafe import Markup

from verify.pages.figures.logarithm import lg
from verify.pages.figures.separation_caption import PLAIN
from verify.pages.sections.separation_table import greatest_part
from verify.pages.text.typography import between, counted, every, listed, whole
from verify.scenes.results.separation import WAYS, SeparationResult
from verify.scenes.results.separation_parts import AnyEvaluation, EvaluationResult


def finding(points: Sequence[SeparationResult], where: str = "") -> Iterator[str]:
    """What the entries say: rounding against truncation, its greatest part, the better way.

    `where` the entries are, with a space before it, goes into the first sentence.
    """
    held = [point.plain for point in points if point.plain]
    if not held:
        yield "No entry could be separated; the table says why."
        return
    yield _against_truncation(held, where)
    greatest = Counter(part for each in held if (part := greatest_part(each)))
    if greatest:
        ranked = [
            Markup("<code>{}</code> in {}").format(part, _of(n, len(held)))
            for part, n in greatest.most_common()
        ]
        yield Markup("Its greatest part is {}.").format(Markup(listed(ranked)))  # noqa: S704
    pairs = [(p.plain, p.closed_form) for p in points if p.plain and p.closed_form]
    if pairs:
        yield _bought(pairs)
    if len(held) < len(points):
        lost = _of(len(points) - len(held), len(points))
        yield f"{lost} could not be separated; the table says why."


def _against_truncation(held: Sequence[EvaluationResult], where: str) -> str:
    gaps = [gap for each in held if (gap := decades_below(each)) is not None]
    below, above = [g for g in gaps if g > 0], [-g for g in gaps if g <= 0]
    said = [
        f"{side} truncation in {_of(len(found), len(held))}, by {_range(found)} decades"
        for side, found in (("below", below), ("above", above))
        if found
    ]
    if not said:
        return "Of truncation or of rounding no digit is known, in any entry."
    return f"Evaluated {WAYS[PLAIN]}{where}, the rounding in Λ is {', and '.join(said)}."


def _bought(pairs: Sequence[tuple[EvaluationResult, EvaluationResult]]) -> str:
    """What the closed form with compensated summation of logarithms gains in rounding."""
    gains = [lg(a.largest["total"]) - lg(b.largest["total"]) for a, b in pairs]
    known = [gain for gain in gains if isfinite(gain)]
    better, worse = [g for g in known if g > 0], [-g for g in known if g < 0]
    way = "By the closed form of ΔJ with log1p summation rounding is"
    said = [
        f"{kind} in {_of(len(found), len(pairs))}, by {_range(found)} decades"
        for kind, found in (("smaller", better), ("greater", worse))
        if found
    ]
    return f"{way} {', and '.join(said)}." if said else f"{way} as great."


def growth_finding(points: Sequence[SeparationResult]) -> str:
    """How often rounding was named a random walk, a drift, or neither."""
    said = []
    for way, name in WAYS.items():
        evaluations = [getattr(point, way) for point in points if getattr(point, way)]
        counted = Counter(each.growth["total"].name for each in evaluations)
        if counted:
            *most, (last, n) = counted.most_common()
            ranked = [f"{kind} in {k}" for kind, k in most]
            said.append(f"{name}, {listed([*ranked, f'{last} in {_of(n, len(evaluations))}'])}")
    return f"How rounding grows with N: {'; '.join(said)}." if said else ""


def _of(n: int, count: int) -> str:
    if n == count:
        return every(count, "entry", "entries")
    return f"{whole(n)} of {counted(count, 'entry', 'entries')}"


def _range(found: Sequence[float]) -> str:
    return between(f"{min(found):.1f}", f"{max(found):.1f}")


def decades_below(evaluation: AnyEvaluation) -> float | None:
    """By how many decades the greatest |rounding| lies below the greatest |truncation|."""
    gap = lg(evaluation.largest["truncation"]) - lg(evaluation.largest["total"])
    return gap if isfinite(gap) else None
