"""One exact fact that an argument rests on."""

from dataclasses import dataclass
from typing import Any

ALGEBRA = "exact algebra"
NUMBERS = "exact numbers"
BALLS = "enclosures"


@dataclass(frozen=True)
class Check:
    """One exact fact that an argument rests on; `shown` is its value in a few words, `how` it is
    known.

    Both texts are written as `read_prose` takes them, with formulas quoted.
    """

    what: str
    holds: bool
    shown: str
    how: str = ALGEBRA


def vanishes(what: str, *elements: Any) -> Check:
    """The check that polynomials in normal form are zero."""
    wrong = [x for x in elements if x != 0]
    return Check(what, not wrong, f"{len(wrong[0])} terms are left" if wrong else "0")
