"""Rows of a section's tables; the macros `rows` and `groups` set them."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

from markupsafe import Markup

MOST_ROWS = 600  # of a table; the others are in results.json
Member = TypeVar("Member")


@dataclass(frozen=True)
class Row:
    """`cells` stand beside the `label`; a `failure` takes the place of those that are not there."""

    label: str
    cells: Sequence[str | Markup]
    failure: str = ""


@dataclass(frozen=True)
class Group:
    """Rows below a heading, and what is said `about` them beside it."""

    label: str
    rows: Sequence[Row]
    about: str = ""


def shown(groups: Iterable[Sequence[Member]]) -> Iterator[Sequence[Member]]:
    """Of each group the members that a table has room for."""
    left = MOST_ROWS
    for each in groups:
        yield each[:left]
        left -= len(each[:left])
