"""A section of a report: one object, in one file that is found, with all that is asked of it.

A file `NAME.py` in `page/`, `scene/` or `scheme/` defines `SECTION`; what it shows is set by the
template `LEVEL/NAME.html`, as the page and as Markdown. Adding a section is adding these two, and
a file in `verify/pages/figures/` where it draws.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from markupsafe import Markup

from verify.discovery import Catalogue
from verify.pages.figures.captioned_plot import Plot
from verify.pages.sections.by_key import by_key
from verify.scenes.results.report import Report
from verify.verdict import Verdict

Counts = tuple[tuple[Verdict, int], ...]


@dataclass(frozen=True)
class Place:
    """Where something stands on the page, and what it is called."""

    anchor: str
    name: str


@dataclass(frozen=True)
class Entry:
    """A place in the contents: verdicts counted in it, and the places within.

    `is_numbered`: these are told by their numbers alone, in a line.
    """

    anchor: str
    title: str | Markup
    counts: Counts = ()
    inner: tuple["Entry", ...] = ()
    is_numbered: bool = False


@dataclass(frozen=True)
class Picture:
    """A picture for the first screen, which takes that with the least `rank`; `place`: where more
    is said, if that is not the section's own place."""

    rank: tuple[int, ...]
    plot: Plot
    place: Place | None = None


@dataclass(frozen=True)
class Tile:
    """`weight`: its share of the bar below the tiles, 0 where counts are not what is told."""

    verdict: Verdict
    sign: str
    figure: str
    word: str
    meaning: str = ""
    weight: int = 0


def _nothing(*_: object) -> tuple[()]:
    return ()


@dataclass(frozen=True)
class Section:
    """What a section is asked for; `view` alone it must have, the rest may have nothing to say.

    `view` is given what its level is of (`Given` on the page; scene and anchor; scene, proof and
    anchor), and returns what the template shows: None, or nothing in it, where that is nothing. All
    other functions are given the view.
    """

    order: int  # among the sections of its level
    view: Callable[..., Any]
    title: str = ""  # its heading, and its name in the contents; "": its template has its own
    anchor: str = ""  # where the page's contents and links lead, with that of its scene
    entries: Callable[[Any], Iterable[Entry]] = _nothing  # within its own; or in its place
    is_numbered: bool = False  # its entries are numbers
    inner: Callable[[Any], Iterable["Shown"]] = _nothing  # the sections within it
    pictures: Callable[[Any], Iterable[Picture]] = _nothing
    keeps: Callable[[Any], Iterable[tuple[Plot, Place]]] = _nothing  # plots that stand only here
    # Of all views of the section in a report.
    terms: Callable[[Sequence[Any]], Mapping[str, Markup]] = lambda _: {}
    # For a paper's figure that `shows` this: the plots of that label, each with a finding or "".
    shows: str = ""
    drawn: Callable[[Any, str], Iterable[tuple[Plot | None, str]]] = _nothing
    # What the first screen says of a report without claims and proofs: a sentence and tiles.
    speaks: Callable[[Report], tuple[str, Sequence[Tile]] | None] = lambda _: None


@dataclass(frozen=True)
class Shown:
    """A section that has something to show; `place`: that of what it is a section of."""

    section: Section
    template: str
    view: Any
    place: Place

    @property
    def anchor(self) -> str:
        """Where links to it lead; "" where it has no place of its own."""
        own, of = self.section.anchor, self.place.anchor
        return f"{own}-of-{of}" if own and of else own

    @property
    def stem(self) -> str:
        """The name of its file, with hyphens: a class of its own in the style sheet."""
        return self.template.partition("/")[2].removesuffix(".html").replace("_", "-")

    @property
    def name(self) -> str:
        """What a link to it is called."""
        return f"{self.section.title}, {self.place.name}" if self.place.name else self.section.title

    @property
    def entries(self) -> tuple[Entry, ...]:
        """Its entry in the contents, with those within; those alone where it has no title."""
        inner = tuple(self.section.entries(self.view))
        if not (self.section.title and self.anchor):
            return inner
        numbered = self.section.is_numbered
        return (Entry(self.anchor, self.section.title, inner=inner, is_numbered=numbered),)

    @property
    def pictures(self) -> Iterator[tuple[tuple[int, ...], Plot, Place]]:
        """Its pictures for the first screen, each with its rank and where more is said of it."""
        own = Place(self.anchor, self.place.name) if self.anchor else self.place
        for each in self.section.pictures(self.view):
            yield each.rank, each.plot, each.place or own


def sections(files: Catalogue) -> list[tuple[str, Section]]:
    """The sections in these files by the names of their templates, in their order."""
    found = [
        (f"{files.folder(name)}/{name.replace('-', '_')}.html", files.module(name).SECTION)
        for name in files.names
    ]
    return sorted(found, key=lambda each: each[1].order)


def shown(files: Catalogue, place: Place, *given: object) -> tuple[Shown, ...]:
    """The sections in these files that have something to show of what is given."""
    views = ((s, template, s.view(*given)) for template, s in sections(files))
    return tuple(Shown(s, template, view, place) for s, template, view in views if view)


def walk(found: Iterable[Shown]) -> Iterator[Shown]:
    """Each section, and after it those within it."""
    for each in found:
        yield each
        yield from walk(each.section.inner(each.view))


def terms(found: Iterable[Shown]) -> dict[str, Markup]:
    """The terms that these sections and those within them need, with what each means."""
    return {
        term: meaning
        for own in by_key(walk(found), lambda each: each.template).values()
        for term, meaning in own[0].section.terms([each.view for each in own]).items()
    }
