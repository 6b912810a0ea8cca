"""A theorem of the shipped theory, named by who says that something follows from it."""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache

from verify.proof.assistant.shipped import files, text_of
from verify.prose import Formula, Prose, joined, prose

_STATED = re.compile(r"^\s*(?:Theorem|Lemma|Corollary)\s+(\w+)", re.MULTILINE)


@dataclass(frozen=True)
class Shipped:
    """The theorem of this name in the file of the theory that is called `file`.

    ValueError where that file states no such theorem, so that what names one cannot outlive it.
    """

    file: str
    name: str

    def __post_init__(self) -> None:
        if self.name not in _stated(self.file):
            raise ValueError(f"theorem={self}: the theory states none of this name")

    def __str__(self) -> str:
        return f"{self.file}.{self.name}"


def by_rocq(names: Iterable[str]) -> Prose:
    """That theorems of these names, as FILE.NAME, say it. ValueError where one is not stated."""
    theorems = (Formula(str(Shipped(*name.split(".")))) for name in names)
    return prose("Rocq, ", joined(", ", theorems))


@cache
def _stated(file: str) -> frozenset[str]:
    return frozenset(_STATED.findall(text_of(file)) if file in files() else ())
