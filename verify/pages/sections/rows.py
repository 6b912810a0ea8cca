"""Rows of a section's tables; the macros `rows` and `groups` set them."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

from markupsafe import Markup

from verify.pages.text.typography import whole

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


def shown(
    groups: Iterable[Sequence[Member]], failed: Callable[[Member], object] = lambda _: False
) -> Iterator[list[Member]]:
    """Of each group the members that a table has room for, in their order.

    What `failed` has room first, since nobody is to miss it; then the first of the others.
    """
    held = [list(group) for group in groups]
    places = [(i, k) for i, group in enumerate(held) for k in range(len(group))]
    first = sorted(places, key=lambda place: not failed(held[place[0]][place[1]]))
    kept = set(first[:MOST_ROWS])
    for i, group in enumerate(held):
        yield [member for k, member in enumerate(group) if (i, k) in kept]


def told(count: int, shown: int, failures: int = 0) -> str:
    """Which rows stand in a table that has no room for all, in a sentence; "" where it has.

    >>> told(5000, 600, failures=3)
    '600 of 5,000 are shown, the 3 that did not end well among them; all are in results.json.'
    """
    if shown >= count:
        return ""
    which = ""
    if failures > shown:
        which = f", all of them of the {whole(failures)} that did not end well"
    elif failures:
        which = f", the {whole(failures)} that did not end well among them"
    return f"{whole(shown)} of {whole(count)} are shown{which}; all are in results.json."
