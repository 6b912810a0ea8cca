"""The growth law of Λ as the page shows it: sentences, a figure and a table, all from the data."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from math import isfinite

from markupsafe import Markup

from verify.pages.figures.captioned_plot import Plot, few, plotted
from verify.pages.figures.logarithm import lg
from verify.pages.sections.rows import MOST_ROWS, Group, Row, shown, told
from verify.pages.sections.section import Section
from verify.pages.text.typography import NBSP, between, listed, number, start, step, whole
from verify.pages.text.typography import power_of_h as _h
from verify.scenes.results.growth import AverageResult, GrowthLawResult, PredictionResult
from verify.scenes.results.proof import ProofResult
from verify.scenes.results.report import SceneResult


@dataclass(frozen=True)
class GrowthView:
    law: AverageResult
    finding: tuple[str, ...]
    plots: tuple[Plot, ...]
    groups: tuple[Group, ...]
    count: int
    told: str  # which of them are shown, where not all are
    computed: str


def _view(scene: SceneResult, proof: ProofResult, anchor: str) -> GrowthView | None:
    laws = [each for each in scene.growth_laws if each.law.scheme == proof.scheme]
    if not laws:
        return None
    return GrowthView(
        law=laws[0].law,
        finding=tuple(_finding(laws, scene.growth_explains)),
        plots=tuple(_plots(laws, anchor)),
        groups=tuple(_groups(laws)),
        count=(count := sum(len(each.predictions) for each in laws)),
        told=told(count, min(count, MOST_ROWS)),
        computed=_computed(laws),
    )


# -- sentences ------------------------------------------------------------------------------------


def _finding(laws: Sequence[GrowthLawResult], explains: str) -> Iterator[str]:
    known = [each.law for each in laws if each.law.average]
    if not laws[0].law.power:
        return
    yield (
        "What stands in brackets is a difference between the two ends of the run: it is bounded "
        "whatever T is, and goes up and down with where on its orbit the run happens to end. "
        f"log(1 + Λ) grows at the rate {_h(laws[0].law.power)} ⟨g⟩, and ⟨g⟩, the time average "
        "along the exact orbit, is decided by the initial value alone."
    )
    if len(known) > 1:
        rates = sorted((Fraction(law.average.value) for law in known if law.average), key=abs)
        low, high = (_few(rate) for rate in (rates[0], rates[-1]))
        yield f"⟨g⟩ is {low} … {high} over the {len(known)} orbits."
    if explains:
        yield (
            f"That is the pattern in {explains}: at one h, the Λ of different initial values are "
            "as their ⟨g⟩, and only the bounded part looks irregular."
        )
    yield from _agreement([p for each in laws for p in each.predictions])
    unknown = len(laws) - len(known)
    if unknown:
        have = "has" if unknown == 1 else "have"
        count = f"Of {len(laws)} initial values, {unknown}"
        yield f"{count} {have} no known average; the table says why."


def _agreement(found: Sequence[PredictionResult]) -> Iterator[str]:
    gaps = [(abs(Fraction(p.difference.value)), p) for p in found if p.difference]
    if not gaps:
        return
    worst, at = max(gaps, key=lambda gap: gap[0])
    ratio = max(gap / Fraction(p.step_size) for gap, p in gaps)
    runs = "the one run" if len(gaps) == 1 else f"the {whole(len(gaps))} runs"
    yield (
        f"Over {runs}, predicted and measured Λ differ by at most {_few(worst)} of Λ "
        f"(at h = {step(at.step_size)}), and by at most {_few(ratio)} h of it."
    )
    shares = [share for p in found if (share := _share(p)) is not None]
    if shares:
        parts = between(_part(min(shares)), _part(max(shares)))
        yield f"The bounded part is {parts} as large as the secular one."


def _share(p: PredictionResult) -> Fraction | None:
    secular = abs(Fraction(p.secular.value))
    return abs(Fraction(p.boundary.value)) / secular if secular else None


def _computed(laws: Sequence[GrowthLawResult]) -> str:
    methods = dict.fromkeys(
        f"{each.law.error_kind} ({each.law.error_method})" for each in laws if each.law.average
    )
    if not methods:
        return ""
    return (
        f"⟨g⟩ by quadrature over one period of the exact flow; its error is {listed(methods)}. "
        "The difference has no bound of its own: it is the law’s remainder."
    )


def _few(value: Fraction) -> str:
    size = float(value)
    if value and not 1e-3 <= abs(size) < 1e4:
        return number(f"{size:.2e}")
    return number(f"{size:.3g}")


def _part(value: Fraction) -> str:
    """Two digits: per cent of what is smaller than the whole, else how many times the whole."""
    if value < 1:
        return f"{number(f'{float(100 * value):.2g}')}{NBSP}%"
    return f"{whole(round(value)) if value >= 10 else f'{float(value):.2g}'} times"


# -- figure ---------------------------------------------------------------------------------------


def _plots(laws: Sequence[GrowthLawResult], name: str) -> Iterator[Plot]:
    """|Λ| predicted and measured, where there are step sizes to compare."""
    drawable = orbits(laws)
    if not drawable:
        return
    from verify.pages.figures.figures import MOST_LINES
    from verify.pages.figures.growth_figure import draw_predicted_against_measured

    drawn = drawable[:: -(-len(drawable) // MOST_LINES)]
    left = f" {len(drawn)} of {whole(len(drawable))} orbits are drawn." * (drawn != drawable)

    lead = "Λ as the growth law predicts it and as measured, against the step size h"
    yield plotted(
        lambda: draw_predicted_against_measured(drawn),
        name=f"growth-of-{name}",
        lead=lead,
        label=lead,
        caption=_caption(drawable[0].law) + left,
    )


def orbits(laws: Sequence[GrowthLawResult]) -> list[GrowthLawResult]:
    """Those along which two step sizes and more can be drawn, with these predictions alone."""
    found = (each.model_copy(update={"predictions": _known(each)}) for each in laws)
    return [each for each in found if len(each.predictions) > 1]


def _caption(law: AverageResult) -> str:
    drift = ""
    if law.by_potential:
        drift = (
            f", which for this scheme is O({_h(law.power)} T) of it: there the slope is {law.power}"
        )
    return (
        f"(a) Each line is {_h(law.power)} T ⟨g⟩ and the bounded part at the run’s own end. (b) By "
        "what they differ, as a part of the measured Λ. The law’s remainder is O(h) of the secular "
        "part (grey: the slope of h), and beyond that what the slow drift of the energy makes of "
        f"⟨g⟩{drift}."
    )


def _known(each: GrowthLawResult) -> tuple[PredictionResult, ...]:
    """Those of whose Λ and difference a digit is known."""
    return tuple(
        p
        for p in each.predictions
        if p.difference
        and all(isfinite(lg(v.value)) for v in (p.difference, p.predicted, p.measured))
    )


# -- table ----------------------------------------------------------------------------------------


def _groups(laws: Sequence[GrowthLawResult]) -> Iterator[Group]:
    for each, rows in zip(laws, shown(each.predictions for each in laws), strict=True):
        if rows or not each.predictions:
            yield Group(start(each.law), [_row(p) for p in rows], _about(each.law))


def _about(law: AverageResult) -> str:
    if law.average is None:
        return law.reason
    period = f", P = {few(law.period.value)}" if law.period else ""
    rate = few(law.average.value)
    if Decimal(law.average.value) == 0 and law.average.bound != "0":
        rate = f"0 to within {number(law.average.bound)}"
    return f"{law.orbit}{period}, ⟨g⟩ = {rate}"


def _row(p: PredictionResult) -> Row:
    values = (p.boundary, p.secular, p.predicted, p.measured, p.difference)
    cells = (few(v.value) if v else "–" for v in values)
    return Row(step(p.step_size), (whole(p.steps), *cells))


_TERMS = {
    "Growth law": Markup(
        "log(1 + Λ) as a bounded part, a secular part that grows with T, and a remainder of proved "
        "order. X is the derivative along the exact flow; [F] is F at the end of the run minus F "
        "at its start; X G is the leading coefficient of ΔJ; ⟨g⟩ is the time average of g along "
        "the exact orbit, and B the bounded rest, X B = g − ⟨g⟩."
    )
}
SECTION = Section(order=60, title="Growth law of Λ", view=_view, terms=lambda _: _TERMS)
