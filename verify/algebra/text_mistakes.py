"""Messages about a formula's text that cannot be parsed, with the place of the mistake.

Such a text has a character that no formula has, or Python does not read it as an expression.
"""

import keyword
import re
import unicodedata
from collections.abc import Collection, Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

_TOKEN = re.compile(
    r"(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<name>[A-Za-z_]\w*)|(?P<sign>\*\*|\S)",
    re.ASCII,
)
_CLOSES = {")": "(", "]": "[", "}": "{"}
_INFIX = ("+", "-", "*", "/", "**", "^")
_LEADING_OPERATORS = ("+", "-")  # a formula may begin with them
_PYTHON_CONSTANTS = frozenset({"True", "False", "None"})
_CONDITIONS = frozenset({"if", "else", "and", "or", "not"})
_CASES = "a formula has no cases, since H must be smooth"
_STRAY = {
    "=": "a formula has no =; write its right side alone",
    "<": _CASES,
    ">": _CASES,
    "?": _CASES,
    "|": "|…| is an absolute value, which is not smooth; allowed are smooth functions",
    "!": "! is not allowed; write a factorial as the number that it is",
    ";": "one formula is wanted; leave out the ;",
    ":": "a formula has no :",
    "$": "leave out the $",
    "`": "leave out the `",
    "&": "write * for a product",
    "@": "write * for a product",
    "~": "write - for a minus",
    "#": "a formula has no comment; leave out the #",
    "%": "a remainder is not smooth; allowed: + - * / **",
}


class _Token(NamedTuple):
    kind: str  # number, name or sign
    text: str
    start: int


Mistake = tuple[int, str]  # index in the text, and the message with what to write instead


def syntax_mistake(text: str, functions: Collection[str], offset: int | None) -> str:
    """Describe the mistake in a text that is no expression; `offset`: where Python's parser
    stopped."""
    tokens = [_Token(str(m.lastgroup), m[0], m.start()) for m in _TOKEN.finditer(text)]
    mistakes = [
        *_brackets(tokens),
        *_stray(tokens),
        *_neighbours(text, tokens, functions),
        *_ends(tokens),
    ]
    if mistakes:
        # The leftmost mistake is reported; those after it are often its consequences.
        index, problem = min(mistakes, key=lambda each: each[0])
        return f"not a formula at {format_place(text, index)}: {problem}"
    location = "" if offset is None else f" at {format_place(text, index_of(text, offset))}"
    return f"not a formula{location}; allowed: + - * / ** and functions"


def _brackets(tokens: Sequence[_Token]) -> Iterator[Mistake]:
    open_brackets: list[_Token] = []
    for token in tokens:
        if token.text in _CLOSES.values():
            open_brackets.append(token)
        elif token.text in _CLOSES:
            if not open_brackets:
                yield token.start, f"this {token.text} closes nothing; leave it out"
                return
            opening = open_brackets.pop()
            if opening.text != _CLOSES[token.text]:
                yield opening.start, f"this {opening.text} is closed by {token.text}; write ( )"
                return
    if open_brackets:
        yield open_brackets[-1].start, f"this {open_brackets[-1].text} is not closed; write )"


def _stray(tokens: Sequence[_Token]) -> Iterator[Mistake]:
    """Yield the words and characters that no formula has."""
    for before, token in pairwise((None, *tokens)):
        assert token is not None  # noqa: S101 - only `before` of the first pair is None
        if token.text in _STRAY:
            yield token.start, _STRAY[token.text]
        elif token.text in _CONDITIONS:
            yield token.start, _CASES
        elif token.text in ("'", '"'):
            prime = before is not None and (before.kind == "name" or before.text == ")")
            yield (
                token.start,
                (
                    "a prime is no part of a name; leave it out, or write another name"
                    if prime
                    else "leave out the quotation mark"
                ),
            )
        elif keyword.iskeyword(token.text) and token.text not in _PYTHON_CONSTANTS:
            more = f"write another name, such as {token.text}_"
            yield token.start, f"{token.text} is a reserved word of Python; {more}"
        elif before is not None and before.text == "\\":
            yield before.start, _latex(token.text)


def _latex(command: str) -> str:
    commands = {
        "frac": "(a)/(b) for \\frac{a}{b}",
        "cdot": "* for \\cdot",
        "times": "* for \\times",
    }
    return f"this is LaTeX; write {commands.get(command, f'{command} without the backslash')}"


def _neighbours(
    text: str, tokens: Sequence[_Token], functions: Collection[str]
) -> Iterator[Mistake]:
    """Yield mistakes between neighbours: a missing operator or operand, or parentheses."""
    for before, after in pairwise(tokens):
        pair = " ".join(text[before.start : after.start + len(after.text)].split())
        begins = after.kind != "sign" or after.text == "("
        ends = before.kind != "sign" or before.text == ")"
        if before.text in functions:
            if after.kind != "sign":
                write = f"write {before.text}({after.text})"
                yield before.start, f"{before.text} takes its argument in parentheses; {write}"
        elif ends and begins and not (before.kind == "name" and after.text == "("):
            yield before.start, _missing_sign(text, before, after, pair)
        elif before.text in (*_INFIX, "(") and after.text in ("*", "/", "**", "^", ")"):
            yield before.start, f"something is missing in {pair}"
    for token in tokens:
        if re.fullmatch(r"0\d+", token.text):
            yield token.start, f"write {int(token.text)} for {token.text}"


