"""The kinds of orbits over two of their initial values: sentences and a figure."""

from collections.abc import Iterator, Sequence
from fractions import Fraction

from verify.arithmetic.exact import short
from verify.pages.figures.captioned_plot import captioned_plot
from verify.pages.sections.orbits_view import OrbitsView, pictures
from verify.pages.sections.section import ReportSection
from verify.pages.sections.table_rows import TableRow, by_key
from verify.pages.text.legend import terms_of
from verify.pages.text.typography import IS, join_and, number, step, whole
from verify.scenes.results.report import SceneResult
from verify.scenes.results.stability import OrbitKind, OrbitMapResult


def _view(scene: SceneResult, anchor: str) -> tuple[OrbitsView, ...]:
    groups = by_key(
        scene.orbit_maps,
        lambda m: (m.axes, m.across, m.upwards, m.q, m.p, m.step_size, m.steps, m.beyond),
    )
    return tuple(
        _orbits_view(maps, f"starts-{k}-of-{anchor}") for k, maps in enumerate(groups.values())
    )


def _orbits_view(maps: Sequence[OrbitMapResult], anchor: str) -> OrbitsView:
    from verify.pages.figures.kind_map_figure import draw_orbit_maps

    first_map = maps[0]
    axes = " and ".join(first_map.axes)
    cells = whole(len(first_map.across) * len(first_map.upwards))
    title = f"{cells} orbits over {axes}"
    time = short(Fraction(first_map.step_size) * first_map.steps)
    names = join_and(m.scheme_title for m in maps)
    lead = f"{title}, by {names}, until t{IS}{number(time)}; h{IS}{step(first_map.step_size)}"
    counts = "; ".join(f"{m.scheme_title}: {_counts(m)}" for m in maps)
    texts = [f"{name}{IS}{number(x)}" for name, x in _fixed_values(first_map)]
    fixed = f", with {', '.join(texts)}" if texts else ""
    has_energies = all(x is not None for row in first_map.energies for x in row)
    line_note = " Grey lines: the same energy H." if has_energies else ""
    return OrbitsView(
        anchor=anchor,
        title=title,
        finding=" ".join(map(_energy_finding, maps)),
        rows=tuple(_row(m, kind) for m in maps for kind in m.counted()),
        plot=captioned_plot(
            lambda: draw_orbit_maps(maps),
            name=f"orbits-of-{anchor}",
            lead=lead,
            label=f"{lead}. {counts}.",
            caption=(
                f"Each mark is an orbit in float64{fixed}. It leaves "
                f"where a coordinate is beyond ±{number(first_map.beyond)}.{line_note}"
            ),
        ),
    )


def _counts(orbit_map: OrbitMapResult) -> str:
    return join_and(f"{whole(n)} {kind}" for kind, n in orbit_map.counted().items())


def _fixed_values(orbit_map: OrbitMapResult) -> Iterator[tuple[str, str]]:
    """Yield the names and values of the coordinates in which all orbits begin alike."""
    for letter, values in (("q", orbit_map.q), ("p", orbit_map.p)):
        if isinstance(values, tuple):
            for k, x in enumerate(values, start=1):
                if f"{letter}{k}" not in orbit_map.axes:
                    yield f"{letter}{k}", x


def _energy_finding(orbit_map: OrbitMapResult) -> str:
    """Return a sentence on the energies of orbits that leave and of those that stay."""
    energies: dict[bool, list[Fraction]] = {True: [], False: []}
    for i, j in orbit_map.places():
        energy = orbit_map.energies[i][j]
        if energy is not None:
            energies[orbit_map.kinds[i][j] == "leaves"].append(Fraction(energy))
    leave, stay = energies[True], energies[False]
    if not leave:
        return f"By {orbit_map.scheme_title} none leaves."
    if not stay:
        return f"By {orbit_map.scheme_title} all leave."
    least_leaving, most_staying = (number(short(x)) for x in (min(leave), max(stay)))
    return (
        f"By {orbit_map.scheme_title} the lowest energy that leaves is {least_leaving}, the "
        f"highest that stays {most_staying}."
    )


def _row(orbit_map: OrbitMapResult, kind: OrbitKind) -> TableRow:
    """Return the row of a kind: the number of orbits, the greatest rate and W, the first exit."""
    cells = [(i, j) for i, j in orbit_map.places() if orbit_map.kinds[i][j] == kind]
    rates, defects = (
        [x for i, j in cells if (x := rows[i][j]) is not None]
        for rows in (orbit_map.lyapunov, orbit_map.defects)
    )
    leaving_steps = [
        first_step for i, j in cells if (first_step := orbit_map.left[i][j]) is not None
    ]
    entries = (
        kind,
        whole(len(cells)),
        number(max(rates, key=Fraction)) if rates else "–",
        number(max(defects, key=Fraction)) if defects else "–",
        whole(min(leaving_steps)) if leaving_steps else "–",
    )
    return TableRow(orbit_map.scheme_title, entries)


SECTION = ReportSection(
    order=31,
    title="Orbits over two initial values",
    anchor="orbit-map",
    view=_view,
    pictures=lambda views: pictures(views, 2),
    terms=lambda _: terms_of("orbit-map"),
)
