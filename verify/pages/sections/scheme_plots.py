"""The figures of a scheme's data, each with a caption: what it shows and how it was computed.

The drawing, and with it matplotlib, is imported only where something is drawn.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

from verify.pages.figures.captioned_plot import Plot, captioned_plot, describe_runs
from verify.pages.sections.claim_view import ClaimView
from verify.pages.text.typography import interval, is_decimal
from verify.pages.text.typography import power_of_h as _h
from verify.scenes.results.proof import ProofResult
from verify.scenes.results.report import SceneResult
from verify.scenes.results.run import RunResult

if TYPE_CHECKING:
    from verify.pages.figures.figures import Line, Quantity

# -- against the step size ------------------------------------------------------------------------


def against_step_size(
    runs: Sequence[RunResult], scene: SceneResult, proof: ProofResult, *, name: str
) -> Iterator[Plot]:
    """Yield the plot of |Λ| and MSE/|Λ| over h, where there are several step sizes."""
    if len({run.step_size for run in runs}) < 2 or not any("lambda" in run.values for run in runs):
        return
    from verify.pages.figures import figures

    order = proof.order_of_delta_j
    span = f"over {interval(scene.t0, scene.time)}" if scene.time else "over all steps"
    # Λ is O(h^(order − 1)) by the proof, and O(h^order) where the leading term telescopes.
    lam_slopes = (order - 1, order) if order is not None and order > 1 else ()
    ratio_slopes = (order, order + 1) if order is not None else ()
    lam = figures.Quantity("|Λ|", figures.lines(runs, "lambda"), lam_slopes)
    ratio = figures.Quantity("MSE/|Λ|", figures.lines(runs, "mse", "lambda"), ratio_slopes)
    panels = [each for each in (lam, ratio) if each.lines]
    if panels:
        bound = [_describe_slopes(runs, lam_slopes)] if lam.lines else []
        yield captioned_plot(
            lambda: figures.draw_against_step_size(
                [replace(each, lines=figures.select_lines(each.lines)) for each in panels]
            ),
            name=f"step-sizes-of-{name}",
            lead=f"{' and '.join(each.title for each in panels)} {span} against the step size h",
            caption=" ".join([*map(_describe_panel, panels), *bound, describe_runs(runs)]),
        )


def _describe_panel(panel: "Quantity") -> str:
    """Return the trend of the panel's lines, how many of them are drawn, and the guides."""
    from verify.pages.figures.figures import select_lines

    trend, drawn_count = _describe_trend(panel.lines), len(select_lines(panel.lines))
    sentences = [f"{panel.title}: {trend[0].lower()}{trend[1:]}"]
    if drawn_count < len(panel.lines):
        sentences.append(f"{drawn_count} of them are drawn, from the highest to the lowest.")
    return " ".join([*sentences, *filter(None, [_describe_guides(panel.guides)])])


def _describe_trend(plotted: Sequence["Line"]) -> str:
    """Return a sentence that says whether the lines rise or fall with h."""
    steps = [[b - a for (_, a), (_, b) in pairwise(line.points)] for line in plotted]
    rising = sum(all(s > 0 for s in line) for line in steps)
    falling = sum(all(s < 0 for s in line) for line in steps)
    subject = (
        "The line" if len(steps) == 1 else f"Each of the {len(steps)} lines (one an initial value)"
    )
    if rising == len(steps):
        return f"{subject} rises with h."
    if falling == len(steps):
        return f"{subject} falls as h grows."
    return f"Of {len(steps)} lines (one an initial value), {rising} rise with h throughout."


def _describe_slopes(runs: Sequence[RunResult], guides: Sequence[int]) -> str:
    """Return a sentence with the measured slopes and the proved bound."""
    from verify.studies.criteria import measured_slopes

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


# -- printed tables ------------------------------------------------------------------------------


def table(claim: ClaimView, *, name: str) -> Plot | None:
    """Plot lg MSE as printed and as computed; None if fewer than two step sizes can be drawn."""
    from verify.pages.figures import figures

    printed, lines = rows_of(claim)
    if len(printed.points) < 2 or not lines:
        return None
    return captioned_plot(
        lambda: figures.draw_printed_against_computed(lines, printed),
        name=name,
        lead=f"{claim.result.source}: lg MSE against the step size h, printed and computed",
        caption=_describe_gap(printed, lines),
    )


def rows_of(claim: ClaimView) -> "tuple[Line, list[Line]]":
    """Return the printed row, and the computed rows with two step sizes or more."""
    from verify.pages.figures import figures

    def line(label: str, cells: Sequence[str]) -> "Line":
        points = [
            (h, float(cell))
            for h, cell in zip(claim.step_sizes, cells, strict=True)
            if is_decimal(cell)
        ]
        return figures.Line(label.replace("-", "−"), tuple(points))

    computed = [line(row[0], row[1:]) for row in claim.computed_rows]
    printed = line(f"printed: {claim.result.source}", claim.printed_row)
    return printed, [each for each in computed if len(each.points) > 1]


def _describe_gap(printed: "Line", lines: Sequence["Line"]) -> str:
    height_by_size = dict(printed.points)
    gaps = [height_by_size[h] - y for line in lines for h, y in line.points if h in height_by_size]
    low, high = min(gaps), max(gaps)
    row = "The printed row (thick) is one row for all initial values"
    if low > 0 or high < 0:
        side = "below" if low > 0 else "above"
        least, most = sorted((abs(low), abs(high)))
        return f"{row}; what was computed lies {least:.1f} to {most:.1f} decades {side} it."
    return f"{row}; what was computed differs from it by up to {max(-low, high):.1f} decades."
