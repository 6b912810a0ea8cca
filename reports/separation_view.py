"""Truncation against rounding in Λ as the page shows it: sentences, figures and tables.

What stands for a run is the greatest |truncation| and |rounding| along it, since Λ may pass through
0 at its end; the parts themselves are those at the end.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from math import isfinite

from markupsafe import Markup

from reports.logarithm import lg
from reports.plots import Plot, few
from reports.separation_caption import PLAIN, WAYS, caption, end_of, short, ways_of
from reports.typography import NBSP, listed, number, start, whole
from verify.results import (
    EvaluationResult,
    GrowthResult,
    SeparationGrid,
    SeparationResult,
    Value,
)

MOST_ROWS = 600
PARTS = ("input", "trajectory", "determinant", "product")


@dataclass(frozen=True)
class PartsRow:
    """One entry: its parts, then under each rounding how it compares with truncation."""

    step_size: str
    steps: str
    truncation: Markup
    plain: Markup
    parts: tuple[Markup, ...]
    closed_form: Markup
    failure: str


@dataclass(frozen=True)
class GrowthRow:
    step_size: str
    steps: str
    ways: tuple[Markup, ...]


@dataclass(frozen=True)
class Group:
    """The entries of one initial value."""

    label: str
    parts: tuple[PartsRow, ...]
    growth: tuple[GrowthRow, ...]


@dataclass(frozen=True)
class SeparationView:
    finding: tuple[str, ...]
    plots: tuple[Plot, ...]
    groups: tuple[Group, ...]
    count: int
    shown: int
    growth: str
    computed: str


def separation_view(
    own: Sequence[SeparationGrid], wide: Sequence[SeparationGrid], *, name: str
) -> SeparationView:
    """`own`: the grids of the scene's runs; `wide`: those over a range of step sizes beside it."""
    of_grid = [point for grid in own or wide for point in grid.points]
    rows = [point for grid in (*own, *wide) for point in grid.points]
    return SeparationView(
        finding=tuple(_finding(of_grid)),
        plots=tuple(_plots(wide, name)),
        groups=tuple(_groups([*own, *wide])),
        count=len(rows),
        shown=min(len(rows), MOST_ROWS),
        growth=_growth_finding(of_grid),
        computed=_computed(rows),
    )


# -- sentences ------------------------------------------------------------------------------------


def _finding(points: Sequence[SeparationResult]) -> Iterator[str]:
    """What the entries say: rounding against truncation, its greatest part, the better way."""
    held = [point.plain for point in points if point.plain]
    if not held:
        yield "No entry could be separated; the table says why."
        return
    yield _against_truncation(held)
    greatest = Counter(part for each in held if (part := _greatest_part(each)))
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


def _against_truncation(held: Sequence[EvaluationResult]) -> str:
    gaps = [gap for each in held if (gap := _gap(each)) is not None]
    below, above = [g for g in gaps if g > 0], [-g for g in gaps if g <= 0]
    said = [
        f"{side} truncation in {_of(len(found), len(held))}, by {_range(found)} decades"
        for side, found in (("below", below), ("above", above))
        if found
    ]
    if not said:
        return "Of truncation or of rounding no digit is known, in any entry."
    return f"Evaluated {WAYS[PLAIN]}, the rounding in Λ is {listed(said)}."


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
    return f"{way} {listed(said)}." if said else f"{way} as great."


def _growth_finding(points: Sequence[SeparationResult]) -> str:
    """How often rounding was named a random walk, a drift, or neither."""
    said = []
    for way, name in WAYS.items():
        evaluations = [getattr(point, way) for point in points if getattr(point, way)]
        counted = Counter(each.growth["total"].name for each in evaluations)
        if counted:
            ranked = [f"{kind} in {n}" for kind, n in counted.most_common()]
            said.append(f"{name}, {listed(ranked)} of {len(evaluations)} entries")
    return f"How rounding grows with N: {'; '.join(said)}." if said else ""


def _computed(points: Sequence[SeparationResult]) -> str:
    finished = [p for p in points if p.plain]
    if not finished:
        return ""
    systems = listed(dict.fromkeys(p.arithmetic for p in finished))
    kinds = Counter(
        evaluation.error_kind
        for p in finished
        for evaluation in (p.plain, p.closed_form)
        if evaluation
    )
    methods = "; ".join(dict.fromkeys(p.error_method for p in finished))
    bounds = "all enclosed" if set(kinds) == {"enclosed"} else "all estimated"
    if len(kinds) > 1:
        bounds = listed(f"{n} {kind}" for kind, n in kinds.most_common())
    return f"In place of exact arithmetic: {systems}. Error bounds {bounds}: {methods}."


