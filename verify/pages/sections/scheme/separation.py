"""Truncation against rounding in Λ, or in W, as the page shows it: sentences, figures, tables."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial

from markupsafe import Markup

from verify.pages.figures.captioned_plot import Plot, few, few_digits, plotted
from verify.pages.figures.separation_caption import caption, end_of
from verify.pages.sections.rows import Group, Row
from verify.pages.sections.section import Picture, Section
from verify.pages.sections.separation_finding import decades_below, finding, growth_finding
from verify.pages.sections.separation_table import (
    PartsTable,
    computed,
    each_kind,
    grids_of,
    groups_of_grids,
    parts_table,
)
from verify.pages.text import words
from verify.pages.text.prose import prose
from verify.pages.text.typography import NBSP, listed, number, start, step, whole
from verify.scenes.results.form_value import largest
from verify.scenes.results.proof import ProofResult
from verify.scenes.results.report import SceneResult
from verify.scenes.results.separation import (
    WAYS,
    SeparationGrid,
    SeparationGridInDegrees,
    SeparationInDegrees,
    SeparationResult,
)
from verify.scenes.results.separation_parts import AnyEvaluation, GrowthResult
from verify.structures import AREA, SYMPLECTIC, Structure


@dataclass(frozen=True)
class SeparationView:
    """`finding`: what is said of all, or of the longest run; `growth`: of how rounding grows, in Λ,
    whose table is of `growths`, as that of W is."""

    structure: Structure
    finding: tuple[str, ...]
    table: PartsTable
    growths: tuple[Group, ...]
    plots: tuple[Plot, ...] = ()
    crossed: tuple[str, ...] = ()
    growth: str = ""


def _view(scene: SceneResult, proof: ProofResult, anchor: str) -> SeparationView | None:
    own, wide = grids_of(scene.separations, proof), grids_of(scene.crossovers, proof)
    if not own and not wide:
        return _view_of_form(scene, proof)
    of_grid = [point for grid in own or wide for point in grid.points]
    return SeparationView(
        structure=AREA,
        finding=tuple(finding(of_grid, " on the grid of runs" if own else "")),
        table=parts_table([*own, *wide], _compared, lambda part: part, each_kind),
        growths=tuple(groups_of_grids([*own, *wide], _growth_row)),
        plots=tuple(_plots(wide, anchor)),
        growth=growth_finding(of_grid),
    )


def _view_of_form(scene: SceneResult, proof: ProofResult) -> SeparationView | None:
    """That of W, in n degrees of freedom."""
    own, wide = grids_of(scene.form_separations, proof), grids_of(scene.form_crossovers, proof)
    every = [*own, *wide]
    if not every:
        return None
    return SeparationView(
        structure=SYMPLECTIC,
        finding=tuple(_longest([point for grid in every for point in grid.points])),
        table=parts_table(every, _greatest, abs, listed),
        growths=tuple(groups_of_grids(every, _motion_row)),
        crossed=tuple(map(_crossed, wide)),
    )


def _longest(rows: Sequence[SeparationInDegrees]) -> Iterator[Markup]:
    """What is said of the longest of the runs: how W grew, and how the motion did."""
    held = [point for point in rows if point.tangent]
    if not held:
        yield Markup("No run could be separated; the table says why.")
        return
    longest = max(held, key=lambda point: Fraction(point.step_size) * point.steps)
    assert longest.tangent is not None  # noqa: S101 - chosen so
    where = Markup("Over T = {}, h = {}: ").format(longest.tangent.time, step(longest.step_size))
    yield where + prose(longest.tangent.meaning) + Markup(".")


def _crossed(grid: SeparationGridInDegrees) -> str:
    ways = [(label, getattr(grid, way)) for way, label in WAYS.items()]
    found = (f"{label}: {f'h* ≈ {x.step_size}' if x.step_size else x.reason}" for label, x in ways)
    return f"Rounding overtakes truncation, from {start(grid.points[0])}: {listed(found)}."


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
            caption=caption(grid, computed(grid.points, each_kind)),
        )


# -- tables ---------------------------------------------------------------------------------------


def _compared(evaluation: AnyEvaluation) -> Markup:
    gap = decades_below(evaluation)
    rounding = few_digits(largest(evaluation.parts.total))
    if gap is None:
        return rounding
    side = "below" if gap > 0 else "above"
    kind = "bound" if gap > 0 else "bound over"
    return Markup('{} <span class="{}">{:.1f} decades {}</span>').format(
        rounding, kind, abs(gap), side
    )


def _greatest(evaluation: AnyEvaluation) -> Markup:
    return few_digits(abs(largest(evaluation.parts.total)))


def _growth_row(point: SeparationResult) -> Row | None:
    if point.plain is None:
        return None
    ways = map(point.ways.get, WAYS)
    cells = (_growth(each.growth["total"]) if each else Markup("–") for each in ways)
    return Row(step(point.step_size), (whole(point.steps), *cells))


def _growth(found: GrowthResult) -> Markup:
    if found.exponent is None:
        return Markup('{} <span class="bound">{}</span>').format(found.name, prose(found.reason))
    exponent = f"{number(found.exponent)}{NBSP}±{NBSP}{found.standard_error}"
    return Markup('{} <span class="muted beside">{}</span>').format(exponent, found.name)


def _motion_row(point: SeparationInDegrees) -> Row | None:
    found, closed = point.tangent, point.closed_form
    if found is None or closed is None:
        return None
    law = closed.law if any(map(any, closed.parts.w_working.exact)) else None
    cells = (
        whole(point.steps),
        few(found.norm_squared),
        few(found.areas),
        few(found.finite_time_lyapunov),
        f"exponential, {_CAUSES[found.cause]}" if found.cause else found.motion,
        _law(law.exponent, law.name) if law else "0",
    )
    return Row(step(point.step_size), cells)


def _law(exponent: str | None, name: str) -> str:
    return name if exponent is None else f"{name} ({exponent})"


_CAUSES = {"motion": "the motion’s", "scheme": "the scheme’s", "undecided": "whose, undecided"}
_CROSSED = {
    "Crossover h*": Markup(
        "The step size below which rounding is larger than truncation, interpolated in logarithms "
        "between the two step sizes that bracket it. Smaller steps than h* make Λ no better."
    )
}
_TERMS = {
    AREA: words.SEPARATED | _CROSSED | words.RAN,
    SYMPLECTIC: {"W": words.OF_FORM["W"]} | words.SEPARATED_FORM | words.RAN,
}


def _terms(views: Sequence[SeparationView]) -> Mapping[str, Markup]:
    seen = {view.structure for view in views}
    return {k: x for each, own in _TERMS.items() if each in seen for k, x in own.items()}


SECTION = Section(
    order=70,
    view=_view,
    pictures=lambda view: [Picture((3,), plot) for plot in view.plots],
    terms=_terms,
)
