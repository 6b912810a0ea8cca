"""Which figures a scene's data asks for, each with a caption: what to see and how it was computed.

The drawing, and with it matplotlib, is imported only where something is drawn.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

from verify.pages.figures.captioned_plot import Plot, computed, plotted
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
    """|Λ| and MSE/|Λ| over h, where there are step sizes to compare and values to show."""
    if len({run.step_size for run in runs}) < 2 or not any("lambda" in run.values for run in runs):
        return
    from verify.pages.figures import figures

    order = proof.order_of_delta_j
    span = f"over {interval(scene.t0, scene.time)}" if scene.time else "over all steps"
    of_lam = (order - 1, order) if order is not None and order > 1 else ()
    of_ratio = (order, order + 1) if order is not None else ()
    lam = figures.Quantity("|Λ|", figures.lines(runs, "lambda"), of_lam)
    ratio = figures.Quantity("MSE/|Λ|", figures.lines(runs, "mse", "lambda"), of_ratio)
    shown = [each for each in (lam, ratio) if each.lines]
    if shown:
        bound = [_bound(runs, of_lam)] if lam.lines else []
        yield plotted(
            lambda: figures.draw_against_step_size(
                [replace(each, lines=figures.thinned(each.lines)) for each in shown]
            ),
            name=f"step-sizes-of-{name}",
            lead=f"{' and '.join(each.title for each in shown)} {span} against the step size h",
            caption=" ".join([*map(_told, shown), *bound, computed(runs)]),
        )


def _told(shown: "Quantity") -> str:
    """What its lines do, which of them are drawn, and which guides stand beside them."""
    from verify.pages.figures.figures import thinned

    trend, drawn = _trend(shown.lines), len(thinned(shown.lines))
    told = [f"{shown.title}: {trend[0].lower()}{trend[1:]}"]
    if drawn < len(shown.lines):
        told.append(f"{drawn} of them are drawn, from the highest to the lowest.")
    return " ".join([*told, *filter(None, [_guides(shown.guides)])])


def _trend(plotted: Sequence["Line"]) -> str:
    """What the lines do, as they are drawn."""
    steps = [[b - a for (_, a), (_, b) in pairwise(line.points)] for line in plotted]
    rising = sum(all(s > 0 for s in line) for line in steps)
    falling = sum(all(s < 0 for s in line) for line in steps)
    every = (
        "The line" if len(steps) == 1 else f"Each of the {len(steps)} lines (one an initial value)"
    )
    if rising == len(steps):
        return f"{every} rises with h."
    if falling == len(steps):
        return f"{every} falls as h grows."
    return f"Of {len(steps)} lines (one an initial value), {rising} rise with h throughout."


def _bound(runs: Sequence[RunResult], guides: Sequence[int]) -> str:
    """The measured slopes beside the proved bound."""
    from verify.studies.criteria import measured_slopes

    slopes = sorted(measured_slopes("lambda", runs))
    if not slopes:
        return ""
    low, high = f"{slopes[0][0]:.2f}", f"{slopes[-1][0]:.2f}"
    seen = (
        f"The measured slope is {low}" if low == high else f"The measured slopes are {low} … {high}"
    )
    proved = f"; proved is Λ = O({_h(guides[0])}) for h → 0" if guides else ""
    return f"{seen.replace('-', '−')}{proved}."


def _guides(guides: Sequence[int]) -> str:
    return f"Grey: the slopes of {' and '.join(_h(g) for g in guides)}." if guides else ""


# -- printed tables ------------------------------------------------------------------------------


def table(claim: ClaimView, *, name: str) -> Plot | None:
    """lg MSE as printed and as computed; None where fewer than two step sizes can be drawn."""
    from verify.pages.figures import figures

    printed, lines = rows_of(claim)
    if len(printed.points) < 2 or not lines:
        return None
    return plotted(
        lambda: figures.draw_printed_against_computed(lines, printed),
        name=name,
        lead=f"{claim.result.source}: lg MSE against the step size h, printed and computed",
        caption=_gap(printed, lines),
    )


def rows_of(claim: ClaimView) -> "tuple[Line, list[Line]]":
    """The printed row, and the computed ones of which two step sizes and more can be drawn."""
    from verify.pages.figures import figures

    def line(label: str, cells: Sequence[str]) -> "Line":
        known = [
            (h, float(cell))
            for h, cell in zip(claim.step_sizes, cells, strict=True)
            if is_decimal(cell)
        ]
        return figures.Line(label.replace("-", "−"), tuple(known))

    computed = [line(row[0], row[1:]) for row in claim.computed]
    printed = line(f"printed: {claim.result.source}", claim.printed)
    return printed, [each for each in computed if len(each.points) > 1]


def _gap(printed: "Line", lines: Sequence["Line"]) -> str:
    at = dict(printed.points)
    gaps = [at[h] - y for line in lines for h, y in line.points if h in at]
    low, high = min(gaps), max(gaps)
    row = "The printed row (thick) is one row for all initial values"
    if low > 0 or high < 0:
        side = "below" if low > 0 else "above"
        least, most = sorted((abs(low), abs(high)))
        return f"{row}; what was computed lies {least:.1f} to {most:.1f} decades {side} it."
    return f"{row}; what was computed differs from it by up to {max(-low, high):.1f} decades."
