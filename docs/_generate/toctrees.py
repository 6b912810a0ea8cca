"""The toctrees of the manual, from the index that a forge shows: `docs/README.md`.

Each of its headings with links to pages becomes one, with the pages in the order of the links. So a
page has its place once, and the index has no directive in it that a forge would show as code.
"""

import re
from collections.abc import Iterator

_HEADING = re.compile(r"^## (.+)$", re.MULTILINE)
_PAGE = re.compile(r"\]\(([\w./-]+)\.md(?:#[\w-]+)?\)")


def chapters(index: str) -> Iterator[tuple[str, list[str]]]:
    """(heading, pages) of each heading under which there are links to pages of the manual."""
    _, *parts = _HEADING.split(index)
    for heading, text in zip(parts[::2], parts[1::2], strict=True):
        pages = [page for page in _PAGE.findall(text) if not page.startswith("..")]
        if pages:
            yield heading, list(dict.fromkeys(pages))


def with_toctrees(index: str) -> str:
    """The index, and a hidden toctree for each of its chapters."""
    trees = (
        "\n".join(["```{toctree}", ":hidden:", f":caption: {heading}", "", *pages, "```"])
        for heading, pages in chapters(index)
    )
    return "\n\n".join([index, *trees]) + "\n"