def _of(n: int, count: int) -> str:
    if n == count:
        return "the one entry" if count == 1 else f"all {_entries(count)}"
    return f"{whole(n)} of {_entries(count)}"


def _entries(count: int) -> str:
    return "1 entry" if count == 1 else f"{whole(count)} entries"


def _range(found: Sequence[float]) -> str:
    low, high = f"{min(found):.1f}", f"{max(found):.1f}"
    return low if low == high else f"{low} to {high}"


def _gap(evaluation: EvaluationResult) -> float | None:
    """By how many decades the greatest |rounding| lies below the greatest |truncation|."""
    gap = lg(evaluation.largest["truncation"]) - lg(evaluation.largest["total"])
    return gap if isfinite(gap) else None


def _greatest_part(evaluation: EvaluationResult) -> str:
    sizes = {name: abs(Decimal(getattr(evaluation.parts, name).value)) for name in PARTS}
    greatest = max(sizes, key=lambda name: sizes[name])
    return greatest if sizes[greatest] else ""


# -- figures --------------------------------------------------------------------------------------


def _plots(grids: Sequence[SeparationGrid], name: str) -> Iterator[Plot]:
    """A figure for each grid over which truncation and rounding can be drawn."""
    if not grids:
        return
    from reports import crossover_figure

    for index, grid in enumerate(grids):
        lines = [
            crossover_figure.line(label, points)
            for label, points in ways_of(grid)
            if len(points) > 1
        ]
        lines = [each for each in lines if len(each.points) > 1]
        if len(lines) < 2:
            continue
        marks = [
            crossover_figure.Mark(found.step_size, f"h* ≈{NBSP}{short(found.step_size)}, {of}")
            for way, of in WAYS.items()
            if (found := getattr(grid, way)).step_size is not None
        ]
        first = grid.points[0]
        lead = f"Truncation and rounding in Λ against h, from {start(first)}{end_of(grid.points)}"
        svg = crossover_figure.truncation_against_rounding(
            lines, marks, name=f"crossover-{index}-of-{name}", label=f"{lead}."
        )
        yield Plot(svg, f"{lead}.", caption(grid, _computed(grid.points)))


# -- tables ---------------------------------------------------------------------------------------


def _groups(grids: Sequence[SeparationGrid]) -> Iterator[Group]:
    left = MOST_ROWS
    for grid in grids:
        points = sorted(grid.points[:left], key=lambda point: Fraction(point.step_size))
        left -= len(points)
        if points:
            yield Group(
                label=start(points[0]) + end_of(grid.points),
                parts=tuple(_parts_row(point) for point in points),
                growth=tuple(_growth_row(point) for point in points if point.plain),
            )


def _parts_row(point: SeparationResult) -> PartsRow:
    h, steps, none = point.step_size, whole(point.steps), Markup("–")
    if point.plain is None:
        failure = point.reason or point.status
        return PartsRow(h, steps, none, none, (), none, failure)
    parts, closed = point.plain.parts, point.closed_form
    greatest = _greatest_part(point.plain)
    return PartsRow(
        step_size=h,
        steps=steps,
        truncation=_known(parts.truncation),
        plain=_compared(point.plain),
        parts=tuple(_known(getattr(parts, name), strong=name == greatest) for name in PARTS),
        closed_form=_compared(closed) if closed else none,
        failure="",
    )


def _known(found: Value, *, strong: bool = False) -> Markup:
    """The first of the known digits; where none is known, the bound."""
    if Decimal(found.value) == 0 and found.bound != "0":
        return Markup("|·|{0}≤{0}{1}").format(NBSP, few(found.bound))
    shown = Markup("<b>{}</b>") if strong else Markup("{}")
    return shown.format(few(found.value))


def _compared(evaluation: EvaluationResult) -> Markup:
    gap = _gap(evaluation)
    if gap is None:
        return _known(evaluation.parts.total)
    side = "below" if gap > 0 else "above"
    kind = "bound" if gap > 0 else "bound over"
    return Markup('{} <span class="{}">{:.1f} decades {}</span>').format(
        _known(evaluation.parts.total), kind, abs(gap), side
    )


def _growth_row(point: SeparationResult) -> GrowthRow:
    ways = (getattr(point, way) for way in WAYS)
    return GrowthRow(
        point.step_size,
        whole(point.steps),
        tuple(_growth(each.growth["total"]) if each else Markup("–") for each in ways),
    )


def _growth(found: GrowthResult) -> Markup:
    if found.exponent is None:
        return Markup('{} <span class="bound">{}</span>').format(found.name, found.reason)
    return Markup('{} <span class="bound">N to the {}{}±{}{}</span>').format(
        found.name, number(found.exponent), NBSP, NBSP, found.standard_error
    )
