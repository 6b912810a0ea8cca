"""A section of a report: an object in a file of its own, with everything that it can show.

A file `NAME.py` in `page/`, `scene/` or `scheme/`, the three levels, defines `SECTION`. Its view is
an object with the content, which the template `LEVEL/NAME.html` sets for the page and for Markdown.
A new section needs these two files, and one in `verify/pages/figures/` if it draws.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from markupsafe import Markup

from verify.discovery import Catalogue
from verify.pages.figures.captioned_plot import Plot
from verify.pages.sections.table_rows import by_key
from verify.scenes.results.report import Report
from verify.verdict import Verdict

Counts = tuple[tuple[Verdict, int], ...]


@dataclass(frozen=True)
class SectionPlace:
    """A place on the page: its anchor and its name."""

    anchor: str
    name: str


@dataclass(frozen=True)
class ContentsEntry:
    """An entry of the contents: a place, the verdicts counted in it, and the places within it.

    `is_numbered`: True if the places within it are listed by their numbers alone, in a line.
    """

    anchor: str
    title: str | Markup
    counts: Counts = ()
    inner: tuple["ContentsEntry", ...] = ()
    is_numbered: bool = False


@dataclass(frozen=True)
class Picture:
    """A picture for the first screen, which takes the one with the least `rank`.

    `place`: the place that says more of it, if that is not the place of its section.
    """

    rank: tuple[int, ...]
    plot: Plot
    place: SectionPlace | None = None


@dataclass(frozen=True)
class Tile:
    """A tile of the first screen.

    `weight`: its share of the bar below the tiles; 0 if the tiles do not count anything.
    """

    verdict: Verdict
    sign: str
    figure: str
    word: str
    meaning: str = ""
    weight: int = 0


def _nothing(*_: object) -> tuple[()]:
    return ()


@dataclass(frozen=True)
class ReportSection:
    """A section by its functions, of which only `view` is required.

    `view` takes the subject of its level: on the page `PageContents`; of a scene, the scene and its
    anchor; of a scheme, the scene, the proof and the anchor. It returns the view, which is None or
    empty if there is nothing to show. The other functions take the view, except `terms`, which
    takes all views of the section in a report, and `speaks`.
    """

    order: int  # its position among the sections of its level, which are sorted by it
    view: Callable[..., Any]
    title: str = ""  # its heading and its name in the contents; "" if the template has a heading
    anchor: str = ""  # the beginning of the anchor to which contents and links lead; "" for none
    # The entries within its entry in the contents; they replace it if it has no title or no anchor.
    entries: Callable[[Any], Iterable[ContentsEntry]] = _nothing
    is_numbered: bool = False  # True if its entries are numbers
    inner: Callable[[Any], Iterable["VisibleSection"]] = _nothing  # the sections within it
    pictures: Callable[[Any], Iterable[Picture]] = _nothing
    # Plots that no other section shows.
    keeps: Callable[[Any], Iterable[tuple[Plot, SectionPlace]]] = _nothing
    # The terms that these views use, with their meanings.
    terms: Callable[[Sequence[Any]], Mapping[str, Markup]] = lambda _: {}
    # If a figure of a paper `shows` this kind: the plots with its label, each with a finding or "".
    shows: str = ""
    matching_plots: Callable[[Any, str], Iterable[tuple[Plot | None, str]]] = _nothing
    # A sentence and tiles for the first screen of a report without claims and proofs.
    speaks: Callable[[Report], tuple[str, Sequence[Tile]] | None] = lambda _: None
    takes_field: bool = False  # of a scheme: also of equations without an H


@dataclass(frozen=True)
class VisibleSection:
    """A section that has something to show; `place`: the place of its page, scene or scheme."""

    section: ReportSection
    template: str
    view: Any
    place: SectionPlace

    @property
    def anchor(self) -> str:
        """The anchor of the section; "" if it has no place of its own."""
        section_anchor, place_anchor = self.section.anchor, self.place.anchor
        return (
            f"{section_anchor}-of-{place_anchor}"
            if section_anchor and place_anchor
            else section_anchor
        )

    @property
    def stem(self) -> str:
        """The name of its template with hyphens, which is its class in the style sheet."""
        return self.template.partition("/")[2].removesuffix(".html").replace("_", "-")

    @property
    def name(self) -> str:
        """The text of links to the section."""
        return f"{self.section.title}, {self.place.name}" if self.place.name else self.section.title

    @property
    def entries(self) -> tuple[ContentsEntry, ...]:
        """Its entry in the contents with those within; only these without a title or an anchor."""
        inner = tuple(self.section.entries(self.view))
        if not (self.section.title and self.anchor):
            return inner
        is_numbered = self.section.is_numbered
        return (
            ContentsEntry(self.anchor, self.section.title, inner=inner, is_numbered=is_numbered),
        )

    @property
    def pictures(self) -> Iterator[tuple[tuple[int, ...], Plot, SectionPlace]]:
        """Its pictures for the first screen, each with its rank and the place that says more."""
        place = SectionPlace(self.anchor, self.place.name) if self.anchor else self.place
        for picture in self.section.pictures(self.view):
            yield picture.rank, picture.plot, picture.place or place


def sections(files: Catalogue) -> list[tuple[str, ReportSection]]:
    """Return the sections in these files by `order`, each with the name of its template first."""
    named_sections = [
        (f"{files.folder(name)}/{name.replace('-', '_')}.html", files.module(name).SECTION)
        for name in files.names
    ]
    return sorted(named_sections, key=lambda template_and_section: template_and_section[1].order)


def select_sections(
    files: Catalogue, place: SectionPlace, *subject: object, of_field: bool = False
) -> tuple[VisibleSection, ...]:
    """Return the sections in these files that have something to show of the subject, by `order`.

    `of_field`: it is of equations without an H.
    """
    chosen = ((t, s) for t, s in sections(files) if s.takes_field or not of_field)
    views = ((s, template, s.view(*subject)) for template, s in chosen)
    return tuple(VisibleSection(s, template, view, place) for s, template, view in views if view)


def walk(visible: Iterable[VisibleSection]) -> Iterator[VisibleSection]:
    """Yield each section, followed by the sections within it."""
    for section in visible:
        yield section
        yield from walk(section.section.inner(section.view))


def terms(visible: Iterable[VisibleSection]) -> dict[str, Markup]:
    """Return the terms that these sections and those within them use, with their meanings."""
    return {
        term: meaning
        # A section may be visible in several scenes, and explains its terms once.
        for same_template in by_key(walk(visible), lambda section: section.template).values()
        for term, meaning in same_template[0]
        .section.terms([section.view for section in same_template])
        .items()
    }
