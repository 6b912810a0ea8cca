"""Truncation and the parts of rounding in Λ, or in W: a table, a caption and sentences.

Sentences use the greatest |truncation| and |rounding| along a run, as Λ may pass through 0 at its
end; the table has the parts at the end. The point of a grid is the separation at one step size, and
a way is a method to evaluate Λ or W in float64, a key of `WAYS`.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isfinite
from typing import Any

from markupsafe import Markup

from verify.pages.figures.captioned_plot import known_digits, lg, round_crossover
from verify.pages.sections.table_rows import Group, TableRow, describe_excerpt, select_members
from verify.pages.text.typography import (
    NBSP,
    between,
    count_noun,
    every,
    interval,
    join_and,
    number,
    start,
    step,
    whole,
)
from verify.scenes.results.bounded_value import Value, largest
from verify.scenes.results.proof_result import ProofResult
from verify.scenes.results.separation import (
    WAYS,
    CrossoverResult,
    GridOf,
    Separation,
    SeparationGrid,
    SeparationResult,
)
from verify.scenes.results.separation_parts import AnyEvaluation, EvaluationResult

# The beginning of the reason for a missing crossover.
_NO_CROSSOVER = "none in this range: "

Kinds = Callable[["Counter[str]"], str]
Grids = Sequence[GridOf[Any]]
Size = Callable[[Value], Value]
Rounding = Callable[[AnyEvaluation], Markup]


# -- the table ------------------------------------------------------------------------------------


@dataclass(frozen=True)
class PartsTable:
    """The table of a scheme's separations."""

    kinds: tuple[str, ...]  # the kinds of rounding, which are columns
    groups: tuple[Group, ...]
    count: int
    excerpt: str  # a sentence on the rows that are shown, if not all are
    provenance: str


def grids_of(grids: Grids, proof: ProofResult) -> list[Any]:
    """Return the grids of the scheme that the proof is about."""
    return [grid for grid in grids if grid.points and grid.points[0].scheme == proof.scheme]


def parts_table(grids: Grids, rounding: Rounding, size: Size, kinds: Kinds) -> PartsTable:
    """Return the table of these grids.

    `rounding` formats the total rounding, `size` returns the number to show for a part or a
    matrix's greatest entry, and `kinds` describes the kinds of bounds.
    """
    points: list[Separation] = [point for grid in grids for point in grid.points]
    (visible,) = select_members([points], _is_unsplit)
    return PartsTable(
        kinds=next(
            (x.plain.parts.of_rounding for x in points if x.plain), points[0].split_into.rounding
        ),
        groups=tuple(groups_of_grids(grids, lambda point: _parts_row(point, rounding, size))),
        count=len(points),
        excerpt=describe_excerpt(len(points), len(visible), sum(map(_is_unsplit, points))),
        provenance=describe_evaluation(points, kinds),
    )


def groups_of_grids(grids: Grids, row: Callable[[Any], TableRow | None]) -> Iterator[Group]:
    """Yield a group for each grid that has a row, with the rows for which there is room."""
    for grid, visible in zip(
        grids, select_members((grid.points for grid in grids), _is_unsplit), strict=True
    ):
        points = sorted(visible, key=lambda point: Fraction(point.step_size))
        rows = [built_row for point in points if (built_row := row(point))]
        if rows:
            yield Group(start(points[0]) + end_of(grid.points), rows)


def _is_unsplit(point: Separation) -> bool:
    return point.plain is None


def _parts_row(point: Separation, rounding: Rounding, size: Size) -> TableRow:
    h, steps = step(point.step_size), whole(point.steps)
    if point.plain is None:
        return TableRow(h, (steps,), point.reason or point.status)
    parts, greatest = point.plain.parts, greatest_part(point.plain)

    def cell(name: str) -> Markup:
        return known_digits(size(largest(getattr(parts, name))), strong=name == greatest)

    closed_form_cell = rounding(point.closed_form) if point.closed_form else Markup("–")
    part_cells = map(cell, parts.of_rounding)
    return TableRow(
        h, (steps, cell("truncation"), rounding(point.plain), *part_cells, closed_form_cell)
    )


def greatest_part(evaluation: AnyEvaluation) -> str:
    """Return the name of the greatest kind of rounding; "" if all are 0."""
    parts = evaluation.parts
    sizes = {name: abs(largest(getattr(parts, name)).exact) for name in parts.of_rounding}
    greatest = max(sizes, key=lambda name: sizes[name])
    return greatest if sizes[greatest] else ""


def list_kinds(kinds: "Counter[str]") -> str:
    """Return the kinds of bounds as text, each with its count if there are several."""
    if len(kinds) == 1:
        return f"all {next(iter(kinds))}"
    return join_and(f"{n} {kind}" for kind, n in kinds.most_common())


