"""What a property is: a sentence that always holds, and how one sample is held against it."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TypeVar

from verify.exploration.sample import Sample
from verify.exploration.sample_in_degrees import SampleInDegrees

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

    `in_degrees` does so of a sample in n degrees of freedom; a property without one speaks of none.
    Any other exception is an error of the code under test, too. `scheme`: that of which it speaks,
    where this is not the sample's.
    """

    name: str
    sentence: str
    check: Callable[[Sample], None] | None
    scheme: str = ""
    in_degrees: Callable[[SampleInDegrees], None] | None = None

    def holds(self, sample: Sample | SampleInDegrees) -> bool:
        """True, or False where the sentence does not speak of the sample; else as `check`."""
        try:
            if isinstance(sample, Sample):
                known(self.check)(sample)
            else:
                known(self.in_degrees)(sample)
        except Silent:
            return False
        return True
