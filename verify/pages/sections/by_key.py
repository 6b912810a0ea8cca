"""Grouping by a key that the members of a group have in common."""

from collections.abc import Callable, Iterable
from typing import TypeVar

Key = TypeVar("Key")
Member = TypeVar("Member")


def by_key(members: Iterable[Member], key: Callable[[Member], Key]) -> dict[Key, list[Member]]:
    """Return the groups by key, in the order of their first members; members keep their order."""
    groups: dict[Key, list[Member]] = {}
    for each in members:
        groups.setdefault(key(each), []).append(each)
    return groups
