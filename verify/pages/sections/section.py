"""A section of a report: one object, in a file of a catalogue, with everything it can show.

A file `NAME.py` in `page/`, `scene/` or `scheme/` defines `SECTION`; what it shows is set by the
template `LEVEL/NAME.html`, as the page and as Markdown. Adding a section is adding these two, and
a file in `verify/pages/figures/` if it draws.
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
    """A place in the contents: verdicts counted in it, and the places within.

    `is_numbered`: these are listed by their numbers alone, in a line.
    """

    anchor: str
    title: str | Markup
    counts: Counts = ()
    inner: tuple["ContentsEntry", ...] = ()
    is_numbered: bool = False


@dataclass(frozen=True)
class Picture:
    """A picture for the first screen, which takes the one with the least `rank`.

    `place`: where more is said, if that is not the section's own place.
    """

    rank: tuple[int, ...]
    plot: Plot
    place: SectionPlace | None = None


@dataclass(frozen=True)
class Tile:
    """A tile; `weight`: its share of the bar below the tiles, 0 if the tiles are no counts."""

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
    """A section by its functions, of which `view` alone is required.

    `view` takes the subject of its level (`PageContents` on the page; scene and anchor; scene,
    proof and anchor) and returns the object that the template shows, or None or an empty one if
    there is nothing to show. All other functions take the view.
    """

    order: int  # among the sections of its level
    view: Callable[..., Any]
    title: str = ""  # its heading, and its name in the contents; "": its template has its own
    anchor: str = ""  # where the page's contents and links lead, with that of its scene
    entries: Callable[[Any], Iterable[ContentsEntry]] = _nothing  # within its own; or in its place
    is_numbered: bool = False  # its entries are numbers
    inner: Callable[[Any], Iterable["VisibleSection"]] = _nothing  # the sections within it
    pictures: Callable[[Any], Iterable[Picture]] = _nothing
    keeps: Callable[[Any], Iterable[tuple[Plot, SectionPlace]]] = (
        _nothing  # plots that stand only here
    )
    # Of all views of the section in a report.
    terms: Callable[[Sequence[Any]], Mapping[str, Markup]] = lambda _: {}
    # For a paper's figure that `shows` this: the plots of that label, each with a finding or "".
    shows: str = ""
    matching_plots: Callable[[Any, str], Iterable[tuple[Plot | None, str]]] = _nothing
    # What the first screen says of a report without claims and proofs: a sentence and tiles.
    speaks: Callable[[Report], tuple[str, Sequence[Tile]] | None] = lambda _: None


@dataclass(frozen=True)
class VisibleSection:
    """A section that has something to show; `place`: that of its page, scene or scheme."""

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
        """The name of its file, with hyphens, which is its class in the style sheet."""
        return self.template.partition("/")[2].removesuffix(".html").replace("_", "-")

    @property
    def name(self) -> str:
        """The text of links to the section."""
        return f"{self.section.title}, {self.place.name}" if self.place.name else self.section.title

    @property
    def entries(self) -> tuple[ContentsEntry, ...]:
        """Its entry in the contents with the inner ones; these alone if it has no title."""
        inner = tuple(self.section.entries(self.view))
        if not (self.section.title and self.anchor):
            return inner
        numbered = self.section.is_numbered
        return (ContentsEntry(self.anchor, self.section.title, inner=inner, is_numbered=numbered),)

    @property
    def pictures(self) -> Iterator[tuple[tuple[int, ...], Plot, SectionPlace]]:
        """Its pictures for the first screen, each with its rank and the place that says more."""
        place = SectionPlace(self.anchor, self.place.name) if self.anchor else self.place
        for picture in self.section.pictures(self.view):
            yield picture.rank, picture.plot, picture.place or place


def sections(files: Catalogue) -> list[tuple[str, ReportSection]]:
    """Return the sections in these files with the names of their templates, in their order."""
    templates = [
        (f"{files.folder(name)}/{name.replace('-', '_')}.html", files.module(name).SECTION)
        for name in files.names
    ]
    return sorted(templates, key=lambda template_and_section: template_and_section[1].order)


def select_sections(
    files: Catalogue, place: SectionPlace, *subject: object
) -> tuple[VisibleSection, ...]:
    """Return the sections in these files that have something to show of the subject."""
    views = ((s, template, s.view(*subject)) for template, s in sections(files))
    return tuple(VisibleSection(s, template, view, place) for s, template, view in views if view)


def walk(visible: Iterable[VisibleSection]) -> Iterator[VisibleSection]:
    """Yield each section, and after it those within it."""
    for section in visible:
        yield section
        yield from walk(section.section.inner(section.view))


def terms(visible: Iterable[VisibleSection]) -> dict[str, Markup]:
    """Return the terms that these sections and those within them use, with their meanings."""
    return {
        term: meaning
        # A section may be visible in several scenes; its terms are explained once.
        for same_template in by_key(walk(visible), lambda section: section.template).values()
        for term, meaning in same_template[0]
        .section.terms([section.view for section in same_template])
        .items()
    }
