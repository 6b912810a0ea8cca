"""The page's own markup as a small tree, from which another format can be made."""

from dataclasses import dataclass, field
from html.parser import HTMLParser

from markupsafe import Markup

_VOID_TAGS = {"br", "img"}  # elements without an end tag


@dataclass(frozen=True)
class MarkupNode:
    """An element: its tag, its attributes and its children, which are texts and elements.

    An element without a tag only holds its children together.
    """

    tag: str
    attributes: dict[str, str] = field(default_factory=dict)
    children: list["MarkupNode | str"] = field(default_factory=list)

    @property
    def classes(self) -> list[str]:
        """The classes of the element."""
        return self.attributes.get("class", "").split()

    def elements(self, *tags: str) -> list["MarkupNode"]:
        """Return the child elements; if `tags` are given, only those with one of these tags."""
        child_elements = [child for child in self.children if isinstance(child, MarkupNode)]
        return [element for element in child_elements if not tags or element.tag in tags]

    @property
    def text(self) -> str:
        """The text in the element and in its descendants."""
        return "".join(c if isinstance(c, str) else c.text for c in self.children)


def tree(markup: Markup) -> MarkupNode:
    """Return the markup as a tree below a node without a tag.

    An end tag that does not close the innermost element is ignored.
    """
    reader = _MarkupReader()
    reader.feed(str(markup))
    reader.close()
    return reader.open[0]


class _MarkupReader(HTMLParser):
    def __init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self.open = [MarkupNode("")]

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        node = MarkupNode(tag, {key: text or "" for key, text in attrs})
        self.open[-1].children.append(node)
        if tag not in _VOID_TAGS:
            self.open.append(node)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.open[-1].children.append(MarkupNode(tag, {key: text or "" for key, text in attrs}))

    def handle_endtag(self, tag: str) -> None:
        if len(self.open) > 1 and self.open[-1].tag == tag:
            self.open.pop()

    def handle_data(self, data: str) -> None:
        self.open[-1].children.append(data)
