"""A Report → one page of GitHub flavoured Markdown with its figures beside it, for a repository.

The same views as the page's: nothing is said here that they do not say.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from jinja2 import Environment

from verify.execution.keeping import write_atomically
from verify.pages.environment import environment
from verify.pages.figures.captioned_plot import Plot
from verify.pages.markdown import tables as markdown_tables
from verify.pages.markdown.from_markup import Markdown, escaped, in_html, markdown, table
from verify.pages.page import DATA
from verify.pages.sections.first_screen import SIGNS
from verify.pages.sections.views import PageView, page_view
from verify.scenes.results.report import Report
from verify.verdict import Verdict

TEXT, FIGURES = "report.md", "figures"
FIRST = "telling"  # where the first picture stands
_OWN = re.compile(r"figure-[0-9]{2,}\.svg")  # the names of figures that `write` has written


@dataclass
class _Figures:
    """The figures in the order in which the text shows them, each under the name of its file.

    The first screen's stands nowhere else, and what a figure of the paper shows stands only there.
    """

    page: PageView
    files: dict[str, str] = field(default_factory=dict)

    def image(self, plot: Plot) -> Markdown:
        """The image, with its lead as the text alternative."""
        from verify.pages.figures.svg import (
            document,  # and with it matplotlib, where something is drawn
        )

        path = f"{FIGURES}/figure-{len(self.files) + 1:02}.svg"
        self.files[path] = document([plot.svg])
        return Markdown(f"![{escaped(plot.lead)}]({path})")

    def show(self, plot: Plot) -> Markdown:
        """The image with its caption, or where it stands."""
        shown = self.page.figure_of(plot)
        if shown is None:
            return self.show_here(plot)
        lead = f"{shown.figure.label}: {plot.lead}"
        return Markdown(f"Picture: [{escaped(lead)}](#{shown.anchor})")

    def show_here(self, plot: Plot) -> Markdown:
        """The image with its caption, but for the first screen's."""
        if plot is self.page.first.plot:
            return Markdown(f"Picture: [{escaped(plot.lead)}](#{FIRST})")
        lead, caption = escaped(plot.lead), markdown(plot.caption)
        return Markdown(f"{self.image(plot)}\n\n<b>{lead}</b> {caption}")


def write(report: Report, folder: Path) -> Path:
    """Write `report.md`, `figures/*.svg` and `results.json` into the folder; the path of the text.

    The text is written last, so that what it points to is there.
    """
    text, figures = render(report)
    write_atomically(folder / DATA, report.model_dump_json(indent=1))
    for path, svg in figures.items():
        write_atomically(folder / path, svg)
    write_atomically(folder / TEXT, text)
    for file in (folder / FIGURES).glob("figure-*.svg"):
        if _OWN.fullmatch(file.name) and f"{FIGURES}/{file.name}" not in figures:
            file.unlink()  # of an earlier report, which had more of them
    return folder / TEXT


def render(report: Report) -> tuple[str, dict[str, str]]:
    """The whole text, and the SVG documents that it shows by the paths at which it does."""
    page = page_view(report)
    figures = _Figures(page)
    text = (
        _environment()
        .get_template("report.md")
        .render(
            page=page,
            signs=SIGNS,
            image=figures.image,
            figure=figures.show,
            figure_here=figures.show_here,
            first_id=FIRST,
        )
    )
    return _spaced(text), figures.files


def _spaced(text: str) -> str:
    """No line ends in blanks, and at most one line is empty between two others."""
    lines: list[str] = []
    for line in text.split("\n"):
        if line.strip() or (lines and lines[-1]):
            lines.append(line.rstrip())
    return "\n".join(lines).strip("\n") + "\n"


def _badge(verdict: Verdict) -> Markdown:
    """The sign and the word."""
    return Markdown(f"{SIGNS[verdict][0]} <b>{verdict}</b>")


def _tally(counts: Iterable[tuple[Verdict, int]]) -> Markdown:
    """Verdicts counted."""
    return Markdown(", ".join(f"{SIGNS[v][0]} {n} {v.lower()}" for v, n in counts))


def _link(name: str, anchor: str) -> Markdown:
    return Markdown(f"[{escaped(name)}](#{anchor})")


def _sentences(found: Iterable[object]) -> Markdown:
    """One after the other; jinja's own `join` would forget which of them are markup."""
    return Markdown(" ".join(map(markdown, found)))


def _anchor(name: str) -> Markdown:
    """Where a link leads; `Anchors` makes names of letters, digits and a few marks only."""
    return Markdown(f'<a id="{name}"></a>')


@cache
def _environment() -> Environment:
    # Not HTML, so nothing is escaped for it: `finalize` sets everything that an expression gives.
    made = environment(autoescape=False, finalize=markdown)
    made.filters.update(sentences=_sentences, summary=in_html)
    made.globals.update(
        anchor=_anchor, badge=_badge, tally=_tally, link=_link, table=table, tables=markdown_tables
    )
    return made
