"""What of a prose is still to be parsed: formulas and numbers that stand in its text."""

import re
from collections.abc import Iterator
from typing import Any

from verify.prose import Prose

# A power, a product, an index, an enclosure, and a number that is no plain text: -1 and 2e-05.
UNMARKED = re.compile(
    r"[*^]|(?<=\S)_(?=\S)|\+/-|(?<![\w.])[0-9.]+[eE][+-]?[0-9]+\b|(?<![\w.)])-[0-9]+(?:\.[0-9]+)?\b"
)


def proses(value: Any) -> Iterator[Prose]:
    """All that there are in a result, whatever it is made of."""
    if isinstance(value, Prose):
        yield value
    elif isinstance(value, dict):
        yield from (each for x in value.values() for each in proses(x))
    elif isinstance(value, list | tuple | set | frozenset):
        yield from (each for x in value for each in proses(x))
    elif hasattr(value, "__dict__"):
        yield from proses(vars(value))


def unmarked(value: Any) -> list[tuple[str, str]]:
    """(what, the prose) for every formula or number in the texts of its proses."""
    return [
        (found[0], str(prose))
        for prose in proses(value)
        for part in prose.parts
        if type(part) is str and (found := UNMARKED.search(part))
    ]