def _missing_sign(text: str, before: _Token, after: _Token, pair: str) -> str:
    if before.kind == "number" and before.text + after.text == pair:  # no blank between them
        # Fortran writes exponents that Python does not read, such as 1d-3.
        if exponent := re.match(r"[dDfF]([+-]?\d+)", text[after.start :]):
            return f"write {before.text}e{exponent[1]} for {before.text}{exponent[0]}"
        if after.kind == "number":
            return f"{pair} is no number; it has two points"
        if after.text in ("e", "E"):
            return f"write exponents as {before.text}e-3, and e to a power as {before.text}*exp(…)"
    return f"write {before.text}*{after.text} for {pair}"


def _ends(tokens: Sequence[_Token]) -> Iterator[Mistake]:
    if tokens and tokens[-1].text in _INFIX:
        yield tokens[-1].start, f"something is missing after {tokens[-1].text}"
    if tokens and tokens[0].text in _INFIX and tokens[0].text not in _LEADING_OPERATORS:
        yield tokens[0].start, f"something is missing before {tokens[0].text}"


# -- characters -----------------------------------------------------------------------------------


_INSTEAD = {
    **dict.fromkeys("·×⋅∗•∙", "*"), **dict.fromkeys("÷∕⁄", "/"), **dict.fromkeys("−–—‐‑", "-"),
    "√": "sqrt(…)", "ħ": "hbar", "ℏ": "hbar", "°": "*pi/180", "ⅇ": "exp(1)",
}  # fmt: skip
_LEFT_OUT = frozenset("“”„‘’«»‹›′″")
_GREEK = re.compile(r"GREEK (?:SMALL |CAPITAL )?(?:LETTER )?(?:FINAL |LUNATE )?(\w+)")
_POWER = re.compile("[⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻]+")


def strange_character(text: str) -> str:
    """Describe the first character that is outside ASCII, else the first unprintable one."""
    foreign = next((k for k, c in enumerate(text) if not c.isascii()), None)
    if foreign is None:
        unseen = (k for k, c in enumerate(text) if not (c.isprintable() or c.isspace()))
        index = next(unseen, 0)
        character = f"U+{ord(text[index]):04X} at {format_place(text, index)}"
        return f"is not a formula: {character} is not allowed; leave it out"
    c = text[foreign]
    name = unicodedata.name(c, "without a name").lower()
    symbol = c if c.isprintable() and c.strip() else f"U+{ord(c):04X}"
    instead = _instead(c, text[foreign:])
    return f"at {format_place(text, foreign)}: {symbol} ({name}) is outside ASCII; {instead}"


def _instead(c: str, following: str) -> str:
    # Compatibility normalization maps look-alikes, such as full-width letters, to plain ones.
    plain = unicodedata.normalize("NFKC", c)
    if c in _LEFT_OUT:
        return "leave it out"
    if c in _INSTEAD:
        return f"write {_INSTEAD[c]}"
    if power := _POWER.match(following):
        return f"write **{unicodedata.normalize('NFKC', power[0]).replace('−', '-')}"
    if greek := _GREEK.match(unicodedata.name(plain[:1], "")):
        letter = greek[1].lower().replace("lamda", "lambda")
        letter = letter if plain.islower() else letter.capitalize()
        return f"write {letter}_" if keyword.iskeyword(letter) else f"write {letter}"
    if not c.isprintable() or not plain.strip():
        return "write a space, or leave it out"
    if plain.replace("⁄", "/").isascii():  # ½, ₁, full-width letters
        return f"write ({plain.replace('⁄', '/')})" if len(plain) > 1 else f"write {plain}"
    return "allowed: + - * / **, numbers, and names of ASCII letters, digits and _"


# -- places, as a person counts lines and columns -------------------------------------------------


def format_place(text: str, index: int) -> str:
    """Return the column of a character, from 1, and its line if there are several."""
    before = text[:index]
    column = f"column {index - before.rfind(chr(10))}"
    return f"line {before.count(chr(10)) + 1}, {column}" if "\n" in text.strip() else column


def index_of(text: str, offset: int) -> int:
    """Return the index in the text for an offset in the line that Python reads.

    In that line ^ became **, and each run of blanks one space.
    """
    position = last = 0
    for match in re.finditer(r"\S+|\s+", text.strip()):
        if match[0].isspace():
            position += 1
            continue
        for last, c in enumerate(match[0], match.start()):
            position += 2 if c == "^" else 1
            if position > offset:
                return last + len(text) - len(text.lstrip())
    return last + len(text) - len(text.lstrip())
