"""Step maps written out in other languages: `languages/` has one a file, found by itself."""

from typing import TYPE_CHECKING, Protocol

from verify.discovery import Catalogue
from verify.errors import unknown

if TYPE_CHECKING:
    from verify.schemes.export.program import Program

_FILES = Catalogue(f"{__name__}.languages", [f"{folder}/languages" for folder in __path__])


class Language(Protocol):
    """A language's file: `SUFFIX`, that of its files; `RESERVED`, words that are no names there;
    and `written(program)`, the whole text."""

    SUFFIX: str
    RESERVED: frozenset[str]

    def written(self, program: "Program") -> str: ...


def names() -> tuple[str, ...]:
    """The languages."""
    return _FILES.names


def get(name: str) -> Language:
    """The language of that name, in any case; InputError where there is none."""
    plain = name.strip().lower() if isinstance(name, str) else name
    if plain not in _FILES:
        raise unknown("language", name, names())
    found: Language = _FILES.module(plain)
    return found
