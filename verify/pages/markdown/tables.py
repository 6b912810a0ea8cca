"""A table of the page → tables of Markdown, which know no head of two rows and no rows of headings.

One table a group of rows, with the group's heading above it.
"""

from collections.abc import Iterator, Sequence
from itertools import product

from verify.pages.markdown.from_markup import Markdown, line, table
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
