"""Errors that a user reads in one line: of input, and of the place where tasks run."""

import re
from collections.abc import Iterable, Mapping
from types import MappingProxyType

# Characters that a terminal does not show, but obeys or turns the direction of the text by: control
# characters, marks of direction; and lone surrogates. Tabs and line feeds are harmless.
CONTROL_CHARACTERS = re.compile(
    "[\0-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff]"
)


class _NotGiven(str):
    """The text in place of a missing value; an empty text is a value."""


NOT_GIVEN = _NotGiven()


class InputError(ValueError):
    """Bad input: one line that names the input, its value, if any was given, and what is allowed.

    The command line turns it into exit status 2. Nearly all input is checked before anything is
    computed.
    """

    def __init__(self, name: str, value: object, problem: str) -> None:
        self.name = name
        self.value = value
        self.problem = problem
        value_text = "" if isinstance(value, _NotGiven) else f"={_shorten(value)}"
        super().__init__(without_controls(f"{name}{value_text}: {problem}"))

    def __reduce__(self) -> tuple[type, tuple[str, object, str]]:
        """Pickle the error by its three parts, as a worker process sends it."""
        # BaseException would pickle the message alone, and call the class with one argument.
        value = self.value if isinstance(self.value, _NotGiven) else _shorten(self.value)
        return type(self), (self.name, value, self.problem)


class LimitError(InputError):
    """Input beyond what is handled exactly: too large, or with an unknown function.

    A claim with such a formula is not a mistake in its file, and is left undecided.
    """


class PlaceError(RuntimeError):
    """A failure of the place where tasks run: workers or the scheduler lost, or another version.

    The message is one line. The command line turns it into exit status 2; finished tasks are kept.
    """


def unknown_name(
    source: str,
    name: object,
    candidates: Iterable[str],
    more: str = "",
    aliases: Mapping[str, str] = MappingProxyType({}),
) -> InputError:
    """Return the error for a name outside `candidates`, which suggests the nearest of them.

    `more` ends the message; `aliases` maps each further name to the one that it stands for.
    """
    from difflib import get_close_matches

    names = list(candidates)
    plain = {**aliases, **{plain_name(each): each for each in reversed(names)}}
    plain_text = plain_name(str(name))
    # A name that begins the text as a whole word comes first: letter by letter another name may be
    # nearer to `duffing oscillator` than `duffing` is.
    nearest = [x for x in plain if len(x) > 3 and re.match(rf"{re.escape(x)}\b", plain_text)]
    nearest = sorted(nearest, key=len, reverse=True) or get_close_matches(plain_text, plain, 1, 0.6)
    question = format_suggestion(plain[nearest[0]] if nearest else "")
    return InputError(source, name, f"unknown; {question}allowed: {', '.join(names)}{more}")


def find_nearest(name: str, names: Iterable[str]) -> str:
    """Return the one of `names` that is spelt most like `name`; empty if none is similar."""
    from difflib import get_close_matches

    return next(iter(get_close_matches(name, list(names), 1, 0.6)), "")


def format_suggestion(name: str) -> str:
    """Return the question whether that name is meant, with a blank; an empty text for no name."""
    return f"is {name} meant? " if name else ""


def plain_name(name: str) -> str:
    """Return the name in small letters, with a dash for each run of spaces, dashes, underscores.

    >>> plain_name(" Double_Well ")
    'double-well'
    """
    return re.sub(r"[\s_-]+", "-", name.strip().lower())


def without_controls(text: str) -> str:
    """Return the text with a replacement character for each that is not printable, as tabs are."""
    return "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text)


def _shorten(value: object) -> str:
    """Return the value as one short line, however long the user's text is."""
    try:
        text = value if isinstance(value, str) else repr(value)
    except ValueError:  # an integer beyond Python's limit of printed digits
        text = f"(a {type(value).__name__} of very many digits)"
    text = " ".join(text.split()) or repr(text)
    if len(text) > 78:  # both ends stay, as the last part of a path tells most
        text = f"{text[:38]}…{text[-39:]}"
    return without_controls(text)
