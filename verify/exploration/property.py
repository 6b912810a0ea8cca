"""What a property is: a sentence that always holds, and how one sample is held against it."""

from collections.abc import Callable
from dataclasses import dataclass

from verify.exploration.sample import Sample


class Violation(Exception):  # noqa: N818 - it is a finding about the code, not a failure of it
    """A sample for which a property does not hold; the message is one line with the numbers."""


@dataclass(frozen=True)
class Property:
    """`holds(sample)`: True, or False where the sentence does not speak of the sample.

    It raises Violation where the sentence is wrong for it. Any other exception is an error of the
    code under test, too. `scheme`: that of which it speaks, where this is not the sample's.
    """

    name: str
    sentence: str
    holds: Callable[[Sample], bool]
    scheme: str = ""
