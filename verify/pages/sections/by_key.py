"""Things in groups, each group under what its members have in common."""

from collections.abc import Callable, Iterable
from typing import TypeVar

Key = TypeVar("Key")
Member = TypeVar("Member")


def by_key(found: Iterable[Member], key: Callable[[Member], Key]) -> dict[Key, list[Member]]:
    """The groups in the order in which their first members stand; these keep theirs."""
    groups: dict[Key, list[Member]] = {}
    for each in found:
        groups.setdefault(key(each), []).append(each)
    return groups
