"""A report as one page of GitHub flavoured Markdown with its figures beside it, for a repository.

It is the content of the HTML page in another format; nothing is added here.
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
# The names of figures that `write` has written; other files of the folder are not touched.
_FIGURE_NAME = re.compile(r"figure-[0-9]{2,}\.svg")


def write(report: Report, folder: Path) -> Path:
    """Write `report.md`, `figures/*.svg` and `results.json`, and return the path of the text.

    The text is written last, so that all files it refers to exist.
    """
    text, figures = render(report)
    write_atomically(folder / DATA, report.model_dump_json(indent=1))
    for path, svg in figures.items():
        write_atomically(folder / path, svg)
    write_atomically(folder / TEXT, text)
    for file in (folder / FIGURES).glob("figure-*.svg"):
        if _FIGURE_NAME.fullmatch(file.name) and f"{FIGURES}/{file.name}" not in figures:
            file.unlink()  # of an earlier report, which had more of them
    return folder / TEXT


def render(report: Report) -> tuple[str, dict[str, str]]:
    """Return the text, and the SVG documents that it shows by their paths."""
    figures: dict[str, str] = {}  # in the order in which the text shows them

    def image(plot: Plot) -> Markup:
        """Store the plot as a document and return the image with its text alternative."""
        from verify.pages.figures import svg  # and with it matplotlib, where something is drawn

        path = f"{FIGURES}/figure-{len(figures) + 1:02}.svg"
        figures[path] = svg.document([plot.svg])
        return Markup('<img src="{}" alt="{}">').format(path, plot.alternative)

    templates = environment(render_plot=image)
    content = templates.from_string(_CONTENT).render(page=page_view(report))
    return document(tree(Markup(content))), figures  # noqa: S704 - the page's own markup