def describe_evaluation(points: Sequence[Separation], format_kinds: Kinds) -> str:
    """Return sentences on the number systems that stood for exact arithmetic, and on the bounds."""
    finished = [p for p in points if p.plain]
    if not finished:
        return ""
    systems = join_and(dict.fromkeys(p.arithmetic for p in finished))
    kinds = Counter(str(way.error_kind) for p in finished for way in p.ways.values())
    methods = "; ".join(dict.fromkeys(p.error_method for p in finished))
    return (
        f"In place of exact arithmetic: {systems}. Error bounds {format_kinds(kinds)}: {methods}."
    )


def end_of(points: Sequence[Separation]) -> str:
    """Return `, over [t₀, t₀ + T]` if all runs end at the same time; else ""."""
    lengths = {Fraction(point.step_size) * point.steps for point in points}
    if len(lengths) != 1:
        return ""
    return f", over {interval(points[0].t0, max(lengths), number)}"


# -- the caption ----------------------------------------------------------------------------------


def caption(grid: SeparationGrid, provenance: str) -> str:
    """Return the caption: the crossover of each way, N, and `provenance`."""
    crossovers = {name: getattr(grid, way) for way, name in WAYS.items()}
    sentences = [_describe_crossover(crossover, name) for name, crossover in crossovers.items()]
    # If both ways have the same reason for no crossover, it is given once.
    if len(set(crossovers.values())) == 1 and not grid.plain.step_size:
        sentences = [_describe_crossover(grid.plain, "either way")]
    steps = sorted(point.steps for point in grid.points)
    count = between(whole(steps[0]), whole(steps[-1]), " … ")
    return " ".join(
        [
            "Rounding is the larger part left of its dashed line h*, where smaller steps make Λ no "
            "better; truncation is right of it."
            if any(crossover.step_size for crossover in crossovers.values())
            else "Where rounding lies below truncation, a smaller step size still helps.",
            *sentences,
            f"N = {count} steps.",
            provenance,
        ]
    )


def _describe_crossover(result: CrossoverResult, way_name: str) -> str:
    way_name = way_name[0].upper() + way_name[1:]
    bracket = ""
    if result.bracket:
        low, high = (step(end) for end in result.bracket)
        bracket = f"between {low} and {high}"
    if result.step_size:
        return f"{way_name}: h* ≈{NBSP}{round_crossover(result.step_size)}, {bracket}."
    reason = result.reason.removeprefix(_NO_CROSSOVER)
    return f"{way_name}: {bracket or 'no crossover'}; {reason}."


# -- sentences ------------------------------------------------------------------------------------


def describe_separation(points: Sequence[SeparationResult], location: str = "") -> Iterator[str]:
    """Yield sentences on rounding against truncation, its greatest part and the better way.

    `location`: a phrase for the first sentence, such as " on the grid of runs".
    """
    evaluations = [point.plain for point in points if point.plain]
    if not evaluations:
        yield "No entry could be separated; the table says why."
        return
    yield _compare_with_truncation(evaluations, location)
    greatest = Counter(part for evaluation in evaluations if (part := greatest_part(evaluation)))
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
        unsplit = _count_of(len(points) - len(evaluations), len(points))
        yield f"{unsplit} could not be separated; the table says why."


def _compare_with_truncation(evaluations: Sequence[EvaluationResult], location: str) -> str:
    gaps = [gap for evaluation in evaluations if (gap := decades_below(evaluation)) is not None]
    below, above = [g for g in gaps if g > 0], [-g for g in gaps if g <= 0]
    clauses = [
        f"{side} truncation in {_count_of(len(distances), len(evaluations))}, "
        f"by {_format_range(distances)} decades"
        for side, distances in (("below", below), ("above", above))
        if distances
    ]
    if not clauses:
        return "Of truncation or of rounding no digit is known, in any entry."
    return f"Evaluated {WAYS['plain']}{location}, the rounding in Λ is {', and '.join(clauses)}."


def _compare_ways(pairs: Sequence[tuple[EvaluationResult, EvaluationResult]]) -> str:
    """Return a sentence on the rounding of the closed form, compared with that of the plain way."""
    gains = [
        lg(plain.largest["total"]) - lg(closed_form.largest["total"])
        for plain, closed_form in pairs
    ]
    finite = [gain for gain in gains if isfinite(gain)]
    better, worse = [g for g in finite if g > 0], [-g for g in finite if g < 0]
    subject = "By the closed form of ΔJ with log1p summation rounding is"
    clauses = [
        f"{kind} in {_count_of(len(distances), len(pairs))}, by {_format_range(distances)} decades"
        for kind, distances in (("smaller", better), ("greater", worse))
        if distances
    ]
    return f"{subject} {', and '.join(clauses)}." if clauses else f"{subject} as great."


def growth_finding(points: Sequence[SeparationResult]) -> str:
    """Return a sentence on the runs whose rounding is a random walk, a drift, or undecided."""
    clauses = []
    for way, name in WAYS.items():
        evaluations = [getattr(point, way) for point in points if getattr(point, way)]
        names = Counter(evaluation.growth["total"].name for evaluation in evaluations)
        if names:
            *others, (last, n) = names.most_common()
            ranked = [f"{kind} in {k}" for kind, k in others]
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
