"""Rows of a section's tables in groups, for the macros `rows` and `groups` of the templates."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

from markupsafe import Markup

from verify.pages.text.typography import whole

# The limit on rows of a table on the page; all of them are in results.json.
MOST_ROWS = 600
Key = TypeVar("Key")
Member = TypeVar("Member")


@dataclass(frozen=True)
class TableRow:
    """A row: `label`, then `cells`, then a `failure`, if any, in place of missing cells."""

    label: str
    cells: Sequence[str | Markup]
    failure: str = ""


@dataclass(frozen=True)
class Group:
    """Rows below a heading `label`, with a remark `about` them beside the heading."""

    label: str
    rows: Sequence[TableRow]
    about: str = ""


def by_key(members: Iterable[Member], key: Callable[[Member], Key]) -> dict[Key, list[Member]]:
    """Return the groups by key, in the order of their first members; members keep their order."""
    groups: dict[Key, list[Member]] = {}
    for member in members:
        groups.setdefault(key(member), []).append(member)
    return groups


def select_members(
    groups: Iterable[Sequence[Member]],
    failed: Callable[[Member], object] = lambda _: False,
) -> Iterator[list[Member]]:
    """Yield for each group the members for which a table has room, in their order.

    All groups share the room. Members for which `failed` holds are selected first, so that no
    failure is hidden; then the first of the others.
    """
    members = [list(group) for group in groups]
    indices = [(i, k) for i, group in enumerate(members) for k in range(len(group))]
    ordered = sorted(indices, key=lambda index: not failed(members[index[0]][index[1]]))
    selected = set(ordered[:MOST_ROWS])
    for i, group in enumerate(members):
        yield [member for k, member in enumerate(group) if (i, k) in selected]


def describe_excerpt(count: int, visible: int, failures: int = 0) -> str:
    """Return a sentence on the visible rows of a table that has no room for all; "" if all fit.

    >>> describe_excerpt(5000, 600, failures=3)
    '600 of 5,000 are shown, the 3 that did not end well among them; all are in results.json.'
    """
    if visible >= count:
        return ""
    failure_note = ""
    if failures > visible:
        failure_note = f", all of them of the {whole(failures)} that did not end well"
    elif failures:
        failure_note = f", the {whole(failures)} that did not end well among them"
    return f"{whole(visible)} of {whole(count)} are shown{failure_note}; all are in results.json."
