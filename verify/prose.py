"""What results say: text, formulas and numbers in turn, which each medium shows in its way.

    prose("ΔJ = ", Formula("-3*h**3*delta*p*q"), " + O(", Formula("h^4"), ")")
    read_prose("The coefficient of `h^m` in det J vanishes")   # what people write: formulas quoted
    read_prose("so that ``|Λ| ≤ e^(Nε) − 1``.")                # on a line of its own, quoted twice

A Prose is its own plain text, so whatever takes a string takes it; a page sets its `parts`.
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Self

_QUOTE = "`"
_DISPLAY = re.compile("``([^`]+)``")
_NUMBER = re.compile(r"[+-]?[0-9]+(\.[0-9]+)?([eE][+-]?[0-9]+)?(/[0-9]+)?", re.ASCII)


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
    """Plain text that knows its parts: `str`, `Formula`, `Display` and `Number`; no two texts side
    by side.

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
        for part in _unpacked(parts):
            if flat and type(part) is type(flat[-1]) is str:
                flat[-1] += part
            elif part:
                flat.append(part)
        made = super().__new__(cls, "".join(flat))
        made.parts = tuple(flat)
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), self.parts

    def __add__(self, other: str) -> "Prose":
        return Prose(self, other)

    def __radd__(self, other: str) -> "Prose":
        return Prose(other, self)

    def join(self, parts: Iterable[str]) -> "Prose":
        """The parts with this text between each two of them."""
        between = [each for part in parts for each in (self, part)]
        return Prose(*between[1:])

    def partition(self, sep: str) -> "tuple[Prose, str, Prose]":
        """As of a str, at the first `sep` within a text; each side keeps its parts.

        >>> prose("ΔJ = ", Formula("a; b"), "; and so on").partition("; ")[0].parts
        ('ΔJ = ', 'a; b')
        """
        for at, part in enumerate(self.parts):
            if type(part) is str and sep in part:
                before, _, after = part.partition(sep)
                return Prose(*self.parts[:at], before), sep, Prose(after, *self.parts[at + 1 :])
        return self, "", Prose()

    def as_data(self) -> list[PartData]:
        """The parts as JSON has them: text as a string, the others under the name of their kind."""
        names = {kind: name for name, kind in _KINDS.items()}
        return [{names[type(p)]: str(p)} if type(p) in names else str(p) for p in self.parts]

    @classmethod
    def of_data(cls, data: object) -> Self:
        """What `as_data` gave, or a plain text. ValueError for anything else."""
        if isinstance(data, str):
            return cls(data)
        if not isinstance(data, list | tuple):
            raise ValueError("prose is a text or a list of its parts")
        return cls(*(_part_of(each) for each in data))


def prose(*parts: str) -> Prose:
    """The parts as one prose; a Prose among them gives its own parts."""
    return Prose(*parts)


def number(text: str) -> str:
    """A Number where the text is one; else the text, such as `unknown`."""
    return Number(text) if _NUMBER.fullmatch(text) else text


def count(n: int, one: str) -> str:
    """So many of a thing, in the singular or the plural.

    >>> count(1, "stage"), count(2, "stage")
    ('1 stage', '2 stages')
    """
    return f"{n} {one}{'' if n == 1 else 's'}"


def joined(between: str, parts: Iterable[str]) -> Prose:
    """The parts with `between` between each two of them."""
    return Prose(between).join(parts)


def read_prose(text: str) -> Prose:
    """What people write: `` `h^3` `` is a formula, and so is what stands between any two backticks.

    >>> read_prose("of order `h^3`, says the paper").parts
    ('of order ', 'h^3', ', says the paper')
    >>> read_prose("at q = `-0.5`").as_data()  # a quoted decimal is a Number
    ['at q = ', {'number': '-0.5'}]

    What two backticks quote on either side is on a line of its own. A backtick without its partner
    is text; a Prose is itself.
    """
    if isinstance(text, Prose):
        return text
    pieces = _DISPLAY.split(text)
    return Prose(*(Display(p) if i % 2 else Prose(*_in_line(p)) for i, p in enumerate(pieces)))


def _in_line(text: str) -> Iterator[str]:
    pieces = text.split(_QUOTE)
    if len(pieces) % 2 == 0:
        pieces[-2:] = [_QUOTE.join(pieces[-2:])]
    yield from (_quoted(p) if i % 2 else p for i, p in enumerate(pieces))


def _quoted(text: str) -> str:
    return Number(text) if _NUMBER.fullmatch(text) else Formula(text)


def _unpacked(parts: Iterable[str]) -> Iterable[str]:
    for part in parts:
        if isinstance(part, Prose):
            yield from part.parts
        else:
            yield part if type(part) in _KINDS.values() else str(part)


def _part_of(data: object) -> str:
    if isinstance(data, str):
        return data
    if isinstance(data, Mapping) and len(data) == 1:
        ((name, text),) = data.items()
        if name in _KINDS and isinstance(text, str):
            return _KINDS[name](text)
    raise ValueError(f"a part of prose is a text or one of {', '.join(_KINDS)}")
