"""The table of truncation and the parts of rounding in Λ, or in W, with its remarks."""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from markupsafe import Markup

from verify.pages.figures.captioned_plot import known_digits
from verify.pages.figures.separation_caption import end_of
from verify.pages.sections.rows import Group, Row, describe_excerpt, select_members
from verify.pages.text.typography import join_and, start, step, whole
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.form_value import largest
from verify.scenes.results.proof import ProofResult
from verify.scenes.results.separation import GridOf, Separation
from verify.scenes.results.separation_parts import AnyEvaluation

Kinds = Callable[["Counter[str]"], str]
Grids = Sequence[GridOf[Any]]
Size = Callable[[Value], Value]
Rounding = Callable[[AnyEvaluation], Markup]


@dataclass(frozen=True)
class PartsTable:
    kinds: tuple[str, ...]  # of rounding
    groups: tuple[Group, ...]
    count: int
    excerpt: str  # says which rows are shown, where not all are
    provenance: str


def grids_of(grids: Grids, proof: ProofResult) -> list[Any]:
    """Return the grids of the scheme that the proof is about."""
    return [grid for grid in grids if grid.points and grid.points[0].scheme == proof.scheme]


def parts_table(grids: Grids, rounding: Rounding, size: Size, kinds: Kinds) -> PartsTable:
    """Return the table of these grids.

    `rounding` formats the whole rounding, `size` gives the size of a part, or of a matrix's
    greatest entry, and `kinds` lists the kinds of bounds.
    """
    points: list[Separation] = [point for grid in grids for point in grid.points]
    (visible,) = select_members([points], _is_unsplit)
    return PartsTable(
        kinds=next(
            (x.plain.parts.of_rounding for x in points if x.plain), points[0].split_into.rounding
        ),
        groups=tuple(groups_of_grids(grids, lambda point: _row(point, rounding, size))),
        count=len(points),
        excerpt=describe_excerpt(len(points), len(visible), sum(map(_is_unsplit, points))),
        provenance=describe_evaluation(points, kinds),
    )


def groups_of_grids(grids: Grids, row: Callable[[Any], Row | None]) -> Iterator[Group]:
    """Yield a group for each grid that has a row, with as many rows as there is room for."""
    for grid, visible in zip(
        grids, select_members((grid.points for grid in grids), _is_unsplit), strict=True
    ):
        points = sorted(visible, key=lambda point: Fraction(point.step_size))
        rows = [built_row for point in points if (built_row := row(point))]
        if rows:
            yield Group(start(points[0]) + end_of(grid.points), rows)


def _is_unsplit(point: Separation) -> bool:
    return point.plain is None


def _row(point: Separation, rounding: Rounding, size: Size) -> Row:
    h, steps = step(point.step_size), whole(point.steps)
    if point.plain is None:
        return Row(h, (steps,), point.reason or point.status)
    parts, greatest = point.plain.parts, greatest_part(point.plain)

    def cell(name: str) -> Markup:
        return known_digits(size(largest(getattr(parts, name))), strong=name == greatest)

    last = rounding(point.closed_form) if point.closed_form else Markup("–")
    part_cells = map(cell, parts.of_rounding)
    return Row(h, (steps, cell("truncation"), rounding(point.plain), *part_cells, last))


def greatest_part(evaluation: AnyEvaluation) -> str:
    """Return the name of the greatest part of rounding; "" where all are 0."""
    parts = evaluation.parts
    sizes = {name: abs(largest(getattr(parts, name)).exact) for name in parts.of_rounding}
    greatest = max(sizes, key=lambda name: sizes[name])
    return greatest if sizes[greatest] else ""


def list_kinds(kinds: "Counter[str]") -> str:
    """Return the number of each kind as text."""
    if len(kinds) == 1:
        return f"all {next(iter(kinds))}"
    return join_and(f"{n} {kind}" for kind, n in kinds.most_common())


def describe_evaluation(points: Sequence[Separation], format_kinds: Kinds) -> str:
    """Return the number systems that stood for exact arithmetic, and how errors were bounded."""
    finished = [p for p in points if p.plain]
    if not finished:
        return ""
    systems = join_and(dict.fromkeys(p.arithmetic for p in finished))
    kinds = Counter(str(way.error_kind) for p in finished for way in p.ways.values())
    methods = "; ".join(dict.fromkeys(p.error_method for p in finished))
    return (
        f"In place of exact arithmetic: {systems}. Error bounds {format_kinds(kinds)}: {methods}."
    )
