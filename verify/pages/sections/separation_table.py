"""The table of truncation and the parts of rounding in Λ, or in W, and what is told beside it."""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from markupsafe import Markup

from verify.pages.figures.captioned_plot import few_digits
from verify.pages.figures.separation_caption import end_of
from verify.pages.sections.rows import Group, Row, shown, told
from verify.pages.text.typography import listed, start, step, whole
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
    told: str  # which of them are shown, where not all are
    computed: str


def grids_of(grids: Grids, proof: ProofResult) -> list[Any]:
    """Those of the scheme whose proof it is."""
    return [grid for grid in grids if grid.points and grid.points[0].scheme == proof.scheme]


def parts_table(grids: Grids, rounding: Rounding, size: Size, kinds: Kinds) -> PartsTable:
    """The table of these grids. `rounding` shows all of it, `size` is what is shown of a part, or
    of a matrix's greatest entry; `kinds` tells of the kinds of bounds."""
    points: list[Separation] = [point for grid in grids for point in grid.points]
    (held,) = shown([points], _unsplit)
    return PartsTable(
        kinds=next(
            (x.plain.parts.of_rounding for x in points if x.plain), points[0].split_into.rounding
        ),
        groups=tuple(groups_of_grids(grids, lambda point: _row(point, rounding, size))),
        count=len(points),
        told=told(len(points), len(held), sum(map(_unsplit, points))),
        computed=computed(points, kinds),
    )


def groups_of_grids(grids: Grids, row: Callable[[Any], Row | None]) -> Iterator[Group]:
    """A group for each grid with a row; as many rows as are shown, of all that there are."""
    for grid, held in zip(grids, shown((grid.points for grid in grids), _unsplit), strict=True):
        points = sorted(held, key=lambda point: Fraction(point.step_size))
        rows = [found for point in points if (found := row(point))]
        if rows:
            yield Group(start(points[0]) + end_of(grid.points), rows)


def _unsplit(point: Separation) -> bool:
    return point.plain is None


def _row(point: Separation, rounding: Rounding, size: Size) -> Row:
    h, steps = step(point.step_size), whole(point.steps)
    if point.plain is None:
        return Row(h, (steps,), point.reason or point.status)
    parts, greatest = point.plain.parts, greatest_part(point.plain)

    def cell(name: str) -> Markup:
        return few_digits(size(largest(getattr(parts, name))), strong=name == greatest)

    last = rounding(point.closed_form) if point.closed_form else Markup("–")
    own = map(cell, parts.of_rounding)
    return Row(h, (steps, cell("truncation"), rounding(point.plain), *own, last))


def greatest_part(evaluation: AnyEvaluation) -> str:
    """The name of the greatest part of rounding; "" where all are 0."""
    parts = evaluation.parts
    sizes = {name: abs(largest(getattr(parts, name)).exact) for name in parts.of_rounding}
    greatest = max(sizes, key=lambda name: sizes[name])
    return greatest if sizes[greatest] else ""


def each_kind(kinds: "Counter[str]") -> str:
    """How many there are of each."""
    if len(kinds) == 1:
        return f"all {next(iter(kinds))}"
    return listed(f"{n} {kind}" for kind, n in kinds.most_common())


def computed(points: Sequence[Separation], told: Kinds) -> str:
    """What stood for exact arithmetic, and how errors were bounded."""
    finished = [p for p in points if p.plain]
    if not finished:
        return ""
    systems = listed(dict.fromkeys(p.arithmetic for p in finished))
    kinds = Counter(str(way.error_kind) for p in finished for way in p.ways.values())
    methods = "; ".join(dict.fromkeys(p.error_method for p in finished))
    return f"In place of exact arithmetic: {systems}. Error bounds {told(kinds)}: {methods}."
