"""What orbits do over two of their initial values, as the page shows it: sentences and a figure."""

from collections.abc import Iterator, Sequence
from fractions import Fraction

from markupsafe import Markup

from verify.arithmetic.exact import short
from verify.pages.figures.captioned_plot import plotted
from verify.pages.sections.by_key import by_key
from verify.pages.sections.orbits_view import OrbitsView, pictures
from verify.pages.sections.rows import Row
from verify.pages.sections.section import Section
from verify.pages.text.typography import IS, listed, number, step, whole
from verify.scenes.results.report import SceneResult
from verify.scenes.results.stability import OrbitKind, OrbitMapResult


def _view(scene: SceneResult, anchor: str) -> tuple[OrbitsView, ...]:
    together = by_key(
        scene.orbit_maps,
        lambda m: (m.axes, m.across, m.upwards, m.q, m.p, m.step_size, m.steps, m.beyond),
    )
    return tuple(_one(of, f"starts-{k}-of-{anchor}") for k, of in enumerate(together.values()))


def _one(maps: Sequence[OrbitMapResult], anchor: str) -> OrbitsView:
    from verify.pages.figures.orbit_map_figure import draw_orbit_maps

    over = maps[0]
    axes = " and ".join(over.axes)
    cells = whole(len(over.across) * len(over.upwards))
    title = f"{cells} orbits over {axes}"
    time = short(Fraction(over.step_size) * over.steps)
    names = listed(m.scheme for m in maps)
    lead = f"{title}, by {names}, until t{IS}{number(time)}; h{IS}{step(over.step_size)}"
    counts = "; ".join(f"{m.scheme}: {_counts(m)}" for m in maps)
    rest = ", ".join(f"{name}{IS}{number(x)}" for name, x in _others(over))
    lines = " Grey lines: the same energy H." if _has_energies(over) else ""
    return OrbitsView(
        anchor=anchor,
        title=title,
        finding=" ".join(map(_energy_finding, maps)),
        rows=tuple(_row(m, kind) for m in maps for kind in m.counted()),
        plot=plotted(
            lambda: draw_orbit_maps(maps),
            name=f"orbits-of-{anchor}",
            lead=lead,
            label=f"{lead}. {counts}.",
            caption=(
                f"Each mark is an orbit in float64{', with ' + rest if rest else ''}. It leaves "
                f"where a coordinate is beyond ±{number(over.beyond)}.{lines}"
            ),
        ),
    )


def _counts(over: OrbitMapResult) -> str:
    return listed(f"{whole(n)} {kind}" for kind, n in over.counted().items())


def _others(over: OrbitMapResult) -> Iterator[tuple[str, str]]:
    """The initial values that are the same for all."""
    for letter, values in (("q", over.q), ("p", over.p)):
        if isinstance(values, tuple):
            for k, x in enumerate(values, start=1):
                if f"{letter}{k}" not in over.axes:
                    yield f"{letter}{k}", x


def _has_energies(over: OrbitMapResult) -> bool:
    return all(x is not None for row in over.energies for x in row)


def _energy_finding(over: OrbitMapResult) -> str:
    """Which energies leave, and which stay."""
    found: dict[bool, list[Fraction]] = {True: [], False: []}
    for i, j in over.places():
        energy = over.energies[i][j]
        if energy is not None:
            found[over.kinds[i][j] == "leaves"].append(Fraction(energy))
    leave, stay = found[True], found[False]
    if not leave:
        return f"By {over.scheme} none leaves."
    if not stay:
        return f"By {over.scheme} all leave."
    least, most = (number(short(x)) for x in (min(leave), max(stay)))
    return (
        f"By {over.scheme} the lowest energy that leaves is {least}, the highest that stays {most}."
    )


def _row(over: OrbitMapResult, kind: OrbitKind) -> Row:
    """How many are of one kind, their greatest rate and W, and from when on they leave."""
    own = [(i, j) for i, j in over.places() if over.kinds[i][j] == kind]
    rates, defects = (
        [x for i, j in own if (x := rows[i][j]) is not None]
        for rows in (over.lyapunov, over.defects)
    )
    left = [seen for i, j in own if (seen := over.left[i][j]) is not None]
    cells = (
        kind,
        whole(len(own)),
        number(max(rates, key=Fraction)) if rates else "–",
        number(max(defects, key=Fraction)) if defects else "–",
        whole(min(left)) if left else "–",
    )
    return Row(over.scheme, cells)


_TERMS = {
    "Orbits over two initial values": Markup(
        "<em>Regular</em>: a neighbour parts no faster than a power of t, over the time that was "
        "looked at. <em>Sensitive</em>: it parts exponentially, as in chaos or near an unstable "
        "orbit. <em>Undecided</em>: the time does not tell, or H is not defined there. "
        "<em>Leaves</em>: a coordinate goes beyond the bound. All of it is of the scheme’s own map "
        "in float64, measured: where an orbit is sensitive, rounding decides when it leaves, and "
        "W, the symplectic defect of all steps, grows like the square of the tangent map, which is "
        "not the scheme’s fault."
    )
}


SECTION = Section(
    order=31,
    title="Orbits over two initial values",
    anchor="orbit-map",
    view=_view,
    pictures=lambda views: pictures(views, 2),
    terms=lambda _: _TERMS,
)
