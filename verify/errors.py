"""The errors that a user is told in one line: of input, and of where the work is done."""

import re
from collections.abc import Iterable, Mapping
from types import MappingProxyType

# What a terminal acts on, or turns the order of, instead of showing it; tabs and ends of lines not.
CONTROL = re.compile("[\0-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff]")


class _NotGiven(str):
    """The text of what was not given at all; an empty text was."""


NOT_GIVEN = _NotGiven()


class InputError(ValueError):
    """Bad input: one line that names the input, its value, if any was given, and what is allowed.

    The command line turns it into exit status 2; nothing has been computed when it is raised.
    """

    def __init__(self, name: str, value: object, problem: str) -> None:
        self.name = name
        self.value = value
        self.problem = problem
        given = "" if isinstance(value, _NotGiven) else f"={_short(value)}"
        super().__init__(without_controls(f"{name}{given}: {problem}"))

    def __reduce__(self) -> tuple[type, tuple[str, object, str]]:
        """As a worker process sends it: by its three parts, not by its message."""
        value = self.value if isinstance(self.value, _NotGiven) else _short(self.value)
        return type(self), (self.name, value, self.problem)


class LimitError(InputError):
    """Beyond what is handled exactly: too large, or of a function that is not known.

    A claim that prints it is no mistake of the file; it is left undecided.
    """


class PlaceError(RuntimeError):
    """The place where tasks run fails them: workers lost, a scheduler gone, other code there.

    One line. The command line turns it into exit status 2; what was finished is kept.
    """


def unknown(
    source: str,
    name: object,
    allowed: Iterable[str],
    more: str = "",
    aliases: Mapping[str, str] = MappingProxyType({}),
) -> InputError:
    """The error for a name that is none of those allowed; the nearest of them is asked for.

    `more` is said after them; `aliases` are other names, with those that they stand for.
    """
    from difflib import get_close_matches

    names = list(allowed)
    plain = {**aliases, **{plain_name(each): each for each in reversed(names)}}
    given = plain_name(str(name))
    near = [x for x in plain if len(x) > 3 and re.match(rf"{re.escape(x)}\b", given)]
    near = sorted(near, key=len, reverse=True) or get_close_matches(given, plain, 1, 0.6)
    meant = is_meant(plain[near[0]] if near else "")
    return InputError(source, name, f"unknown; {meant}allowed: {', '.join(names)}{more}")


def nearest(name: str, names: Iterable[str]) -> str:
    """Of those names the one that is meant, as far as its letters tell; empty where none is."""
    from difflib import get_close_matches

    return next(iter(get_close_matches(name, list(names), 1, 0.6)), "")


def is_meant(name: str) -> str:
    """The question whether that name is meant, and a blank; empty where there is none."""
    return f"is {name} meant? " if name else ""


def plain_name(name: str) -> str:
    """The name in small letters, a dash in place of spaces, dashes and underscores.

    >>> plain_name(" Double_Well ")
    'double-well'
    """
    return re.sub(r"[\s_-]+", "-", name.strip().lower())


def without_controls(text: str) -> str:
    """The text as a terminal may be given it."""
    return "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text)


def _short(value: object) -> str:
    """The value as one short line, however long or many-lined the user's text was."""
    try:
        text = value if isinstance(value, str) else repr(value)
    except ValueError:  # an integer beyond Python's limit of printed digits
        text = f"(a {type(value).__name__} of very many digits)"
    text = " ".join(text.split()) or repr(text)
    if len(text) > 78:  # both ends: a path is known by its last part
        text = f"{text[:38]}…{text[-39:]}"
    return without_controls(text)
