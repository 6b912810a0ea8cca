"""A Report → one page of GitHub flavoured Markdown with its figures beside it, for a repository.

It is the page's own content set anew: nothing is said here that the page does not say.
"""

import re
from pathlib import Path

from markupsafe import Markup

from verify.files import write_atomically
from verify.pages.figures.captioned_plot import Plot
from verify.pages.markdown.blocks import document
from verify.pages.markdown.markup import tree
from verify.pages.page import DATA, environment, page_view
from verify.scenes.results.report import Report

_CONTENT = '{% include "content.html" %}{% include "footer.html" %}'
TEXT, FIGURES = "report.md", "figures"
_OWN = re.compile(r"figure-[0-9]{2,}\.svg")  # the names of figures that `write` has written


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
    figures: dict[str, str] = {}  # in the order in which the text shows them

    def image(plot: Plot) -> Markup:
        """The image with its text alternative."""
        from verify.pages.figures import svg  # and with it matplotlib, where something is drawn

        path = f"{FIGURES}/figure-{len(figures) + 1:02}.svg"
        figures[path] = svg.document([plot.svg])
        return Markup('<img src="{}" alt="{}">').format(path, plot.alternative)

    templates = environment(drawn=image)
    content = templates.from_string(_CONTENT).render(page=page_view(report))
    return document(tree(Markup(content))), figures  # noqa: S704 - the page's own markup
