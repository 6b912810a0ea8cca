"""Why Python does not read a text as an expression: the first mistake in it that is well known."""

import keyword
import re
from collections.abc import Collection, Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from verify.algebra.mistakes.place import index_of, place

_TOKEN = re.compile(
    r"(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<name>[A-Za-z_]\w*)|(?P<sign>\*\*|\S)",
    re.ASCII,
)
_CLOSES = {")": "(", "]": "[", "}": "{"}
_INFIX = ("+", "-", "*", "/", "**", "^")
_FIRST = ("+", "-")  # which may begin a formula
_PYTHON = frozenset({"True", "False", "None"})  # which are constants, and no formula's either
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


Found = tuple[int, str]  # where in the text, what is wrong and what to write


def syntax_mistake(text: str, functions: Collection[str], offset: int | None) -> str:
    """What is wrong where Python found no expression, and stopped at that offset of its line."""
    tokens = [_Token(str(m.lastgroup), m[0], m.start()) for m in _TOKEN.finditer(text)]
    found = [
        *_brackets(tokens),
        *_stray(tokens),
        *_neighbours(text, tokens, functions),
        *_ends(tokens),
    ]
    if found:
        index, problem = min(found, key=lambda each: each[0])
        return f"not a formula at {place(text, index)}: {problem}"
    at = "" if offset is None else f" at {place(text, index_of(text, offset))}"
    return f"not a formula{at}; allowed: + - * / ** and functions"


def _brackets(tokens: Sequence[_Token]) -> Iterator[Found]:
    waiting: list[_Token] = []
    for token in tokens:
        if token.text in _CLOSES.values():
            waiting.append(token)
        elif token.text in _CLOSES:
            if not waiting:
                yield token.start, f"this {token.text} closes nothing; leave it out"
                return
            opened = waiting.pop()
            if opened.text != _CLOSES[token.text]:
                yield opened.start, f"this {opened.text} is closed by {token.text}; write ( )"
                return
    if waiting:
        yield waiting[-1].start, f"this {waiting[-1].text} is not closed; write )"


def _stray(tokens: Sequence[_Token]) -> Iterator[Found]:
    """Words and characters that no formula has."""
    for before, token in pairwise((None, *tokens)):
        assert token is not None  # noqa: S101 - only the first of the pairs' first is None
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
        elif keyword.iskeyword(token.text) and token.text not in _PYTHON:
            more = f"write another name, such as {token.text}_"
            yield token.start, f"{token.text} is a reserved word of Python; {more}"
        elif before is not None and before.text == "\\":
            yield before.start, _latex(token.text)


def _latex(command: str) -> str:
    known = {"frac": "(a)/(b) for \\frac{a}{b}", "cdot": "* for \\cdot", "times": "* for \\times"}
    return f"this is LaTeX; write {known.get(command, f'{command} without the backslash')}"


def _neighbours(text: str, tokens: Sequence[_Token], functions: Collection[str]) -> Iterator[Found]:
    """Two things side by side that an operator should part, or that none can."""
    for left, right in pairwise(tokens):
        shown = " ".join(text[left.start : right.start + len(right.text)].split())
        begins = right.kind != "sign" or right.text == "("
        ends = left.kind != "sign" or left.text == ")"
        if left.text in functions:
            if right.kind != "sign":
                write = f"write {left.text}({right.text})"
                yield left.start, f"{left.text} takes its argument in parentheses; {write}"
        elif ends and begins and not (left.kind == "name" and right.text == "("):
            yield left.start, _missing_sign(text, left, right, shown)
        elif left.text in (*_INFIX, "(") and right.text in ("*", "/", "**", "^", ")"):
            yield left.start, f"something is missing in {shown}"
    for token in tokens:
        if re.fullmatch(r"0\d+", token.text):
            yield token.start, f"write {int(token.text)} for {token.text}"


def _missing_sign(text: str, left: _Token, right: _Token, shown: str) -> str:
    if left.kind == "number" and left.text + right.text == shown:  # nothing between them
        if exponent := re.match(r"[dDfF]([+-]?\d+)", text[right.start :]):
            return f"write {left.text}e{exponent[1]} for {left.text}{exponent[0]}"
        if right.kind == "number":
            return f"{shown} is no number; it has two points"
        if right.text in ("e", "E"):
            return f"write exponents as {left.text}e-3, and e to a power as {left.text}*exp(…)"
    return f"write {left.text}*{right.text} for {shown}"


def _ends(tokens: Sequence[_Token]) -> Iterator[Found]:
    if tokens and tokens[-1].text in _INFIX:
        yield tokens[-1].start, f"something is missing after {tokens[-1].text}"
    if tokens and tokens[0].text in _INFIX and tokens[0].text not in _FIRST:
        yield tokens[0].start, f"something is missing before {tokens[0].text}"
