"""What a property is: a sentence that always holds, and how one sample is held against it."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TypeVar

from verify.exploration.sample import Sample

T = TypeVar("T")


class Violation(Exception):  # noqa: N818 - it is a finding about the code, not a failure of it
    """A sample for which a property does not hold; the message is one line with the numbers."""


class Silent(Exception):  # noqa: N818 - nothing is wrong
    """A sentence that does not speak of a sample, or speaks of what cannot be had of it."""


def only_if(condition: bool) -> None:
    """Silent unless the sentence speaks of the sample."""
    if not condition:
        raise Silent


def known(x: T | None) -> T:
    """What is there; Silent where it is None."""
    if x is None:
        raise Silent
    return x


@contextmanager
def silent_at(*errors: type[Exception]) -> Iterator[None]:
    """Makes these errors Silent: what is asked for cannot be had."""
    try:
        yield
    except errors:
        raise Silent from None


@dataclass(frozen=True)
class Property:
    """`check(sample)` raises Violation where the sentence is wrong for it, and Silent where it does
    not speak of it.

    Any other exception is an error of the code under test, too. `scheme`: that of which it speaks,
    where this is not the sample's. `speaks_of`: the samples that it is asked of.
    """

    name: str
    sentence: str
    check: Callable[[Sample], None]
    scheme: str = ""
    speaks_of: Callable[[Sample], bool] = lambda _: True

    def holds(self, sample: Sample) -> bool:
        """True, or False where the sentence does not speak of the sample; else as `check`."""
        try:
            only_if(self.speaks_of(sample))
            self.check(sample)
        except Silent:
            return False
        return True
