"""The marks of Rocq: the theorems of the shipped theory that state what is proved of a scheme.

Each is a file with an `APPLIES`, discovered by a catalogue. Rocq is not run for a mark: `coqc` and
the tests check that the theory is accepted; here it is checked that it states the theorems named.
"""

from collections.abc import Iterator
from functools import cache
from typing import get_args

from verify.discovery import Catalogue
from verify.proof.assistant.stated import cite_theorems
from verify.proof.checked.in_theory.applies import Applies
from verify.proof.checked.proved import About, ProvedStatement
from verify.prose import Prose, prose, read_prose

_FILES = Catalogue(f"{__name__}.statements", [f"{path}/statements" for path in __path__])


@cache
def all_of_them() -> tuple[Applies, ...]:
    """Return the `APPLIES` of each file, ordered by what it is about."""
    statements = (_FILES.module(file).APPLIES for file in _FILES.names)
    return tuple(sorted(statements, key=lambda each: get_args(About).index(each.about)))


def marks(proved: ProvedStatement) -> Iterator[Prose]:
    """Yield, for each that applies, the theorems' names and what they say of this scheme."""
    for each in all_of_them():
        names = each.names(proved)
        if names and each.about in proved.about and each.applies(proved):
            yield prose(cite_theorems(names), ": ", read_prose(each.sentence(proved)))
