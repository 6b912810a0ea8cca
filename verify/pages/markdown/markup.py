"""The page's own markup as a small tree, so that another format can set it anew."""

from dataclasses import dataclass, field
from html.parser import HTMLParser

from markupsafe import Markup

_VOID = {"br", "img"}


@dataclass(frozen=True)
class Node:
    """An element: its tag, its attributes, and what stands in it, texts and elements in turn."""

    tag: str
    attributes: dict[str, str] = field(default_factory=dict)
    children: list["Node | str"] = field(default_factory=list)

    @property
    def classes(self) -> list[str]:
        """Its classes."""
        return self.attributes.get("class", "").split()

    def elements(self, *tags: str) -> list["Node"]:
        """The elements right in it; of these tags, where any is named."""
        found = [child for child in self.children if isinstance(child, Node)]
        return [each for each in found if not tags or each.tag in tags]

    @property
    def text(self) -> str:
        """All text in it."""
        return "".join(c if isinstance(c, str) else c.text for c in self.children)


def tree(markup: Markup) -> Node:
    """The markup under a node without a tag; an end tag that closes nothing is passed over."""
    reader = _Reader()
    reader.feed(str(markup))
    reader.close()
    return reader.open[0]


class _Reader(HTMLParser):
    def __init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self.open = [Node("")]

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        node = Node(tag, {key: text or "" for key, text in attrs})
        self.open[-1].children.append(node)
        if tag not in _VOID:
            self.open.append(node)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.open[-1].children.append(Node(tag, {key: text or "" for key, text in attrs}))

    def handle_endtag(self, tag: str) -> None:
        if len(self.open) > 1 and self.open[-1].tag == tag:
            self.open.pop()

    def handle_data(self, data: str) -> None:
        self.open[-1].children.append(data)
