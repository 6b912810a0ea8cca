"""Properties: sentences that hold for every sample, each with the check of one sample."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TypeVar

from verify.exploration.sample import Sample

T = TypeVar("T")


class Violation(Exception):  # noqa: N818 - it is a finding about the code, not a failure of it
    """A property does not hold for a sample; the message is one line with the numbers."""


class Silent(Exception):  # noqa: N818 - nothing is wrong
    """A property does not apply to a sample, or its quantities cannot be computed for it."""


def only_if(condition: bool) -> None:
    """Raise Silent unless the condition under which the property applies is met."""
    if not condition:
        raise Silent


def require_value(x: T | None) -> T:
    """Return the value; raise Silent if it is None."""
    if x is None:
        raise Silent
    return x


@contextmanager
def silent_at(*errors: type[Exception]) -> Iterator[None]:
    """Turn these errors into Silent: the property's quantities cannot be computed."""
    try:
        yield
    except errors:
        raise Silent from None


@dataclass(frozen=True)
class Property:
    """A sentence with its check.

    `check(sample)` raises Violation if the sentence is wrong for the sample, and Silent if it does
    not apply. Any other exception is an error of the code under test, too. `scheme`: the scheme
    that it tests, if this is not the sample's. `speaks_of`: the samples to which it applies.
    """

    name: str
    sentence: str
    check: Callable[[Sample], None]
    scheme: str = ""
    speaks_of: Callable[[Sample], bool] = lambda _: True

    def holds(self, sample: Sample) -> bool:
        """Return True if the property holds, and False if it does not apply; else as `check`."""
        try:
            only_if(self.speaks_of(sample))
            self.check(sample)
        except Silent:
            return False
        return True
