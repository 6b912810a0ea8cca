"""A guess at the number that a user meant by a text: the number to write instead."""

import re
import unicodedata
from collections.abc import Iterator
from fractions import Fraction

ALLOWED = "allowed: 0.001, 1e-3, 7/3"
_DECIMAL = r"(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_NUMBER = re.compile(rf"[+-]?{_DECIMAL}(?:/\d+)?", re.ASCII)
_QUOTIENT = re.compile(rf"([+-]?{_DECIMAL})/({_DECIMAL})", re.ASCII)
_GROUPED = re.compile(r"[+-]?\d{1,3}(,\d{3})+", re.ASCII)
_MAX_LENGTH = 60  # characters; a number is guessed for texts up to this length


def number_mistake(text: str) -> str:
    """Return the reason why a text is no exact number, and what to write instead."""
    meant = next(_guess_numbers(text), None) if len(text) <= _MAX_LENGTH else None
    if meant is not None:
        return f"is no number as it is written; write {meant}"
    plain = _plain(text[:_MAX_LENGTH]).lower()
    if re.search(r"pi|π|sqrt|√", plain) or re.fullmatch(r"[+-]?(\d+\*)?e", plain):
        more = "numbers are rational; write as many digits as are wanted, as 1.5707963"
    elif re.search(r"°|deg|rad", plain):
        more = "numbers have no unit; write an angle in radians, by its digits"
    elif re.search(r"inf|nan|∞", plain):
        more = "every number is finite"
    elif re.search(r"\d[ij]", plain):
        more = "numbers are real"
    elif re.search(r"[-+*/^(]", plain[1:]) and re.search(r"\d", plain):
        more = "nothing is calculated here; write the result"
    else:
        return f"not a finite number; {ALLOWED}"
    return f"not a finite number: {more}; {ALLOWED}"


def _guess_numbers(text: str) -> Iterator[str]:
    """Yield the numbers that a user may have meant, the likeliest first."""
    plain = _plain(text)
    if _GROUPED.fullmatch(plain):
        thousands = plain.replace(",", "")
        yield thousands if plain.count(",") > 1 else f"{thousands} or {plain.replace(',', '.')}"
    if "," in plain and "." in plain:
        decimal_point = max(",", ".", key=plain.rfind)  # the later of the two
        separator = "," if decimal_point == "." else "."
        plain = plain.replace(separator, "").replace(decimal_point, ".")
    tries = (
        plain.replace(",", "."),
        re.sub(r"[dD]([+-]?\d+)$", r"e\1", plain),
        re.sub(r"(?<=[\d.])[fFlLmM]$", "", plain),
        plain.replace("_", ""),
        re.sub(r"\*?10(?:\*\*|\^)\(?([+-]?\d+)\)?$", r"e\1", plain.replace("·", "*")),
    )
    for candidate in tries:
        if _NUMBER.fullmatch(candidate):
            yield candidate
    if plain.endswith("%") and _NUMBER.fullmatch(plain[:-1] + "/100"):
        yield plain[:-1] + "/100"
    if re.fullmatch(r"0[xXbBoO][0-9a-fA-F]+", plain):
        yield from _from_other_base(plain)
    if (parts := _QUOTIENT.fullmatch(plain)) and not re.search(r"[eE][+-]?\d{3}", plain):
        above, below = map(Fraction, parts.groups())
        if below:
            yield str(above / below)


def _from_other_base(text: str) -> Iterator[str]:
    try:
        yield str(int(text, 0))
    except ValueError:
        return


def _plain(text: str) -> str:
    """Return the text with ASCII characters for those that have one, and without quotation marks
    and brackets around it."""
    plain = re.sub("[−‐-―]", "-", unicodedata.normalize("NFKC", text)).replace("⁄", "/")
    plain = re.sub(r"\s*([/*^])\s*|^([+-])\s+", r"\1\2", plain)
    return re.sub(r"""^[\s=({\['"“„‘]+|[\s)}\]'"”’;]+$""", "", plain)
