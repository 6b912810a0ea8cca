"""The area error against the step size: |Λ| and MSE/|Λ| over h."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

from verify.pages.figures.captioned_plot import Plot, captioned_plot, describe_runs
from verify.pages.sections.section import Picture, ReportSection
from verify.pages.text import legend
from verify.pages.text.typography import interval
from verify.pages.text.typography import power_of_h as _h
from verify.scenes.frozen import OfScheme
from verify.scenes.results.report import SceneResult
from verify.scenes.results.run import RunResult

if TYPE_CHECKING:
    from verify.pages.figures.step_size_figures import LogarithmicLine, QuantityPanel


def _view(scene: SceneResult, proof: OfScheme, anchor: str) -> tuple[Plot, ...]:
    runs = [run for run in scene.runs if run.scheme == proof.scheme]
    return tuple(_plots(runs, scene, proof, anchor))


def _plots(
    runs: Sequence[RunResult], scene: SceneResult, proof: OfScheme, name: str
) -> Iterator[Plot]:
    """Yield the plot of |Λ| and MSE/|Λ| over h, if there are several step sizes.

    The drawing, and with it matplotlib, is imported only if something is drawn.
    """
    if len({run.step_size for run in runs}) < 2 or not any("lambda" in run.values for run in runs):
        return
    # Λ of equations whose flow does not keep volume is no error.
    if not scene.proofs and proof.order_of_delta_j is None:
        return
    from verify.pages.figures import step_size_figures

    order = proof.order_of_delta_j
    span = f"over {interval(scene.t0, scene.time)}" if scene.time else "over all steps"
    # If ΔJ = O(h^order), Λ is O(h^(order − 1)), or O(h^order) if the leading term telescopes.
    lam_slopes = (order - 1, order) if order is not None and order > 1 else ()
    ratio_slopes = (order, order + 1) if order is not None else ()
    lam = step_size_figures.QuantityPanel(
        "|Λ|", step_size_figures.lines(runs, "lambda"), lam_slopes
    )
    ratio = step_size_figures.QuantityPanel(
        "MSE/|Λ|", step_size_figures.lines(runs, "mse", "lambda"), ratio_slopes
    )
    panels = [panel for panel in (lam, ratio) if panel.lines]
    if panels:
        slope_sentences = [_describe_measured_slopes(runs, lam_slopes)] if lam.lines else []
        yield captioned_plot(
            lambda: step_size_figures.draw_against_step_size(
                [
                    replace(panel, lines=step_size_figures.select_lines(panel.lines))
                    for panel in panels
                ]
            ),
            name=f"step-sizes-of-{name}",
            lead=f"{' and '.join(panel.title for panel in panels)} {span} against the step size h",
            caption=" ".join(
                [*map(_describe_panel, panels), *slope_sentences, describe_runs(runs)]
            ),
        )


def _describe_panel(panel: "QuantityPanel") -> str:
    """Return sentences on the trend of the panel's lines, on their number and on the guides."""
    from verify.pages.figures.step_size_figures import select_lines

    trend, drawn_count = _describe_trend(panel.lines), len(select_lines(panel.lines))
    sentences = [f"{panel.title}: {trend[0].lower()}{trend[1:]}"]
    if drawn_count < len(panel.lines):
        sentences.append(f"{drawn_count} of them are drawn, from the highest to the lowest.")
    return " ".join([*sentences, *filter(None, [_describe_guides(panel.guides)])])


def _describe_trend(plotted: Sequence["LogarithmicLine"]) -> str:
    """Return a sentence that says whether the lines rise or fall with h."""
    differences = [[b - a for (_, a), (_, b) in pairwise(line.points)] for line in plotted]
    rising = sum(all(x > 0 for x in line) for line in differences)
    falling = sum(all(x < 0 for x in line) for line in differences)
    subject = (
        "The line"
        if len(differences) == 1
        else f"Each of the {len(differences)} lines (one an initial value)"
    )
    if rising == len(differences):
        return f"{subject} rises with h."
    if falling == len(differences):
        return f"{subject} falls as h grows."
    return f"Of {len(differences)} lines (one an initial value), {rising} rise with h throughout."


def _describe_measured_slopes(runs: Sequence[RunResult], guides: Sequence[int]) -> str:
    """Return a sentence with the measured slopes and the proved bound."""
    from verify.studies.criteria_verdicts import measured_slopes

    slopes = sorted(measured_slopes("lambda", runs))
    if not slopes:
        return ""
    low, high = f"{slopes[0][0]:.2f}", f"{slopes[-1][0]:.2f}"
    measured = (
        f"The measured slope is {low}" if low == high else f"The measured slopes are {low} … {high}"
    )
    proved = f"; proved is Λ = O({_h(guides[0])}) for h → 0" if guides else ""
    return f"{measured.replace('-', '−')}{proved}."


def _describe_guides(guides: Sequence[int]) -> str:
    return f"Grey: the slopes of {' and '.join(_h(g) for g in guides)}." if guides else ""


SECTION = ReportSection(
    order=40,
    view=_view,
    takes_field=True,
    pictures=lambda plots: [Picture((0,), plots[0])],
    terms=lambda _: legend.terms_of_runs(),
    shows="runs",
    matching_plots=lambda plots, _: ((plot, "") for plot in plots),
)
