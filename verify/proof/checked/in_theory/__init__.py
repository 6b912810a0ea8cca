"""The marks of Rocq: which theorems of the shipped theory say what is proved here of a scheme.

One file each with an `APPLIES`, found by themselves. Nothing of Rocq is run for a mark: that the
theory is accepted is seen by `coqc` and by its tests, and here that it states what is named.
"""

from collections.abc import Iterator
from functools import cache
from typing import get_args

from verify.discovery import Catalogue
from verify.proof.assistant.stated import by_rocq
from verify.proof.checked.in_theory.applies import Applies
from verify.proof.checked.proved import About, Proved
from verify.prose import Prose, prose, read_prose

_FILES = Catalogue(f"{__name__}.statements", [f"{path}/statements" for path in __path__])


@cache
def all_of_them() -> tuple[Applies, ...]:
    """What each file says, in the order of what it is about."""
    found = (_FILES.module(file).APPLIES for file in _FILES.names)
    return tuple(sorted(found, key=lambda each: get_args(About).index(each.about)))


def marks(proved: Proved) -> Iterator[Prose]:
    """One for each that applies: the names of the theorems, and what they say of this scheme."""
    for each in all_of_them():
        names = each.names(proved)
        if names and each.about in proved.about and each.applies(proved):
            yield prose(by_rocq(names), ": ", read_prose(each.sentence(proved)))
