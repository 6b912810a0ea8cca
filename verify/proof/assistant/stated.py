"""A reference to a theorem of the shipped theory, for statements that follow from it."""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache

from verify.proof.assistant.shipped import files, text_of
from verify.prose import Formula, Prose, join_prose, prose

_STATED = re.compile(r"^\s*(?:Theorem|Lemma|Corollary)\s+(\w+)", re.MULTILINE)


@dataclass(frozen=True)
class ShippedTheorem:
    """The theorem of this name in the file of the theory that is called `file`.

    Raises ValueError where that file states no such theorem, so no reference can outlive it.
    """

    file: str
    name: str

    def __post_init__(self) -> None:
        if self.name not in _stated_theorems(self.file):
            raise ValueError(f"theorem={self}: the theory states none of this name")

    def __str__(self) -> str:
        return f"{self.file}.{self.name}"


def cite_theorems(names: Iterable[str]) -> Prose:
    """Say that the theorems FILE.NAME prove it; ValueError where one is not stated."""
    # `Shipped` checks that the theory states the theorem.
    theorems = (Formula(str(ShippedTheorem(*name.split(".")))) for name in names)
    return prose("Rocq, ", join_prose(", ", theorems))


@cache
def _stated_theorems(file: str) -> frozenset[str]:
    return frozenset(_STATED.findall(text_of(file)) if file in files() else ())
