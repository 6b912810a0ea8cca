"""Names for the decimals that stand in formulas without one."""

import re
from collections.abc import Iterable, Mapping

from verify.algebra.formula import RESERVED
from verify.errors import InputError
from verify.schemes.printed.printed_numbers import PrintedNumbers, unit_of, unit_of_quotient

MOST_ENTRIES = 2000
_SHARED_DECIMALS = 8  # decimals; longer numbers with the same text share a name
# A long decimal in a formula, or a long quotient that no neighbouring operator takes apart.
_LONG_INSIDE = re.compile(
    r"(?<![\w.])\d*\.\d{8,}(?:[eE][+-]?\d+)?(?![\w.])|(?<![\w.*/^])\d{6,}/\d{7,40}(?![\w.^*])",
    re.ASCII,
)
_WRAPPED = re.compile(r"\([^()]*\)")


class Naming:
    """Names for the decimals and long quotients of a table that have none.

    Numbers of 8 decimals or more with the same text, up to the sign, are one number.
    """

    def __init__(self, numbers: Mapping[str, str]) -> None:
        for name in numbers:
            if not (name.isascii() and name.isidentifier()) or name in RESERVED:
                problem = "is no name of a number: letters, digits and _, and no function's name"
                raise InputError("numbers", name, problem)
        self.numbers = {**numbers}
        self._names = {_size(text): name for name, text in numbers.items() if _is_long(text)}

    def entry(self, text: str, label: str) -> str:
        """Return a table's text with names in place of its decimals.

        `label`: the name for a text that is one decimal, and the beginning of the names for long
        decimals within a formula.
        """
        text = text.strip()
        # Brackets around a whole entry would hide a plain decimal.
        while _WRAPPED.fullmatch(text):
            text = text[1:-1].strip()
        if not text:
            return "0"
        if unit_of(text) is not None or unit_of_quotient(text) is not None:
            return self._name_of(text, label)
        counter = iter(range(1, MOST_ENTRIES))
        return _LONG_INSIDE.sub(
            lambda m: self._name_of(m[0], f"{label}_{next(counter)}") if _is_long(m[0]) else m[0],
            text,
        )

    def _name_of(self, text: str, label: str) -> str:
        name = self._names.get(_size(text)) if _is_long(text) else None
        if name is None:
            name = label
            while name in self.numbers:
                name += "_"
            self.numbers[name] = text
            if _is_long(text):
                self._names[_size(text)] = name
        same = self.numbers[name].startswith("-") == text.startswith("-")
        return name if same else f"(-{name})"

    def entries(self, texts: Iterable[str], label: str) -> tuple[str, ...]:
        """Return the entries of several texts, whose labels are numbered from 1."""
        return tuple(self.entry(x, f"{label}{_place(k)}") for k, x in enumerate(texts))

    @property
    def printed_numbers(self) -> PrintedNumbers:
        """All numbers that have been named by now."""
        return PrintedNumbers(self.numbers)


def _size(text: str) -> str:
    """Return the text without its sign."""
    return text.lstrip("+-")


def _is_long(text: str) -> bool:
    unit = unit_of(text) or unit_of_quotient(text)
    return unit is not None and unit <= 1 / 10**_SHARED_DECIMALS


def _place(k: int) -> str:
    return str(k + 1) if k < 9 else f"_{k + 1}"
