"""The worst scenes of a hunt: what was searched for, and a card for each scene."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import isfinite

from markupsafe import Markup

from verify.pages.figures.captioned_plot import Plot, captioned_plot, lg
from verify.pages.sections.gallery_finding import (
    describe_lambda,
    describe_longer_run,
    findings,
    short_value,
)
from verify.pages.sections.page_contents import PageContents
from verify.pages.sections.section import ContentsEntry, Picture, ReportSection, SectionPlace, Tile
from verify.pages.text import legend, mathml
from verify.pages.text.legend import SIGNS
from verify.pages.text.typography import NBSP, count_noun, start, step, whole
from verify.scenes.results.exploration import Gallery, GalleryScene
from verify.scenes.results.report import Report
from verify.verdict import Verdict

# The number of worst scenes that have a tile on the first screen.
_TILES = 4
# Characters of a formula that fits in a caption.
_SHORT = 80


@dataclass(frozen=True)
class CardView:
    """One scene; `title` says how bad it is."""

    result: GalleryScene
    anchor: str
    title: str
    finding: tuple[str, ...]
    plots: tuple[Plot, ...]


@dataclass(frozen=True)
class GalleryView:
    """The gallery; `search_sentences` say among which scenes these are the worst."""

    search_sentences: tuple[str, ...]
    cards: tuple[CardView, ...]


def _view(contents: PageContents) -> GalleryView | None:
    gallery = contents.report.gallery
    if gallery is None or not gallery.scenes:
        return None
    cards = tuple(_card(scene, n, gallery) for n, scene in enumerate(gallery.scenes, start=1))
    return GalleryView(tuple(_describe_hunt(gallery)), cards)


def _lead_sentence_and_tiles(report: Report) -> tuple[str, Sequence[Tile]] | None:
    """Return the worst scene in a sentence, and a few of the worst as tiles."""
    if report.gallery is None:
        return None
    return _finding(report.gallery), _tiles(report.gallery)


def _tiles(gallery: Gallery) -> list[Tile]:
    return [
        Tile(
            Verdict.MEASURED,
            SIGNS[Verdict.MEASURED][0],
            *short_value(gallery.measure, scene.value),
            meaning=f"{scene.separation.scheme_title}, h = {scene.separation.step_size}",
        )
        for scene in gallery.scenes[:_TILES]
    ]


# -- sentences ------------------------------------------------------------------------------------


def _finding(gallery: Gallery) -> str:
    count = f"{count_noun(gallery.examples, 'scene')} of seed {gallery.seed}"
    search_text = f"{_describe_ranges(gallery)}, {whole(gallery.steps)} steps each"
    if not gallery.scenes:
        return f"None of {count} ({search_text}) can be measured by the {gallery.sentence}."
    worst = gallery.scenes[0].separation
    finding = findings(gallery.measure, gallery.sentence, gallery.scenes[0].value)
    return (
        f"In the worst of {count} ({search_text}), {finding}: {worst.scheme_title} with "
        f"h{NBSP}={NBSP}{step(worst.step_size)} from {start(worst)}."
    )


def _describe_ranges(gallery: Gallery) -> str:
    least, most = map(step, gallery.step_sizes)
    reach = f"|q|, |p|{NBSP}≤{NBSP}{gallery.reach}"
    return f"{reach}, h from {least} to {most}"


def _describe_hunt(gallery: Gallery) -> Iterator[str]:
    low, high = gallery.coefficients
    yield f"Hunted for: the {gallery.sentence}."
    yield (
        "Scenes were drawn at random, those near bad ones more often, and then moved a little as "
        f"long as that made them worse: initial values with {_describe_ranges(gallery)}, "
        f"coefficients of H as drawn, of size {low} to {high} where they were moved, N{NBSP}={NBSP}"
        f"{whole(gallery.steps)} steps."
    )
    yield (
        "Of scenes that are one again (H of the same shape; or about as bad by the same scheme, "
        "from the same start or with more terms) only the worst is shown, the worst of all "
        "first. What it "
        "measures was measured again with twice the digits, and is the same."
    )


def _card(scene: GalleryScene, rank: int, gallery: Gallery) -> CardView:
    anchor = f"worst-{rank}"
    finding = findings(gallery.measure, gallery.sentence, scene.value)
    return CardView(
        result=scene,
        anchor=anchor,
        title=f"Scene {rank}: {finding}",
        finding=(*describe_lambda(scene), *describe_longer_run(scene), *_describe_rest(scene)),
        plots=tuple(_plots(scene, rank, gallery.steps, anchor)),
    )


def _describe_rest(scene: GalleryScene) -> Iterator[str]:
    if len(scene.orbit) > 1 and len(set(scene.orbit)) == 1:
        yield "The orbit stays where it starts."


# -- figures --------------------------------------------------------------------------------------


def _plots(scene: GalleryScene, rank: int, steps: int, anchor: str) -> Iterator[Plot]:
    """Yield the plots of truncation against rounding and of the orbit."""
    separation = scene.separation
    series = separation.plain.series if separation.plain else ()
    drawable = [point for point in series if _is_known(point.truncation) or _is_known(point.total)]
    if len(drawable) > 1:
        from verify.pages.figures import gallery_figure

        # That of the worst scene stands on the first screen, far from its card.
        formula = [_formula(separation.hamiltonian)] if rank == 1 else []
        yield captioned_plot(
            lambda: gallery_figure.draw_parts(scene),
            name=f"parts-of-{anchor}",
            lead=f"Scene {rank}: |truncation| and |rounding| in Λ against the number of steps",
            caption=Markup(" ").join([*formula, _parts_sentence(scene)]),
        )
    if len(set(scene.orbit)) > 1:
        from verify.pages.figures import gallery_figure

        yield captioned_plot(
            lambda: gallery_figure.draw_orbit(scene.orbit, steps),
            name=f"orbit-of-{anchor}",
            lead=f"Scene {rank}: the orbit in the (q, p) plane, {whole(steps)} steps",
            caption=_orbit_sentence(scene, steps),
        )


def _formula(text: str) -> Markup:
    """Return H for a caption, or "" if it is too long."""
    if len(text) > _SHORT:
        return Markup("")
    return Markup("H{0}={0}{1}.").format(NBSP, mathml.formula(text))


def _parts_sentence(scene: GalleryScene) -> str:
    separation = scene.separation
    series = separation.plain.series if separation.plain else ()
    sentences = [
        f"Λ in float64, evaluated the plain way, split after up to {whole(separation.steps)} "
        "steps: what the scheme does to area, and what rounding adds."
    ]
    if any(not _is_known(size) for point in series for size in (point.truncation, point.total)):
        sentences.append("What is 0, or of what no digit is known, has no place on these axes.")
    sentences.append(
        f"In place of exact arithmetic: {separation.arithmetic}; {separation.error_method}."
    )
    return " ".join(sentences)


def _orbit_sentence(scene: GalleryScene, steps: int) -> str:
    intervals = len(scene.orbit) - 1
    every = -(-steps // intervals)
    points = "each step" if every == 1 else f"every {whole(every)} steps"
    return f"The scheme’s own orbit, a point {points}, in numbers of 40 digits."


def _is_known(size: str) -> bool:
    return isfinite(lg(size))


def _pictures(view: GalleryView) -> Iterator[Picture]:
    for card in view.cards:
        yield from (
            Picture((6,), plot, SectionPlace(card.anchor, card.title)) for plot in card.plots
        )


SECTION = ReportSection(
    order=30,
    title="The worst scenes",
    anchor="gallery",
    view=_view,
    entries=lambda view: (ContentsEntry(card.anchor, card.title) for card in view.cards),
    pictures=_pictures,
    terms=lambda _: legend.terms_of("separation") | legend.terms_of_runs(),
    speaks=_lead_sentence_and_tiles,
)
