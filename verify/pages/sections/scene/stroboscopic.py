"""Orbits at multiples of a period, as the page shows them: sentences, a figure, a table."""

from collections.abc import Iterator
from dataclasses import dataclass

from markupsafe import Markup

from verify.pages.figures.captioned_plot import Plot, plotted
from verify.pages.sections.rows import Row
from verify.pages.sections.section import Picture, Place, Section
from verify.pages.text.typography import NBSP, listed, number, step, whole
from verify.scenes.results.report import SceneResult
from verify.scenes.results.stroboscopic import StroboscopicResult

_IS = f"{NBSP}={NBSP}"


@dataclass(frozen=True)
class SectionsView:
    """What one section of the scene asked for."""

    result: StroboscopicResult
    anchor: str
    title: str
    finding: str
    rows: tuple[Row, ...]
    plot: Plot


@dataclass(frozen=True)
class StroboscopicView:
    """All of them."""

    each: tuple[SectionsView, ...]

    def of(self, source: str) -> tuple[SectionsView, ...]:
        return tuple(x for x in self.each if x.result.source == source)


def _view(scene: SceneResult, anchor: str) -> StroboscopicView | None:
    if not scene.stroboscopic:
        return None
    found = (_one(result, f"strobe-{k}-of-{anchor}") for k, result in enumerate(scene.stroboscopic))
    return StroboscopicView(tuple(found))


def _one(result: StroboscopicResult, anchor: str) -> SectionsView:
    from verify.pages.figures.stroboscopic_figure import draw_sections, drawn_periods

    schemes = listed(each.scheme for each in result.sections)
    begins = "" if result.t0 is None else f", from t₀{_IS}{number(result.t0)}"
    orbits = whole(len(result.sections[0].orbits))
    lead = (
        f"{orbits} orbits by {schemes}, looked at {whole(result.periods)} times, every "
        f"{number(result.period)}{begins}; h{_IS}{step(result.step_size)}"
    )
    title = f"{orbits} orbits at multiples of T{_IS}{number(result.period)}"
    turn = " q is an angle, and drawn within one turn." * result.q_is_angle
    drawn = drawn_periods(result.sections)
    some = f" The first {whole(drawn)} periods are drawn." * (drawn < result.periods)
    said = " ".join(_finding(result))
    return SectionsView(
        result=result,
        anchor=anchor,
        title=f"{result.source}: {title}" if result.source else title,
        finding=said,
        rows=tuple(_rows(result)),
        plot=plotted(
            lambda: draw_sections(result.sections, result.q_is_angle),
            name=f"points-of-{anchor}",
            lead=lead,
            label=f"{lead}. {said}",
            caption=f"A colour an orbit; grey: what more digits do not confirm.{turn}{some}",
        ),
    )


def _finding(result: StroboscopicResult) -> Iterator[str]:
    for each in result.sections:
        lost = [o for o in each.orbits if o.known < len(o.points) - 1]
        of = f"{each.scheme}: with {whole(each.digits)} digits in {each.arithmetic}"
        if lost:
            first = min(o.known for o in lost)
            many = f"{whole(len(lost))} of {whole(len(each.orbits))} orbits"
            part = "is known for a part" if len(lost) == 1 else "are known for a part"
            yield f"{of} {many} {part} of the time alone, at least for {whole(first)} periods."
        else:
            yield f"{of} every orbit is known to its end."
        floats = min(o.in_float64 for o in each.orbits)
        if floats < result.periods:
            yield f"float64 shows another picture from period {whole(floats + 1)} on."


def _rows(result: StroboscopicResult) -> Iterator[Row]:
    for each in result.sections:
        for orbit in each.orbits:
            done = len(orbit.points) - 1
            cells = (
                number(orbit.q), number(orbit.p), whole(done), whole(orbit.known),
                whole(orbit.in_float64),
            )  # fmt: skip
            yield Row(each.scheme, cells, "it leaves every range" if orbit.left else "")


_TERMS = {
    "Stroboscopic section": Markup(
        "The states of an orbit once in each period of H, all at the same phase of the drive: "
        "points of one closed curve where the motion is regular, and a sea of points where it is "
        "chaotic."
    ),
}


def _pictures(view: StroboscopicView) -> Iterator[Picture]:
    for each in view.each:
        yield Picture((3,), each.plot, Place(each.anchor, each.title))


SECTION = Section(
    order=25,
    title="Once in each period",
    anchor="stroboscopic",
    view=_view,
    pictures=_pictures,
    terms=lambda _: _TERMS,
    shows="stroboscopic",
    drawn=lambda view, label: ((each.plot, each.finding) for each in view.of(label)),
)
