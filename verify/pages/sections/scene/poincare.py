"""Orbits at their passes through a surface: sentences, a figure, a table."""

from fractions import Fraction

from verify.pages.figures.captioned_plot import captioned_plot
from verify.pages.sections import orbits_view
from verify.pages.sections.section import ReportSection
from verify.pages.sections.table_rows import TableRow
from verify.pages.text.legend import terms_of
from verify.pages.text.typography import IS, join_and, map_name, number, step, whole
from verify.scenes.results.orbit_points import MapSections, PoincareOrbit, PoincareResult
from verify.scenes.results.report import SceneResult


def _view(scene: SceneResult, anchor: str) -> tuple[orbits_view.OrbitsView, ...]:
    return tuple(
        _orbits_view(result, f"passes-{k}-of-{anchor}") for k, result in enumerate(scene.poincare)
    )


def _orbits_view(result: PoincareResult, anchor: str) -> orbits_view.OrbitsView:
    from verify.pages.figures import orbit_points_figure

    direction = "upwards" if result.rising else "downwards"
    orbits = whole(len(result.sections[0].orbits))
    surface_text = f"where {result.coordinate} passes {number(result.value)} {direction}"
    title = f"{orbits} orbits {surface_text}"
    lead = (
        f"{title}, by {join_and(map_name(section.map) for section in result.sections)}, "
        f"until t{IS}{number(result.time)}; h{IS}{step(result.step_size)}"
    )
    passes = max(len(o.points) for section in result.sections for o in section.orbits)
    drawn_count = orbit_points_figure.count_drawn_looks(result.sections)
    omissions = f" The first {whole(drawn_count)} passes are drawn." * (drawn_count < passes)
    outside_count = orbit_points_figure.select_points(result)[1]
    if outside_count:
        omissions += (
            f" Points far out, by orbits that escape, are not drawn: {whole(outside_count)}."
        )
    finding = " ".join(map(_finding, result.sections))
    return orbits_view.OrbitsView(
        anchor=anchor,
        title=orbits_view.title_from(result.source, title),
        finding=finding,
        rows=tuple(
            TableRow(section.map, _cells(o), orbits_view.describe_escape(o))
            for section in result.sections
            for o in section.orbits
        ),
        plot=captioned_plot(
            lambda: orbit_points_figure.draw_passes(result),
            name=f"points-of-{anchor}",
            lead=lead,
            label=f"{lead}. {finding}",
            caption=(
                "A colour an orbit, the same in all panels; grey: what a second reckoning does "
                "not confirm. Points of one curve: regular motion; scattered ones: "
                f"chaos.{omissions}"
            ),
        ),
    )


def _finding(sections: MapSections) -> str:
    """Return a sentence on the part of the map's orbits that is known, and on its error."""
    orbits = sections.orbits
    partly_known = [o for o in orbits if o.known < len(o.points)]
    error = max((o.error for o in orbits), key=Fraction)
    sentence = f"With {whole(sections.digits)} digits in {sections.arithmetic}, "
    sentence += f"by {map_name(sections.map)},"
    accuracy = f"within {number(error)} (estimated, by a second reckoning)"
    if not partly_known:
        return f"{sentence} every point is known {accuracy}."
    part = orbits_view.describe_partly_known(orbits, partly_known, "passes")
    return f"{sentence} {part}; what is known is so {accuracy}."


def _cells(orbit: PoincareOrbit) -> tuple[str, ...]:
    q, p = (", ".join(map(number, values)) for values in (orbit.q, orbit.p))
    counts = whole(len(orbit.points)), whole(orbit.known)
    return q, p, number(orbit.energy), *counts, number(orbit.error)


SECTION = ReportSection(
    order=26,
    title="Where orbits pass a surface",
    anchor="poincare",
    view=_view,
    pictures=lambda views: orbits_view.pictures(views, 3),
    terms=lambda _: terms_of("poincare"),
)
