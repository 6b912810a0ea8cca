"""Rows of a section's tables, which the macros `rows` and `groups` set."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

from markupsafe import Markup

from verify.pages.text.typography import whole

# Rows of a table on the page; all of them are in results.json.
MOST_ROWS = 600
Member = TypeVar("Member")


@dataclass(frozen=True)
class Row:
    """A row: `label`, then `cells`; a `failure` takes the place of the cells that are missing."""

    label: str
    cells: Sequence[str | Markup]
    failure: str = ""


@dataclass(frozen=True)
class Group:
    """Rows below a heading, with a remark `about` them beside it."""

    label: str
    rows: Sequence[Row]
    about: str = ""


def select_members(
    groups: Iterable[Sequence[Member]], failed: Callable[[Member], object] = lambda _: False
) -> Iterator[list[Member]]:
    """Yield for each group the members for which a table has room, in their order.

    Members for which `failed` holds come first, so that no failure is hidden; then the first of
    the others.
    """
    members = [list(group) for group in groups]
    places = [(i, k) for i, group in enumerate(members) for k in range(len(group))]
    first = sorted(places, key=lambda place: not failed(members[place[0]][place[1]]))
    selected = set(first[:MOST_ROWS])
    for i, group in enumerate(members):
        yield [member for k, member in enumerate(group) if (i, k) in selected]


def describe_excerpt(count: int, visible: int, failures: int = 0) -> str:
    """Return a sentence on the rows that a table without room for all shows; "" where all fit.

    >>> describe_excerpt(5000, 600, failures=3)
    '600 of 5,000 are shown, the 3 that did not end well among them; all are in results.json.'
    """
    if visible >= count:
        return ""
    which = ""
    if failures > visible:
        which = f", all of them of the {whole(failures)} that did not end well"
    elif failures:
        which = f", the {whole(failures)} that did not end well among them"
    return f"{whole(visible)} of {whole(count)} are shown{which}; all are in results.json."
