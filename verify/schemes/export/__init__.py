"""Step maps written as code: `languages/` has one language a file, found by its name."""

from typing import TYPE_CHECKING, Protocol

from verify.discovery import Catalogue
from verify.errors import unknown_name

if TYPE_CHECKING:
    from verify.schemes.export.program import Program

_FILES = Catalogue(f"{__name__}.languages", [f"{folder}/languages" for folder in __path__])


_CPP_NAMES = dict.fromkeys(("c++", "cpp", "cxx"), "c")
_CPP_ADVICE = '; what c writes is C++ too; check-integrator checks a C++ step that is extern "C"'


class Language(Protocol):
    """The module of a language.

    `SUFFIX`: the suffix of its files. `RESERVED`: words that cannot be names in the language.
    `render(program)` returns the whole text.
    """

    SUFFIX: str
    RESERVED: frozenset[str]

    def render(self, program: "Program") -> str: ...


def names() -> tuple[str, ...]:
    """Return the names of the languages."""
    return _FILES.names


def get(name: str) -> Language:
    """Return the language of that name, in any case; InputError if there is none."""
    plain = name.strip().lower() if isinstance(name, str) else name
    if plain not in _FILES:
        raise unknown_name(
            "language", name, names(), _CPP_ADVICE if plain in _CPP_NAMES else "", _CPP_NAMES
        )
    language: Language = _FILES.module(plain)
    return language
