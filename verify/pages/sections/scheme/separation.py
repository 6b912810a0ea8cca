"""Truncation and rounding in Λ, or in W in n degrees of freedom: sentences, figures, tables."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial

from markupsafe import Markup

from verify.pages.figures.captioned_plot import (
    Plot,
    captioned_plot,
    known_digits,
    round_to_few_digits,
)
from verify.pages.sections.section import Picture, ReportSection
from verify.pages.sections.separation_summary import (
    PartsTable,
    caption,
    decades_below,
    describe_evaluation,
    describe_separation,
    end_of,
    grids_of,
    groups_of_grids,
    growth_finding,
    list_kinds,
    parts_table,
)
from verify.pages.sections.table_rows import Group, TableRow
from verify.pages.text import legend
from verify.pages.text.prose_markup import prose
from verify.pages.text.typography import NBSP, join_and, number, start, step, whole
from verify.scenes.results import separation
from verify.scenes.results.bounded_value import largest
from verify.scenes.results.proof_result import ProofResult
from verify.scenes.results.report import SceneResult
from verify.scenes.results.separation_parts import AnyEvaluation, GrowthResult
from verify.structures import AREA, SYMPLECTIC, CanonicalForm


@dataclass(frozen=True)
class SeparationView:
    """The view of a separation.

    `finding`: sentences on all runs in Λ, or on the longest one in W; `growth`: a sentence on the
    growth of rounding in Λ; `growths`: the table of that growth, or of the growth of W;
    `crossovers`: sentences on those in W.
    """

    structure: CanonicalForm
    finding: tuple[str, ...]
    table: PartsTable
    growths: tuple[Group, ...]
    plots: tuple[Plot, ...] = ()
    crossovers: tuple[str, ...] = ()
    growth: str = ""


def _view(scene: SceneResult, proof: ProofResult, anchor: str) -> SeparationView | None:
    plain_grids = grids_of(scene.separations, proof)
    crossover_grids = grids_of(scene.crossovers, proof)
    if not plain_grids and not crossover_grids:
        return _view_of_form(scene, proof)
    grid_points = [point for grid in plain_grids or crossover_grids for point in grid.points]
    return SeparationView(
        structure=AREA,
        finding=tuple(
            describe_separation(grid_points, " on the grid of runs" if plain_grids else "")
        ),
        table=parts_table(
            [*plain_grids, *crossover_grids],
            _rounding_against_truncation,
            lambda part: part,
            list_kinds,
        ),
        growths=tuple(groups_of_grids([*plain_grids, *crossover_grids], _growth_row)),
        plots=tuple(_plots(crossover_grids, anchor)),
        growth=growth_finding(grid_points),
    )


def _view_of_form(scene: SceneResult, proof: ProofResult) -> SeparationView | None:
    """Return the view of W, in n degrees of freedom."""
    plain_grids = grids_of(scene.form_separations, proof)
    crossover_grids = grids_of(scene.form_crossovers, proof)
    grids = [*plain_grids, *crossover_grids]
    if not grids:
        return None
    return SeparationView(
        structure=SYMPLECTIC,
        finding=tuple(_describe_longest_run([point for grid in grids for point in grid.points])),
        table=parts_table(grids, _greatest_rounding, abs, join_and),
        growths=tuple(groups_of_grids(grids, _motion_row)),
        crossovers=tuple(map(_describe_crossover, crossover_grids)),
    )


def _describe_longest_run(points: Sequence[separation.SeparationInDegrees]) -> Iterator[Markup]:
    """Yield a sentence on the longest run: how W grew, and how the tangent map did."""
    separated = [point for point in points if point.tangent]
    if not separated:
        yield Markup("No run could be separated; the table says why.")
        return
    longest = max(separated, key=lambda point: Fraction(point.step_size) * point.steps)
    assert longest.tangent is not None  # noqa: S101 - as `separated` says
    run_text = Markup("Over T = {}, h = {}: ").format(longest.tangent.time, step(longest.step_size))
    yield run_text + prose(longest.tangent.meaning) + Markup(".")


def _describe_crossover(grid: separation.SeparationGridInDegrees) -> str:
    ways = [(label, getattr(grid, way)) for way, label in separation.WAYS.items()]
    crossovers = (
        f"{label}: {f'h* ≈ {x.step_size}' if x.step_size else x.reason}" for label, x in ways
    )
    return f"Rounding overtakes truncation, from {start(grid.points[0])}: {join_and(crossovers)}."


# -- figures --------------------------------------------------------------------------------------


def _plots(grids: Sequence[separation.SeparationGrid], name: str) -> Iterator[Plot]:
    """Yield a figure for each grid over which truncation and rounding can be drawn."""
    for index, grid in enumerate(grids):
        from verify.pages.figures import step_size_figures as figure

        lines, marks = figure.lines_and_marks(grid)
        if len(lines) < 2:
            continue
        origin = f"{start(grid.points[0])}{end_of(grid.points)}"
        yield captioned_plot(
            partial(figure.draw_truncation_against_rounding, lines, marks),
            name=f"crossover-{index}-of-{name}",
            lead=f"Truncation and rounding in Λ against h, from {origin}",
            caption=caption(grid, describe_evaluation(grid.points, list_kinds)),
        )


# -- tables ---------------------------------------------------------------------------------------


def _rounding_against_truncation(evaluation: AnyEvaluation) -> Markup:
    gap = decades_below(evaluation)
    rounding = known_digits(largest(evaluation.parts.total))
    if gap is None:
        return rounding
    side = "below" if gap > 0 else "above"
    css_class = "bound" if gap > 0 else "bound over"
    return Markup('{} <span class="{}">{:.1f} decades {}</span>').format(
        rounding, css_class, abs(gap), side
    )


def _greatest_rounding(evaluation: AnyEvaluation) -> Markup:
    return known_digits(abs(largest(evaluation.parts.total)))


def _growth_row(point: separation.SeparationResult) -> TableRow | None:
    if point.plain is None:
        return None
    ways = map(point.ways.get, separation.WAYS)
    cells = (
        _format_growth(evaluation.growth["total"]) if evaluation else Markup("–")
        for evaluation in ways
    )
    return TableRow(step(point.step_size), (whole(point.steps), *cells))


def _format_growth(growth: GrowthResult) -> Markup:
    if growth.exponent is None:
        return Markup('{} <span class="bound">{}</span>').format(growth.name, prose(growth.reason))
    exponent = f"{number(growth.exponent)}{NBSP}±{NBSP}{growth.standard_error}"
    return Markup('{} <span class="muted beside">{}</span>').format(exponent, growth.name)


def _motion_row(point: separation.SeparationInDegrees) -> TableRow | None:
    tangent, closed_form = point.tangent, point.closed_form
    if tangent is None or closed_form is None:
        return None
    law = closed_form.law if any(map(any, closed_form.parts.w_working.exact)) else None
    cells = (
        whole(point.steps),
        round_to_few_digits(tangent.norm_squared),
        round_to_few_digits(tangent.areas),
        round_to_few_digits(tangent.finite_time_lyapunov),
        f"exponential, {_CAUSES[tangent.cause]}" if tangent.cause else tangent.motion,
        _format_law(law.exponent, law.name) if law else "0",
    )
    return TableRow(step(point.step_size), cells)


def _format_law(exponent: str | None, name: str) -> str:
    return name if exponent is None else f"{name} ({exponent})"


_CAUSES = {"motion": "the motion’s", "scheme": "the scheme’s", "undecided": "whose, undecided"}
_TERMS = {
    AREA: legend.terms_of("separation") | legend.terms_of("crossover"),
    SYMPLECTIC: {"W": legend.terms_of("form")["W"]} | legend.terms_of("separation-of-form"),
}


def _terms(views: Sequence[SeparationView]) -> Mapping[str, Markup]:
    terms: dict[str, Markup] = {}
    for structure in dict.fromkeys(view.structure for view in views):
        terms |= _TERMS[structure]
    return terms | legend.terms_of_runs()


SECTION = ReportSection(
    order=70,
    view=_view,
    pictures=lambda view: [Picture((3,), plot) for plot in view.plots],
    terms=_terms,
)
