"""Orbits at multiples of a period: sentences, a figure, a table."""

from collections.abc import Iterator

from verify.pages.figures.captioned_plot import captioned_plot
from verify.pages.sections import orbits_view
from verify.pages.sections.section import ReportSection
from verify.pages.sections.table_rows import TableRow
from verify.pages.text.legend import terms_of
from verify.pages.text.typography import IS, join_and, number, step, whole
from verify.scenes.results.orbit_points import StroboscopicResult
from verify.scenes.results.report import SceneResult


def _view(scene: SceneResult, anchor: str) -> tuple[orbits_view.OrbitsView, ...]:
    results = enumerate(scene.stroboscopic)
    return tuple(_orbits_view(result, f"strobe-{k}-of-{anchor}") for k, result in results)


def _orbits_view(result: StroboscopicResult, anchor: str) -> orbits_view.OrbitsView:
    from verify.pages.figures.orbit_points_figure import count_drawn_looks, draw_periods

    schemes = join_and(section.scheme_title for section in result.sections)
    start_note = "" if result.t0 is None else f", from t₀{IS}{number(result.t0)}"
    orbits = whole(len(result.sections[0].orbits))
    lead = (
        f"{orbits} orbits by {schemes}, looked at {whole(result.periods)} times, every "
        f"{number(result.period)}{start_note}; h{IS}{step(result.step_size)}"
    )
    title = f"{orbits} orbits at multiples of T{IS}{number(result.period)}"
    angle_note = " q is an angle, and drawn within one turn." * result.q_is_angle
    drawn_count = count_drawn_looks(result.sections, 1)
    omission = f" The first {whole(drawn_count)} periods are drawn." * (
        drawn_count < result.periods
    )
    finding = " ".join(_finding(result))
    return orbits_view.OrbitsView(
        anchor=anchor,
        title=orbits_view.title_from(result.source, title),
        finding=finding,
        rows=tuple(_rows(result)),
        plot=captioned_plot(
            lambda: draw_periods(result),
            name=f"points-of-{anchor}",
            lead=lead,
            label=f"{lead}. {finding}",
            caption="A colour an orbit; grey: what more digits do not confirm."
            + angle_note
            + omission,
        ),
        source=result.source,
    )


def _finding(result: StroboscopicResult) -> Iterator[str]:
    for section in result.sections:
        partly_known = [o for o in section.orbits if o.known < len(o.points) - 1]
        source = (
            f"{section.scheme_title}: with {whole(section.digits)} digits in {section.arithmetic}"
        )
        if partly_known:
            part = orbits_view.describe_partly_known(section.orbits, partly_known, "periods")
            yield f"{source} {part}."
        else:
            yield f"{source} every orbit is known to its end."
        known_in_float64 = min(o.in_float64 for o in section.orbits)
        if known_in_float64 < result.periods:
            yield f"float64 shows another picture from period {whole(known_in_float64 + 1)} on."


def _rows(result: StroboscopicResult) -> Iterator[TableRow]:
    for section in result.sections:
        for orbit in section.orbits:
            period_count = len(orbit.points) - 1  # the first point is the initial state
            cells = (
                number(orbit.q), number(orbit.p), whole(period_count), whole(orbit.known),
                whole(orbit.in_float64),
            )  # fmt: skip
            yield TableRow(section.scheme_title, cells, orbits_view.describe_escape(orbit))


SECTION = ReportSection(
    order=25,
    title="Once in each period",
    anchor="stroboscopic",
    view=_view,
    pictures=lambda views: orbits_view.pictures(views, 3),
    terms=lambda _: terms_of("stroboscopic"),
    shows="stroboscopic",
    matching_plots=lambda views, label: ((x.plot, x.finding) for x in views if x.source == label),
)
