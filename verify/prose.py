"""Prose of results: parts of text, formulas and numbers, which each medium shows in its own way.

    prose("ΔJ = ", Formula("-3*h**3*delta*p*q"), " + O(", Formula("h^4"), ")")
    read_prose("The coefficient of `h^m` in det J vanishes")   # as people write it: formulas quoted
    read_prose("so that ``|Λ| ≤ e^(Nε) − 1``.")                # on a line of its own, quoted twice

A Prose is a string, its own plain text, so whatever takes a string takes it; a page typesets its
`parts`.
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Self

_BACKTICK = "`"
_DISPLAY_PATTERN = re.compile("``([^`]+)``")
_NUMBER_PATTERN = re.compile(r"[+-]?[0-9]+(\.[0-9]+)?([eE][+-]?[0-9]+)?(/[0-9]+)?", re.ASCII)


class Formula(str):
    """A formula: as users write it (`h**3*p`), or in the notation of prose (`H_qq`, `e^(Nε)`)."""

    __slots__ = ()


class Display(str):
    """A formula on a line of its own, in the notation of prose."""

    __slots__ = ()


class Number(str):
    """A number in digits, such as -1.5, 2.1e-06 or 1/3."""

    __slots__ = ()


_KINDS: dict[str, type[str]] = {"formula": Formula, "display": Display, "number": Number}
PartData = str | dict[str, str]


class Prose(str):
    """Plain text that knows its parts: `str`, `Formula`, `Display` and `Number`.

    No two parts of plain text stand side by side.

    >>> found = Prose("at q = ", Number("0.5"), Prose(" it is ", Formula("h**2")))
    >>> str(found), found.parts
    ('at q = 0.5 it is h**2', ('at q = ', '0.5', ' it is ', 'h**2'))
    >>> found.as_data()
    ['at q = ', {'number': '0.5'}, ' it is ', {'formula': 'h**2'}]
    """

    __slots__ = ("parts",)
    parts: tuple[str, ...]

    def __new__(cls, *parts: str) -> Self:
        flat: list[str] = []
        for part in _unpack_parts(parts):
            # Texts side by side are merged, so that equal proses have equal parts.
            if flat and type(part) is type(flat[-1]) is str:
                flat[-1] += part
            elif part:
                flat.append(part)
        instance = super().__new__(cls, "".join(flat))
        instance.parts = tuple(flat)
        return instance

    def __reduce__(self) -> tuple[Any, ...]:
        # By the way of str it would be pickled without its parts.
        return type(self), self.parts

    def __add__(self, other: str) -> "Prose":
        return Prose(self, other)

    def __radd__(self, other: str) -> "Prose":
        return Prose(other, self)

    def join(self, parts: Iterable[str]) -> "Prose":
        """Join the parts with this text between each two of them."""
        between = [each for part in parts for each in (self, part)]
        return Prose(*between[1:])

    def partition(self, sep: str) -> "tuple[Prose, str, Prose]":
        """Split at the first `sep` that stands in a part of plain text; each side keeps its parts.

        >>> prose("ΔJ = ", Formula("a; b"), "; and so on").partition("; ")[0].parts
        ('ΔJ = ', 'a; b')
        """
        for index, part in enumerate(self.parts):
            if type(part) is str and sep in part:
                before, _, after = part.partition(sep)
                return (
                    Prose(*self.parts[:index], before),
                    sep,
                    Prose(after, *self.parts[index + 1 :]),
                )
        return self, "", Prose()

    def as_data(self) -> list[PartData]:
        """Return the parts for JSON: plain text as a string, others as {kind: text}."""
        names = {kind: name for name, kind in _KINDS.items()}
        return [{names[type(p)]: str(p)} if type(p) in names else str(p) for p in self.parts]

    @classmethod
    def from_data(cls, data: object) -> Self:
        """Read the output of `as_data`, or a plain text. ValueError for anything else."""
        if isinstance(data, str):
            return cls(data)
        if not isinstance(data, list | tuple):
            raise ValueError("prose is a text or a list of its parts")
        return cls(*(_parse_part(each) for each in data))


def prose(*parts: str) -> Prose:
    """Return the parts as one prose; a Prose among them contributes its own parts."""
    return Prose(*parts)


def number(text: str) -> str:
    """Return the text as a Number if it is one; other texts, such as `unknown`, as they are."""
    return Number(text) if _NUMBER_PATTERN.fullmatch(text) else text


def count(n: int, thing: str) -> str:
    """Return the number and the thing, in the singular or the plural.

    >>> count(1, "stage"), count(2, "stage")
    ('1 stage', '2 stages')
    """
    return f"{n} {thing}{'' if n == 1 else 's'}"


def join_prose(between: str, parts: Iterable[str]) -> Prose:
    """Join the parts with `between` between each two of them."""
    return Prose(between).join(parts)


def read_prose(text: str) -> Prose:
    """Read a text that people write: a formula stands between two backticks, as `` `h^3` ``.

    >>> read_prose("of order `h^3`, says the paper").parts
    ('of order ', 'h^3', ', says the paper')
    >>> read_prose("at q = `-0.5`").as_data()  # a quoted decimal is a Number
    ['at q = ', {'number': '-0.5'}]

    A formula between double backticks is on a line of its own. If the number of backticks is odd,
    the last one is text. A Prose is returned as it is.
    """
    if isinstance(text, Prose):
        return text
    pieces = _DISPLAY_PATTERN.split(text)
    return Prose(*(Display(p) if i % 2 else Prose(*_parse_inline(p)) for i, p in enumerate(pieces)))


def _parse_inline(text: str) -> Iterator[str]:
    pieces = text.split(_BACKTICK)
    if len(pieces) % 2 == 0:
        # An odd number of backticks: the last one has no partner, and is text.
        pieces[-2:] = [_BACKTICK.join(pieces[-2:])]
    yield from (_parse_quoted(p) if i % 2 else p for i, p in enumerate(pieces))


def _parse_quoted(text: str) -> str:
    return Number(text) if _NUMBER_PATTERN.fullmatch(text) else Formula(text)


def _unpack_parts(parts: Iterable[str]) -> Iterable[str]:
    for part in parts:
        if isinstance(part, Prose):
            yield from part.parts
        else:
            yield part if type(part) in _KINDS.values() else str(part)


def _parse_part(data: object) -> str:
    if isinstance(data, str):
        return data
    if isinstance(data, Mapping) and len(data) == 1:
        ((name, text),) = data.items()
        if name in _KINDS and isinstance(text, str):
            return _KINDS[name](text)
    raise ValueError(f"a part of prose is a text or one of {', '.join(_KINDS)}")
