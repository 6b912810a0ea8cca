"""A report as one page of GitHub flavoured Markdown with its figures beside it, for a repository.

It has the content of the HTML page, and nothing else. It knows the elements that the templates
write; any other element is replaced by its content. Elements that serve only a screen are skipped.
Text becomes Markdown by `inline_text`, or as code.

A table becomes a table for each group of rows, with the heading of the group above it, as Markdown
has neither heads of two rows nor rows of headings.
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import product
from pathlib import Path

from markupsafe import Markup

from verify.files import write_atomically
from verify.pages.figures.captioned_plot import Plot
from verify.pages.markdown.inline_text import Markdown, line, render_html, table
from verify.pages.markdown.markup import MarkupNode, tree
from verify.pages.page import DATA, environment, page_view
from verify.scenes.results.report import Report

_CONTENT = '{% include "content.html" %}{% include "footer.html" %}'
TEXT, FIGURES = "report.md", "figures"
# The names of figures that `write` writes; other files in the folder are left alone.
_FIGURE_NAME = re.compile(r"figure-[0-9]{2,}\.svg")
# Elements of these classes serve only a screen, and are left out.
_SCREEN_CLASSES = {"mark", "kind"}
# Elements of these classes are set in bold letters.
_STRONG = {"finding", "label"}
_CONTAINERS = {"article", "div", "figure", "header", "section"}
_LINES = {"p", "figcaption"}
_HEADINGS = {f"h{level}": "#" * level for level in range(1, 7)}
_SPECIAL_TAGS = {"details", "dl", "footer", "img", "ol", "pre", "table", "ul"}
_BLOCKS = {*_SPECIAL_TAGS, *_CONTAINERS, *_LINES, *_HEADINGS}
_RowNodes = list[list[MarkupNode]]


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
            file.unlink()  # an earlier report had more figures
    return folder / TEXT


def render(report: Report) -> tuple[str, dict[str, str]]:
    """Return the text, and the SVG documents that it shows by their paths."""
    figures: dict[str, str] = {}  # in the order in which the text shows them

    def image(plot: Plot) -> Markup:
        """Keep the plot as a document, and return an image of it with its text alternative."""
        from verify.pages.figures import svg  # imports matplotlib

        path = f"{FIGURES}/figure-{len(figures) + 1:02}.svg"
        figures[path] = svg.document([plot.svg])
        return Markup('<img src="{}" alt="{}">').format(path, plot.alternative)

    templates = environment(render_plot=image)
    content = templates.from_string(_CONTENT).render(page=page_view(report))
    return document(tree(Markup(content))), figures  # noqa: S704 - the page's own markup


# -- blocks ---------------------------------------------------------------------------------------


def document(root: MarkupNode) -> str:
    """Return the document as Markdown, with an anchor at each target of its own links."""
    links = {a.attributes.get("href", "").removeprefix("#") for a in _walk(root) if a.tag == "a"}
    return "\n\n".join(_BlockWriter(links).blocks_in(root)) + "\n"


def _walk(node: MarkupNode) -> Iterator[MarkupNode]:
    yield node
    for child in node.elements():
        yield from _walk(child)


class _BlockWriter:
    def __init__(self, links: set[str]) -> None:
        self._links = links - {""}

    def blocks_in(self, node: MarkupNode) -> list[Markdown]:
        """Return the blocks in the node; consecutive texts and inline elements form a paragraph."""
        return self._blocks_of(node.children)

    def _blocks_of(self, children: Iterable[MarkupNode | str]) -> list[Markdown]:
        blocks: list[Markdown] = []
        pending: list[MarkupNode | str] = []
        for child in children:
            if isinstance(child, str) or not _is_block(child):
                pending.append(child)
            else:
                blocks += [*_paragraph(pending), *self._block(child)]
                pending = []
        return [*blocks, *_paragraph(pending)]

    def _block(self, node: MarkupNode) -> Iterator[Markdown]:
        if _SCREEN_CLASSES & set(node.classes):
            return
        if (anchor := node.attributes.get("id", "")) in self._links:
            yield Markdown(f'<a id="{anchor}"></a>')
        if node.tag in _HEADINGS:
            yield from _heading(node)
        elif node.tag in _LINES:
            strong = _STRONG & set(node.classes)
            yield from _paragraph([MarkupNode("b", {}, node.children)] if strong else node.children)
        elif node.tag == "img":
            alternative = line([node.attributes["alt"]])
            yield Markdown(f"![{alternative}]({node.attributes['src']})")
        elif node.tag == "math":
            yield Markdown(line([node], escapes_start=False).strip())
        elif node.tag == "pre":
            yield _code(node)
        elif node.tag == "table":
            yield from tables(node)
        elif node.tag == "details":
            yield from self._details(node)
        elif node.tag in ("ul", "ol"):
            yield _list(
                (self.blocks_in(item) for item in node.elements("li")), numbered=node.tag == "ol"
            )
        elif node.tag == "dl":
            yield _list(map(self._definition, node.elements("div")))
        elif node.tag == "footer":
            yield from (Markdown("---"), *self.blocks_in(node))
        else:
            yield from self.blocks_in(node)

    def _details(self, node: MarkupNode) -> Iterator[Markdown]:
        (head,) = node.elements("summary")
        body = [c for c in node.children if c is not head]
        yield Markdown(f"<details>\n<summary>{render_html(head)}</summary>")
        yield from self._blocks_of(body)
        yield Markdown("</details>")

    def _definition(self, node: MarkupNode) -> list[Markdown]:
        """Return a term with its meaning, on the same line if the meaning begins with text."""
        (term,), (meaning,) = node.elements("dt"), node.elements("dd")
        blocks = self.blocks_in(meaning)
        opening = next((c for c in meaning.children if isinstance(c, MarkupNode) or c.strip()), "")
        is_inline = isinstance(opening, str) or opening.tag in _LINES or not _is_block(opening)
        head = f"<b>{line(term.children)}</b>:"
        if is_inline and blocks:
            return [Markdown(f"{head} {blocks[0]}"), *blocks[1:]]
        return [Markdown(head), *blocks]


def _is_block(node: MarkupNode) -> bool:
    return node.tag in _BLOCKS or node.attributes.get("display") == "block"


def _paragraph(children: Iterable[MarkupNode | str]) -> list[Markdown]:
    visible = (c for c in children if isinstance(c, str) or not _SCREEN_CLASSES & set(c.classes))
    text = line(visible)
    return [text] if text else []


def _heading(node: MarkupNode) -> Iterator[Markdown]:
    """Yield the heading, and below it the verdicts that are counted in it."""
    tallies = [c for c in node.elements() if "tally" in c.classes]
    yield Markdown(f"{_HEADINGS[node.tag]} {line(c for c in node.children if c not in tallies)}")
    yield from _paragraph(tallies)


def _code(node: MarkupNode) -> Markdown:
    """Return the code as a block between fences."""
    language = next((c.removeprefix("language-") for n in _walk(node) for c in n.classes), "")
    longest = max(map(len, re.findall("`+", node.text)), default=0)
    # The fence must be longer than any run of backticks in the code, which would end it.
    fence = "`" * max(3, longest + 1)
    return Markdown(f"{fence}{language}\n{node.text.strip(chr(10))}\n{fence}")


def _list(items: Iterable[list[Markdown]], *, numbered: bool = False) -> Markdown:
    """Return the list; further blocks of an item are indented below its text."""
    indent = "   " if numbered else "  "
    texts = [re.sub(r"\n(?!\n)", f"\n{indent}", "\n\n".join(item)) for item in items]
    separator = "\n\n" if any("\n" in item for item in texts) else "\n"
    marks = (f"{n}." if numbered else "-" for n, _ in enumerate(texts, start=1))
    return Markdown(
        separator.join(f"{mark} {item}" for mark, item in zip(marks, texts, strict=True))
    )


# -- tables ---------------------------------------------------------------------------------------


def tables(node: MarkupNode) -> Iterator[Markdown]:
    """Yield the caption, and then each group with its heading."""
    (head,) = node.elements("thead")
    heads = _heads(_rows(head))
    for caption in node.elements("caption"):
        yield line(caption.children)
    groups = [list(_groups(_rows(body))) for body in node.elements("tbody")]
    all_rows = [row for body in groups for _, rows in body for row in rows]
    # A row may have more cells than the table has heads, and Markdown drops cells without a head.
    heads += [Markdown("")] * (max(map(len, all_rows), default=0) - len(heads))
    columns = ([row[i] for row in all_rows if len(row) > i] for i in range(len(heads)))
    has_numbers = "numbers" in node.classes
    alignments = "".join(_alignment(column) if has_numbers else "l" for column in columns)
    for label, rows in (group for body in groups for group in body):
        if label:
            yield Markdown(f"<b>{label}</b>")
        yield table(heads, [[line(cell.children) for cell in row] for row in rows], alignments)


def _rows(node: MarkupNode) -> _RowNodes:
    return [row.elements("td", "th") for row in node.elements("tr")]


def _groups(rows: _RowNodes) -> Iterator[tuple[Markdown, _RowNodes]]:
    """Yield each heading, "" if there is none, with the rows below it."""
    label = Markdown("")
    group_rows: _RowNodes = []
    for row in rows:
        if row and row[0].attributes.get("scope") == "rowgroup":
            if group_rows:
                yield label, group_rows
            label, group_rows = line(row[0].children), []
        else:
            group_rows.append(row)
    yield label, group_rows


def _heads(rows: _RowNodes) -> list[Markdown]:
    """Return for each column the texts of all heads above it, from the top."""
    # The text of each (row, column); None if the cell of a row above reaches down to it.
    texts: dict[tuple[int, int], Markdown | None] = {}
    for r, row in enumerate(rows):
        for cell in row:
            c = next(c for c in range(len(texts) + 1) if (r, c) not in texts)
            for down, right in product(range(_span(cell, "row")), range(_span(cell, "col"))):
                texts[r + down, c + right] = None if down else line(cell.children)
    columns = range(max((c for _, c in texts), default=-1) + 1)
    columns_of_texts = ([texts.get((r, c)) for r in range(len(rows))] for c in columns)
    return [Markdown(", ".join(filter(None, column_texts))) for column_texts in columns_of_texts]


def _span(cell: MarkupNode, direction: str) -> int:
    return int(cell.attributes.get(f"{direction}span", "1"))


def _alignment(column: Sequence[MarkupNode]) -> str:
    """Return the alignment of a column: words to the left, numbers to the right."""
    if any("words" in cell.classes for cell in column):
        return "l"
    # A cell that spans several columns, as the reason of a failure does, does not count.
    texts = [cell.text.strip() for cell in column if _span(cell, "col") == 1]
    return "l" if any(text[:1].isalpha() for text in texts) else "r"
