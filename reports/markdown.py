"""A Report → one page of GitHub flavoured Markdown with its figures beside it, for a repository.

The same views as the page's: nothing is said here that they do not say.
"""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cache
from itertools import groupby
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

from reports import markdown_tables, mathml, typography
from reports.claim_view import ClaimView
from reports.first_screen import SIGNS
from reports.markdown_text import Markdown, escaped, markdown, table
from reports.page import DATA
from reports.plots import Plot
from reports.views import page_view
from verify.keeping import write_atomically
from verify.scene_results import Report
from verify.verdict import Verdict

TEXT, FIGURES = "report.md", "figures"
_OWN = re.compile(r"figure-[0-9]{2,}\.svg")  # the names of figures that `write` has written


@dataclass
class _Figures:
    """The figures in the order in which the text shows them, each under the name of its file."""

    files: dict[str, str] = field(default_factory=dict)

    def show(self, plot: Plot, *, captioned: bool = True) -> Markdown:
        """The image, with its lead as the text alternative, and its caption."""
        from reports.svg import document  # and with it matplotlib, where something is drawn

        path = f"{FIGURES}/figure-{len(self.files) + 1:02}.svg"
        self.files[path] = document([plot.svg])
        image = f"![{escaped(plot.lead)}]({path})"
        said = f"\n\n<b>{escaped(plot.lead)}</b> {markdown(plot.caption)}" if captioned else ""
        return Markdown(f"{image}{said}")


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
    figures = _Figures()
    page = page_view(report)
    text = (
        _environment()
        .get_template("report.md")
        .render(page=page, signs=SIGNS, figure=figures.show, groups=tuple(_groups(page.claims)))
    )
    return _spaced(text), figures.files


def _groups(claims: tuple[ClaimView, ...]) -> Iterator[tuple[str, tuple[ClaimView, ...]]]:
    """The claims in the order of their source, neighbours of one scene together."""
    for title, own in groupby(claims, key=lambda claim: claim.scene_title):
        yield title or "In general", tuple(own)


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


def _link(claim: ClaimView) -> Markdown:
    return Markdown(f"[{escaped(claim.result.source or claim.result.id)}](#{claim.anchor})")


def _sentences(found: Iterable[object]) -> Markdown:
    """One after the other; jinja's own `join` would forget which of them are markup."""
    return Markdown(" ".join(map(markdown, found)))


def _anchor(name: str) -> Markdown:
    """Where a link leads; `Anchors` makes names of letters, digits and a few marks only."""
    return Markdown(f'<a id="{name}"></a>')


def _summary(text: str) -> Markdown:
    """What stands in a <summary>: HTML, in which Markdown's marks mean nothing."""
    return Markdown(escape(" ".join(text.split())).replace("$", "<span>$</span>"))


def _equation(left: str, text: str) -> Markup:
    return mathml.equation(mathml.NAMED[left], text)


@cache
def _environment() -> Environment:
    # Not HTML, so nothing is escaped for it: `finalize` sets everything that an expression gives.
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent / "templates", encoding="utf-8"),
        autoescape=False,  # noqa: S701 - see above
        finalize=markdown,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(
        prose=typography.prose,
        sentence=typography.sentence,
        sentences=_sentences,
        number=typography.number,
        whole=typography.whole,
        listed=typography.listed,
        name=mathml.name,
        plain=mathml.plain,
    )
    environment.globals.update(
        anchor=_anchor,
        equation=_equation,
        badge=_badge,
        link=_link,
        summary=_summary,
        table=table,
        tables=markdown_tables,
    )
    return environment
