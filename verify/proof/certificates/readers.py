"""Readers of a certificate's JSON: each returns a value of one kind, or raises ValueError."""

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fractions import Fraction

Monomial = tuple[str, ...]  # sorted names; a name stands once for each power
Poly = dict[Monomial, Fraction]

PLANE = ("p", "q")
MOST_ORDERS = 128
MOST_DEGREES = 16
MOST_FACTORS = 256  # limit for a term
_MOST_BITS = 1 << 15  # limit for a coefficient that is a sum of several terms
RESERVED = {"p", "q", "h", "t", "sin", "cos", "exp", "log", "sqrt", "pi", "e", "i", "E", "I"}
_NUMBER = re.compile(r"(-?[0-9]{1,2000})(?:/([1-9][0-9]{0,1999}))?")


def need(holds: object, what: str) -> None:
    """Raise ValueError with the message `what` unless the condition holds."""
    if not holds:
        raise ValueError(what)


@dataclass(frozen=True)
class CoordinateLayout:
    """The names in a certificate for p and q, or with `degrees` for p1 … pn, q1 … qn.

    `single`: True for p and q; a 2-form is then written as its one entry, otherwise as a list.
    `maps`: the names of the map's entries. `defect`, `potential`: patterns of identities' names.
    """

    degrees: int
    coordinates: tuple[str, ...]
    single: bool
    maps: str
    defect: str
    potential: str


def layout_in(degrees: int | None) -> CoordinateLayout:
    """Return the layout for n degrees of freedom; None for p and q."""
    if degrees is None:
        return CoordinateLayout(1, PLANE, True, "p_next, q_next", "det {}", "potential")
    names = tuple(f"{letter}{k}" for letter in PLANE for k in range(1, degrees + 1))
    return CoordinateLayout(degrees, names, False, "next", "S {} {} {}", "potential {} {}")


class UnreadEntries:
    """The entries that are still unread, and those that every certificate may have.

    `timed`: True if H depends on t. `layout`: the names of the coordinates.
    """

    def __init__(self, data: object) -> None:
        self.unread = dict(object_of(data, "the certificate"))
        self.unread.pop("format", None)  # checked when the file is opened
        self.timed = "time_dependent" in self.unread and self.flag("time_dependent")
        several = "degrees" in self.unread
        self.layout = layout_in(self.whole("degrees", 1, MOST_DEGREES) if several else None)

    def take(self, name: str) -> object:
        """Return the entry and mark it as read; ValueError if it is missing."""
        need(name in self.unread, f"{name} is missing")
        return self.unread.pop(name)

    def flag(self, name: str) -> bool:
        """Read true or false."""
        value = self.take(name)
        need(isinstance(value, bool), f"{name}: {short(value)} is not true or false")
        return value is True

    def whole(self, name: str, least: int, most: int = MOST_ORDERS) -> int:
        """Read a whole number in this range."""
        value = self.take(name)
        whole = isinstance(value, int) and not isinstance(value, bool)
        problem = f"{name}: {short(value)} is no whole number from {least} to {most}"
        need(whole and least <= value <= most, problem)  # type: ignore[operator]
        return value  # type: ignore[return-value]


def poly_of(data: object, what: str, is_name: Callable[[str], bool]) -> Poly:
    """Read a polynomial: a list of terms in names that `is_name` accepts."""
    total: Poly = {}
    for term in array_of(data, what):
        number, *names = array_of(term, what) or [None]
        need(len(names) <= MOST_FACTORS, f"{what}: has more than {MOST_FACTORS} factors")
        for name in names:
            need(is_name(text_of(name, what)), f"{what}: {short(name)} stands for nothing")
        key = tuple(sorted(map(str, names)))
        total[key] = total.get(key, Fraction(0)) + number_of(number, what)
        # Without the limit, many different denominators would make each addition slower.
        need(bits_of(total[key]) <= _MOST_BITS, f"{what}: a coefficient grows too long")
    return {names: c for names, c in total.items() if c}


def bits_of(x: Fraction) -> int:
    """Return the number of bits of numerator and denominator together."""
    return x.numerator.bit_length() + x.denominator.bit_length()


def collect_terms(terms: Iterable[tuple[Monomial, Fraction]]) -> Poly:
    """Sum the terms: sort the names, and drop the terms that cancel."""
    total: Poly = {}
    for names, c in terms:
        key = tuple(sorted(names))
        total[key] = total[key] + c if key in total else c
    return {names: c for names, c in total.items() if c}


def object_of(data: object, what: str) -> dict[str, object]:
    """Return the data if they are an object, else raise ValueError."""
    need(isinstance(data, dict), f"{what}: {short(data)} is no object")
    return data  # type: ignore[return-value]


def array_of(data: object, what: str) -> list[object]:
    """Return the data if they are a list, else raise ValueError."""
    need(isinstance(data, list), f"{what}: {short(data)} is no list")
    return data  # type: ignore[return-value]


def text_of(data: object, what: str) -> str:
    """Return the data if they are a text, else raise ValueError."""
    need(isinstance(data, str), f"{what}: {short(data)} is no text")
    return data  # type: ignore[return-value]


def number_of(data: object, what: str) -> Fraction:
    """Read a rational number, which is a text such as "-3/2"."""
    match = _NUMBER.fullmatch(data) if isinstance(data, str) else None
    need(match, f"{what}: {short(data)} is no rational number such as '-3/2'")
    above, below = match.groups()  # type: ignore[union-attr]
    return Fraction(int(above), int(below or 1))


def short(data: object) -> str:
    """Shorten the data for a message."""
    text = ascii(data) if not isinstance(data, list | dict) else type(data).__name__
    return text if len(text) <= 40 else f"{text[:40]}…"
