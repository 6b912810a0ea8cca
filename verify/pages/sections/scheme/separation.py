"""Truncation against rounding in Λ as the page shows it: sentences, figures and tables."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

from markupsafe import Markup

from verify.pages.figures.captioned_plot import Plot, few_digits, plotted
from verify.pages.figures.separation_caption import caption, end_of
from verify.pages.sections.rows import Group, Row, groups_of_grids, told_of_points
from verify.pages.sections.section import Picture, Section
from verify.pages.sections.separation_finding import (
    computed,
    decades_below,
    finding,
    greatest_part,
    growth_finding,
)
from verify.pages.text import words
from verify.pages.text.prose import prose
from verify.pages.text.typography import NBSP, number, start, step, whole
from verify.scenes.results.proof import ProofResult
from verify.scenes.results.report import SceneResult
from verify.scenes.results.separation import (
    ROUNDING,
    WAYS,
    EvaluationResult,
    GrowthResult,
    SeparationGrid,
    SeparationResult,
)


@dataclass(frozen=True)
class SeparationView:
    finding: tuple[str, ...]
    plots: tuple[Plot, ...]
    kinds: tuple[str, ...]  # of rounding
    parts: tuple[Group, ...]
    growths: tuple[Group, ...]
    count: int
    told: str  # which of them are shown, where not all are
    growth: str
    computed: str


def _of(grids: Sequence[SeparationGrid], proof: ProofResult) -> list[SeparationGrid]:
    return [g for g in grids if g.points and g.points[0].scheme == proof.scheme]


def _view(scene: SceneResult, proof: ProofResult, anchor: str) -> SeparationView | None:
    own, wide = _of(scene.separations, proof), _of(scene.crossovers, proof)
    if not own and not wide:
        return None
    of_grid = [point for grid in own or wide for point in grid.points]
    rows = [point for grid in (*own, *wide) for point in grid.points]
    return SeparationView(
        finding=tuple(finding(of_grid, " on the grid of runs" if own else "")),
        plots=tuple(_plots(wide, anchor)),
        kinds=next((x.plain.parts.of_rounding for x in rows if x.plain), ROUNDING),
        parts=tuple(groups_of_grids([*own, *wide], _parts_row)),
        growths=tuple(groups_of_grids([*own, *wide], _growth_row)),
        count=len(rows),
        told=told_of_points(rows),
        growth=growth_finding(of_grid),
        computed=computed(rows),
    )


# -- figures --------------------------------------------------------------------------------------


def _plots(grids: Sequence[SeparationGrid], name: str) -> Iterator[Plot]:
    """A figure for each grid over which truncation and rounding can be drawn."""
    for index, grid in enumerate(grids):
        from verify.pages.figures import crossover_figure as figure

        lines, marks = figure.contents(grid)
        if len(lines) < 2:
            continue
        place = f"{start(grid.points[0])}{end_of(grid.points)}"
        yield plotted(
            partial(figure.draw_truncation_against_rounding, lines, marks),
            name=f"crossover-{index}-of-{name}",
            lead=f"Truncation and rounding in Λ against h, from {place}",
            caption=caption(grid, computed(grid.points)),
        )


# -- tables ---------------------------------------------------------------------------------------


def _parts_row(point: SeparationResult) -> Row:
    h, steps = step(point.step_size), whole(point.steps)
    if point.plain is None:
        return Row(h, (steps,), point.reason or point.status)
    parts, closed = point.plain.parts, point.closed_form
    greatest = greatest_part(point.plain)
    own = (few_digits(getattr(parts, name), strong=name == greatest) for name in parts.of_rounding)
    last = _compared(closed) if closed else Markup("–")
    truncation = few_digits(parts.truncation)
    return Row(h, (steps, truncation, _compared(point.plain), *own, last))


def _compared(evaluation: EvaluationResult) -> Markup:
    gap = decades_below(evaluation)
    if gap is None:
        return few_digits(evaluation.parts.total)
    side = "below" if gap > 0 else "above"
    kind = "bound" if gap > 0 else "bound over"
    return Markup('{} <span class="{}">{:.1f} decades {}</span>').format(
        few_digits(evaluation.parts.total), kind, abs(gap), side
    )


def _growth_row(point: SeparationResult) -> Row | None:
    if point.plain is None:
        return None
    ways = (getattr(point, way) for way in WAYS)
    cells = (_growth(each.growth["total"]) if each else Markup("–") for each in ways)
    return Row(step(point.step_size), (whole(point.steps), *cells))


def _growth(found: GrowthResult) -> Markup:
    if found.exponent is None:
        return Markup('{} <span class="bound">{}</span>').format(found.name, prose(found.reason))
    exponent = f"{number(found.exponent)}{NBSP}±{NBSP}{found.standard_error}"
    return Markup('{} <span class="muted beside">{}</span>').format(exponent, found.name)


_CROSSED = {
    "Crossover h*": Markup(
        "The step size below which rounding is larger than truncation, interpolated in logarithms "
        "between the two step sizes that bracket it. Smaller steps than h* make Λ no better."
    )
}
SECTION = Section(
    order=70,
    title="Truncation against rounding",
    view=_view,
    pictures=lambda view: [Picture((3,), plot) for plot in view.plots],
    terms=lambda _: words.SEPARATED | _CROSSED | words.RAN,
)
