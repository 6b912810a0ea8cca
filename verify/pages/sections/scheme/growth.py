"""The growth law of Λ: log(1 + Λ) as a bounded part and a secular one, which grows with T."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from math import isfinite

from verify.pages.figures.captioned_plot import Plot, captioned_plot, lg, round_to_few_digits
from verify.pages.sections import table_rows
from verify.pages.sections.section import ReportSection
from verify.pages.text.legend import terms_of
from verify.pages.text.typography import NBSP, between, join_and, number, start, step, whole
from verify.pages.text.typography import power_of_h as _h
from verify.scenes.results.growth import AverageResult, GrowthLawResult, PredictionResult
from verify.scenes.results.proof_result import ProofResult
from verify.scenes.results.report import SceneResult


@dataclass(frozen=True)
class GrowthView:
    law: AverageResult
    finding: tuple[str, ...]
    plots: tuple[Plot, ...]
    groups: tuple[table_rows.Group, ...]
    count: int
    excerpt: str  # a sentence on the rows that are shown, if not all are
    provenance: str


def _view(scene: SceneResult, proof: ProofResult, anchor: str) -> GrowthView | None:
    laws = [growth for growth in scene.growth_laws if growth.law.scheme == proof.scheme]
    if not laws:
        return None
    return GrowthView(
        law=laws[0].law,
        finding=tuple(_finding(laws, scene.growth_explains)),
        plots=tuple(_plots(laws, anchor)),
        groups=tuple(_groups(laws)),
        count=(count := sum(len(growth.predictions) for growth in laws)),
        excerpt=table_rows.describe_excerpt(count, min(count, table_rows.MOST_ROWS)),
        provenance=_describe_provenance(laws),
    )


# -- sentences ------------------------------------------------------------------------------------


def _finding(laws: Sequence[GrowthLawResult], explains: str) -> Iterator[str]:
    averaged = [growth.law for growth in laws if growth.law.average]
    if not laws[0].law.power:
        return
    yield (
        "What stands in brackets is a difference between the two ends of the run: it is bounded "
        "whatever T is, and goes up and down with where on its orbit the run happens to end. "
        f"log(1 + Λ) grows at the rate {_h(laws[0].law.power)} ⟨g⟩, and ⟨g⟩, the time average "
        "along the exact orbit, is decided by the initial value alone."
    )
    if len(averaged) > 1:
        rates = sorted((Fraction(law.average.value) for law in averaged if law.average), key=abs)
        low, high = (_few(rate) for rate in (rates[0], rates[-1]))
        yield f"⟨g⟩ is {low} … {high} over the {len(averaged)} orbits."
    if explains:
        yield (
            f"That is the pattern in {explains}: at one h, the Λ of different initial values are "
            "as their ⟨g⟩, and only the bounded part looks irregular."
        )
    yield from _describe_agreement([p for growth in laws for p in growth.predictions])
    undecided = len(laws) - len(averaged)
    if undecided:
        have = "has" if undecided == 1 else "have"
        count = f"Of {len(laws)} initial values, {undecided}"
        yield f"{count} {have} no known average; the table says why."


def _describe_agreement(predictions: Sequence[PredictionResult]) -> Iterator[str]:
    gaps = [(abs(Fraction(p.difference.value)), p) for p in predictions if p.difference]
    if not gaps:
        return
    worst, worst_prediction = max(gaps, key=lambda gap: gap[0])
    ratio = max(gap / Fraction(p.step_size) for gap, p in gaps)
    runs = "the one run" if len(gaps) == 1 else f"the {whole(len(gaps))} runs"
    yield (
        f"Over {runs}, predicted and measured Λ differ by at most {_few(worst)} of Λ "
        f"(at h = {step(worst_prediction.step_size)}), and by at most {_few(ratio)} h of it."
    )
    shares = [share for p in predictions if (share := _bounded_share(p)) is not None]
    if shares:
        parts = between(_format_share(min(shares)), _format_share(max(shares)))
        yield f"The bounded part is {parts} as large as the secular one."


def _bounded_share(p: PredictionResult) -> Fraction | None:
    secular = abs(Fraction(p.secular.value))
    return abs(Fraction(p.boundary.value)) / secular if secular else None


def _describe_provenance(laws: Sequence[GrowthLawResult]) -> str:
    methods = dict.fromkeys(
        f"{growth.law.error_kind} ({growth.law.error_method})"
        for growth in laws
        if growth.law.average
    )
    if not methods:
        return ""
    return (
        f"⟨g⟩ by quadrature over one period of the exact flow; its error is {join_and(methods)}. "
        "The difference has no bound of its own: it is the law’s remainder."
    )


def _few(value: Fraction) -> str:
    size = float(value)
    if value and not 1e-3 <= abs(size) < 1e4:
        return number(f"{size:.2e}")
    return number(f"{size:.3g}")


def _format_share(value: Fraction) -> str:
    """Return a ratio to two digits, as per cent below 1; one of 10 or more as a whole number."""
    if value < 1:
        return f"{number(f'{float(100 * value):.2g}')}{NBSP}%"
    return f"{whole(round(value)) if value >= 10 else f'{float(value):.2g}'} times"


# -- figure ---------------------------------------------------------------------------------------


def _plots(laws: Sequence[GrowthLawResult], name: str) -> Iterator[Plot]:
    """Yield the plot of |Λ| predicted and measured, if an orbit has two step sizes to compare."""
    drawable = select_drawable(laws)
    if not drawable:
        return
    from verify.pages.figures.step_size_figures import MOST_LINES, draw_predicted_against_measured

    selected = drawable[:: -(-len(drawable) // MOST_LINES)]
    omission = f" {len(selected)} of {whole(len(drawable))} orbits are drawn." * (
        selected != drawable
    )

    lead = "Λ as the growth law predicts it and as measured, against the step size h"
    yield captioned_plot(
        lambda: draw_predicted_against_measured(selected),
        name=f"growth-of-{name}",
        lead=lead,
        label=lead,
        caption=_caption(drawable[0].law) + omission,
    )


def select_drawable(laws: Sequence[GrowthLawResult]) -> list[GrowthLawResult]:
    """Return the laws with two drawable predictions or more, without the other predictions."""
    drawable = (
        growth.model_copy(update={"predictions": _drawable_predictions(growth)}) for growth in laws
    )
    return [growth for growth in drawable if len(growth.predictions) > 1]


def _caption(law: AverageResult) -> str:
    drift_note = ""
    if law.by_potential:
        drift_note = (
            f", which for this scheme is O({_h(law.power)} T) of it: there the slope is {law.power}"
        )
    return (
        f"(a) Each line is {_h(law.power)} T ⟨g⟩ and the bounded part at the run’s own end. (b) By "
        "what they differ, as a part of the measured Λ. The law’s remainder is O(h) of the secular "
        "part (grey: the slope of h), and beyond that what the slow drift of the energy makes of "
        f"⟨g⟩{drift_note}."
    )


def _drawable_predictions(law: GrowthLawResult) -> tuple[PredictionResult, ...]:
    """Return the predictions for which a digit of Λ and of the difference is known."""
    return tuple(
        p
        for p in law.predictions
        if p.difference
        and all(isfinite(lg(v.value)) for v in (p.difference, p.predicted, p.measured))
    )


# -- table ----------------------------------------------------------------------------------------


def _groups(laws: Sequence[GrowthLawResult]) -> Iterator[table_rows.Group]:
    for growth, rows in zip(
        laws, table_rows.select_members(growth.predictions for growth in laws), strict=True
    ):
        if rows or not growth.predictions:
            yield table_rows.Group(start(growth.law), [_row(p) for p in rows], _about(growth.law))


def _about(law: AverageResult) -> str:
    if law.average is None:
        return law.reason
    period = f", P = {round_to_few_digits(law.period.value)}" if law.period else ""
    rate = round_to_few_digits(law.average.value)
    if Decimal(law.average.value) == 0 and law.average.bound != "0":
        rate = f"0 to within {number(law.average.bound)}"
    return f"{law.orbit}{period}, ⟨g⟩ = {rate}"


def _row(p: PredictionResult) -> table_rows.TableRow:
    values = (p.boundary, p.secular, p.predicted, p.measured, p.difference)
    cells = (round_to_few_digits(v.value) if v else "–" for v in values)
    return table_rows.TableRow(step(p.step_size), (whole(p.steps), *cells))


SECTION = ReportSection(
    order=60, title="Growth law of Λ", view=_view, terms=lambda _: terms_of("growth")
)
