"""The worst scenes of a hunt as the page shows them: what was hunted, and a card for each scene."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import isfinite

from markupsafe import Markup

from verify.pages.figures.captioned_plot import Plot, plotted
from verify.pages.figures.logarithm import lg
from verify.pages.sections.gallery_finding import findings, in_short, lambda_of, run_beyond
from verify.pages.sections.given import Given
from verify.pages.sections.section import Entry, Picture, Place, Section, Tile
from verify.pages.text import mathml, words
from verify.pages.text.signs import SIGNS
from verify.pages.text.typography import NBSP, counted, start, step, whole
from verify.scenes.results.exploration import Gallery, GalleryScene
from verify.scenes.results.report import Report
from verify.verdict import Verdict

_TILES = 4  # scenes that are told one by one
_SHORT = 80  # characters of a formula that stands in a caption


@dataclass(frozen=True)
class CardView:
    """One scene: `title` says how bad it is."""

    result: GalleryScene
    anchor: str
    title: str
    finding: tuple[str, ...]
    plots: tuple[Plot, ...]


@dataclass(frozen=True)
class GalleryView:
    """`hunted`: of which scenes they are the worst."""

    hunted: tuple[str, ...]
    cards: tuple[CardView, ...]


def _view(given: Given) -> GalleryView | None:
    gallery = given.report.gallery
    if gallery is None or not gallery.scenes:
        return None
    cards = tuple(_card(each, n, gallery) for n, each in enumerate(gallery.scenes, start=1))
    return GalleryView(tuple(_hunted(gallery)), cards)


def _speaks(report: Report) -> tuple[str, Sequence[Tile]] | None:
    """The worst scene in a sentence, and a few of them as tiles."""
    if report.gallery is None:
        return None
    return _finding(report.gallery), _tiles(report.gallery)


def _tiles(gallery: Gallery) -> list[Tile]:
    return [
        Tile(
            Verdict.MEASURED,
            SIGNS[Verdict.MEASURED][0],
            *in_short(gallery.measure, each.value),
            meaning=f"{each.separation.scheme}, h = {each.separation.step_size}",
        )
        for each in gallery.scenes[:_TILES]
    ]


# -- sentences ------------------------------------------------------------------------------------


def _finding(gallery: Gallery) -> str:
    count = f"{counted(gallery.examples, 'scene')} of seed {gallery.seed}"
    where = f"{_within(gallery)}, {whole(gallery.steps)} steps each"
    if not gallery.scenes:
        return f"None of {count} ({where}) can be measured by the {gallery.sentence}."
    worst = gallery.scenes[0].separation
    finding = findings(gallery.measure, gallery.sentence, gallery.scenes[0].value)
    return (
        f"In the worst of {count} ({where}), {finding}: {worst.scheme} with "
        f"h{NBSP}={NBSP}{step(worst.step_size)} from {start(worst)}."
    )


def _within(gallery: Gallery) -> str:
    least, most = map(step, gallery.step_sizes)
    reach = f"|q|, |p|{NBSP}≤{NBSP}{gallery.reach}"
    return f"{reach}, h from {least} to {most}"


def _hunted(gallery: Gallery) -> Iterator[str]:
    low, high = gallery.coefficients
    yield f"Hunted for: the {gallery.sentence}."
    yield (
        "Scenes were drawn at random, those near bad ones more often, and then moved a little as "
        f"long as that made them worse: initial values with {_within(gallery)}, coefficients of H "
        f"as drawn, of size {low} to {high} where they were moved, N{NBSP}={NBSP}"
        f"{whole(gallery.steps)} steps."
    )
    yield (
        "Of scenes that are one again (H of the same shape; or about as bad by the same scheme, "
        "from the same start or with more terms) only the worst is shown, the worst of all "
        "first. What it "
        "measures was measured again with twice the digits, and is the same."
    )


def _card(each: GalleryScene, place: int, gallery: Gallery) -> CardView:
    anchor = f"worst-{place}"
    said = findings(gallery.measure, gallery.sentence, each.value)
    return CardView(
        result=each,
        anchor=anchor,
        title=f"Scene {place}: {said}",
        finding=(*lambda_of(each), *run_beyond(each), *_at_rest(each)),
        plots=tuple(_plots(each, place, gallery.steps, anchor)),
    )


def _at_rest(each: GalleryScene) -> Iterator[str]:
    if len(each.orbit) > 1 and len(set(each.orbit)) == 1:
        yield "The orbit stays where it starts."


# -- figures --------------------------------------------------------------------------------------


def _plots(each: GalleryScene, place: int, steps: int, anchor: str) -> Iterator[Plot]:
    """Truncation against rounding, which the first screen shows of the worst, and the orbit."""
    of = each.separation
    series = of.plain.series if of.plain else ()
    drawable = [at for at in series if _is_known(at.truncation) or _is_known(at.total)]
    if len(drawable) > 1:
        from verify.pages.figures import gallery_figure

        # That of the worst scene stands on the first screen, far from its card.
        formula = [_formula(of.hamiltonian)] if place == 1 else []
        yield plotted(
            lambda: gallery_figure.draw_parts(each),
            name=f"parts-of-{anchor}",
            lead=f"Scene {place}: |truncation| and |rounding| in Λ against the number of steps",
            caption=Markup(" ").join([*formula, _parts_sentence(each)]),
        )
    if len(set(each.orbit)) > 1:
        from verify.pages.figures import gallery_figure

        yield plotted(
            lambda: gallery_figure.draw_orbit(each.orbit, steps),
            name=f"orbit-of-{anchor}",
            lead=f"Scene {place}: the orbit in the (q, p) plane, {whole(steps)} steps",
            caption=_orbit_sentence(each, steps),
        )


def _formula(text: str) -> Markup:
    """H in a caption, where it is short enough for one."""
    if len(text) > _SHORT:
        return Markup("")
    return Markup("H{0}={0}{1}.").format(NBSP, mathml.formula(text))


def _parts_sentence(each: GalleryScene) -> str:
    of = each.separation
    series = of.plain.series if of.plain else ()
    said = [
        f"Λ in float64, evaluated the plain way, split after up to {whole(of.steps)} steps: what "
        "the scheme does to area, and what rounding adds."
    ]
    if any(not _is_known(size) for at in series for size in (at.truncation, at.total)):
        said.append("What is 0, or of what no digit is known, has no place on these axes.")
    said.append(f"In place of exact arithmetic: {of.arithmetic}; {of.error_method}.")
    return " ".join(said)


def _orbit_sentence(each: GalleryScene, steps: int) -> str:
    shown = len(each.orbit) - 1
    every = -(-steps // shown)
    points = "each step" if every == 1 else f"every {whole(every)} steps"
    return f"The scheme’s own orbit, a point {points}, in numbers of 40 digits."


def _is_known(size: str) -> bool:
    return isfinite(lg(size))


def _pictures(view: GalleryView) -> Iterator[Picture]:
    for card in view.cards:
        yield from (Picture((6,), plot, Place(card.anchor, card.title)) for plot in card.plots)


SECTION = Section(
    order=30,
    title="The worst scenes",
    anchor="gallery",
    view=_view,
    entries=lambda view: (Entry(card.anchor, card.title) for card in view.cards),
    pictures=_pictures,
    terms=lambda _: words.SEPARATED | words.RAN,
    speaks=_speaks,
)
