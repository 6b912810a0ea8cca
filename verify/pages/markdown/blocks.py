"""The page's own markup → blocks of GitHub flavoured Markdown.

Only the elements that the templates write are known; of any other what stands in it is set. What
is for a screen alone is passed over. Text reaches Markdown through `from_markup`, or as code.

A table of the page → tables of Markdown, which know no head of two rows and no rows of headings.

One table a group of rows, with the group's heading above it.
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import product

from verify.pages.markdown.from_markup import Markdown, in_html, line, table
from verify.pages.markdown.markup import Node

_Rows = list[list[Node]]


def tables(node: Node) -> Iterator[Markdown]:
    """The caption, and then each group with its heading."""
    (head,) = node.elements("thead")
    heads = _heads(_rows(head))
    for caption in node.elements("caption"):
        yield line(caption.children)
    groups = [list(_groups(_rows(body))) for body in node.elements("tbody")]
    all_rows = [row for body in groups for _, rows in body for row in rows]
    heads += [Markdown("")] * (max(map(len, all_rows), default=0) - len(heads))
    columns = ([row[i] for row in all_rows if len(row) > i] for i in range(len(heads)))
    numbers = "numbers" in node.classes
    places = "".join(_place(column) if numbers else "l" for column in columns)
    for label, rows in (group for body in groups for group in body):
        if label:
            yield Markdown(f"<b>{label}</b>")
        yield table(heads, [[line(cell.children) for cell in row] for row in rows], places)


def _rows(node: Node) -> _Rows:
    return [row.elements("td", "th") for row in node.elements("tr")]


def _groups(rows: _Rows) -> Iterator[tuple[Markdown, _Rows]]:
    """The rows below each heading, "" where there is none."""
    label = Markdown("")
    own: _Rows = []
    for row in rows:
        if row and row[0].attributes.get("scope") == "rowgroup":
            if own:
                yield label, own
            label, own = line(row[0].children), []
        else:
            own.append(row)
    yield label, own


def _heads(rows: _Rows) -> list[Markdown]:
    """What all cells above a column say, from above."""
    said: dict[tuple[int, int], Markdown | None] = {}
    for r, row in enumerate(rows):
        for cell in row:
            c = next(c for c in range(len(said) + 1) if (r, c) not in said)
            for down, right in product(range(_span(cell, "row")), range(_span(cell, "col"))):
                said[r + down, c + right] = None if down else line(cell.children)
    columns = range(max((c for _, c in said), default=-1) + 1)
    found = ([said.get((r, c)) for r in range(len(rows))] for c in columns)
    return [Markdown(", ".join(filter(None, each))) for each in found]


def _span(cell: Node, way: str) -> int:
    return int(cell.attributes.get(f"{way}span", "1"))


def _place(column: Sequence[Node]) -> str:
    """Words stand at the left, numbers at the right."""
    if any("words" in cell.classes for cell in column):
        return "l"
    alone = [cell.text.strip() for cell in column if _span(cell, "col") == 1]
    return "l" if any(text[:1].isalpha() for text in alone) else "r"


_ON_SCREEN = {"mark", "kind"}  # classes of what nothing is lost without
_STRONG = {"finding", "label"}  # what the page sets in other letters
_CONTAINERS = {"article", "div", "figure", "header", "section"}
_LINES = {"p", "figcaption"}
_HEADINGS = {f"h{level}": "#" * level for level in range(1, 7)}
_OWN = {"details", "dl", "footer", "img", "ol", "pre", "table", "ul"}
_BLOCKS = {*_OWN, *_CONTAINERS, *_LINES, *_HEADINGS}


def document(root: Node) -> str:
    """All that stands in it. Places that a link of its own leads to can be linked to."""
    links = {a.attributes.get("href", "").removeprefix("#") for a in _all(root) if a.tag == "a"}
    return "\n\n".join(_Writer(links).inside(root)) + "\n"


def _all(node: Node) -> Iterator[Node]:
    yield node
    for child in node.elements():
        yield from _all(child)


class _Writer:
    def __init__(self, links: set[str]) -> None:
        self._links = links - {""}

    def inside(self, node: Node) -> list[Markdown]:
        """What stands in it, block after block; texts and what is set within a line together."""
        return self._each(node.children)

    def _each(self, children: Iterable[Node | str]) -> list[Markdown]:
        found: list[Markdown] = []
        pending: list[Node | str] = []
        for child in children:
            if isinstance(child, str) or not _is_block(child):
                pending.append(child)
            else:
                found += [*_paragraph(pending), *self._block(child)]
                pending = []
        return [*found, *_paragraph(pending)]

    def _block(self, node: Node) -> Iterator[Markdown]:
        if _ON_SCREEN & set(node.classes):
            return
        if (place := node.attributes.get("id", "")) in self._links:
            yield Markdown(f'<a id="{place}"></a>')
        if node.tag in _HEADINGS:
            yield from _heading(node)
        elif node.tag in _LINES:
            strong = _STRONG & set(node.classes)
            yield from _paragraph([Node("b", {}, node.children)] if strong else node.children)
        elif node.tag == "img":
            alternative = line([node.attributes["alt"]])
            yield Markdown(f"![{alternative}]({node.attributes['src']})")
        elif node.tag == "math":
            yield Markdown(line([node], started=False).strip())
        elif node.tag == "pre":
            yield _code(node)
        elif node.tag == "table":
            yield from tables(node)
        elif node.tag == "details":
            yield from self._details(node)
        elif node.tag in ("ul", "ol"):
            yield _list(
                (self.inside(item) for item in node.elements("li")), numbered=node.tag == "ol"
            )
        elif node.tag == "dl":
            yield _list(map(self._defined, node.elements("div")))
        elif node.tag == "footer":
            yield from (Markdown("---"), *self.inside(node))
        else:
            yield from self.inside(node)

    def _details(self, node: Node) -> Iterator[Markdown]:
        (head,) = node.elements("summary")
        rest = [c for c in node.children if c is not head]
        yield Markdown(f"<details>\n<summary>{in_html(head)}</summary>")
        yield from self._each(rest)
        yield Markdown("</details>")

    def _defined(self, node: Node) -> list[Markdown]:
        """A term and what it means, which goes on in the same line where it begins with one."""
        (term,), (meaning,) = node.elements("dt"), node.elements("dd")
        found = self.inside(meaning)
        first = next((c for c in meaning.children if isinstance(c, Node) or c.strip()), "")
        said = isinstance(first, str) or first.tag in _LINES or not _is_block(first)
        head = f"<b>{line(term.children)}</b>:"
        if said and found:
            return [Markdown(f"{head} {found[0]}"), *found[1:]]
        return [Markdown(head), *found]


def _is_block(node: Node) -> bool:
    return node.tag in _BLOCKS or node.attributes.get("display") == "block"


def _paragraph(children: Iterable[Node | str]) -> list[Markdown]:
    kept = (c for c in children if isinstance(c, str) or not _ON_SCREEN & set(c.classes))
    found = line(kept)
    return [found] if found else []


def _heading(node: Node) -> Iterator[Markdown]:
    """The heading, and below it verdicts that are counted in it."""
    counted = [c for c in node.elements() if "tally" in c.classes]
    yield Markdown(f"{_HEADINGS[node.tag]} {line(c for c in node.children if c not in counted)}")
    yield from _paragraph(counted)


def _code(node: Node) -> Markdown:
    """Between fences that are longer than any row of backticks in it."""
    language = next((c.removeprefix("language-") for n in _all(node) for c in n.classes), "")
    longest = max(map(len, re.findall("`+", node.text)), default=0)
    fence = "`" * max(3, longest + 1)
    return Markdown(f"{fence}{language}\n{node.text.strip(chr(10))}\n{fence}")


def _list(items: Iterable[list[Markdown]], *, numbered: bool = False) -> Markdown:
    """Each item with what belongs to it below its text."""
    indent = "   " if numbered else "  "
    shown = [re.sub(r"\n(?!\n)", f"\n{indent}", "\n\n".join(item)) for item in items]
    between = "\n\n" if any("\n" in item for item in shown) else "\n"
    marks = (f"{n}." if numbered else "-" for n, _ in enumerate(shown, start=1))
    return Markdown(between.join(f"{mark} {item}" for mark, item in zip(marks, shown, strict=True)))
