"""Parts of pages that the code writes: one a file, whose `text()` is Markdown.

A page says `<!-- generated: NAME -->` where a part belongs, which a forge does not show. Adding a
part is adding a file and that comment.
"""

import re

from verify.discovery import Catalogue

PARTS = Catalogue(__name__, __path__)
_MARK = re.compile(r"^<!-- generated: (?P<name>[\w-]+) -->$", re.MULTILINE)


def asked_for(page: str) -> list[str]:
    """The names of the parts that a page has a place for, in its order."""
    return [mark["name"] for mark in _MARK.finditer(page)]


def filled(page: str) -> str:
    """The page with its parts. KeyError for a part that no file writes."""
    return _MARK.sub(lambda mark: str(PARTS.module(mark["name"]).text()), page)
