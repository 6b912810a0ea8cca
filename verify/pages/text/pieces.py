"""Pieces of a displayed formula: set side by side, with indices, in rows if it is long."""

import re
from dataclasses import dataclass
from typing import Literal

Kind = Literal["operand", "word", "text", "operator", "relation"]
_THIN = '<mspace width="0.17em"></mspace>'
_TAG = re.compile("<[^>]*>")
# The limit on characters in a row, which fit on the screen of a phone.
_MAX_CHARACTERS = 36


@dataclass
class Piece:
    """A piece of a formula.

    `inside`: for a group, its markup without brackets; `is_apart`: a space stands before it;
    `has_index_below`: its index is set below it; `is_sign`: it is + or −, which may begin a row.
    """

    markup: str
    kind: Kind = "operand"
    inside: str | None = None
    is_apart: bool = False
    has_index_below: bool = False
    is_sign: bool = False


def attach_scripts(base: str, lower: str, upper: str, *, below: bool) -> str:
    """Return the base with the scripts that are not empty, below and above it if `below`."""
    if not (lower or upper):
        return base
    tag = {(True, True): "subsup", (True, False): "sub", (False, True): "sup"}[
        bool(lower), bool(upper)
    ]
    if below:
        tag = tag.replace("sub", "under").replace("sup", "over")
    inner = "".join(as_element(part) for part in (base, lower, upper) if part)
    return f"<m{tag}>{inner}</m{tag}>"


def pop_operand(items: list[Piece]) -> list[Piece]:
    """Remove and return the last operands without a space between them, such as dH of dH/dt."""
    operand = [items.pop()]
    while items and not operand[0].is_apart and items[-1].kind in ("operand", "word"):
        operand.insert(0, items.pop())
    return operand


def strip_brackets(items: list[Piece]) -> str:
    """Return the pieces in a row, without brackets around all of them."""
    inside = items[0].inside if len(items) == 1 else None
    return side_by_side(items) if inside is None else inside


def as_element(markup: str) -> str:
    """Return the markup as one element."""
    return f"<mrow>{markup}</mrow>"


def side_by_side(items: list[Piece]) -> str:
    """Return the pieces in a row; an operator at the start, or after another, becomes a prefix."""
    markups: list[str] = []
    previous: Piece | None = None
    for item in items:
        markup = item.markup
        # By default MathML would put space on both sides of an operator without a left operand.
        if item.kind == "operator" and (
            previous is None or previous.kind in ("operator", "relation")
        ):
            markup = markup.replace("<mo>", '<mo form="prefix">', 1)
        elif _needs_space(previous, item):
            markups.append(_THIN)
        markups.append(markup)
        previous = item
    return "".join(markups)


def _needs_space(previous: Piece | None, item: Piece) -> bool:
    """Return True between factors that are written apart, and before a word."""
    if previous is None or {previous.kind, item.kind} & {"text", "operator", "relation"}:
        return False
    return item.is_apart or (item.kind == "word" and previous.kind == "operand")


def split_rows(items: list[Piece]) -> list[list[Piece]]:
    """Split a formula that is too long for one row.

    It is cut before each relation but the first; a row that is still too long, before each term;
    and one that is too long even then, before its first relation.
    """
    rows = [items]
    for find_cuts in (_later_relations, _terms, _relations):
        rows = [
            part for row in rows for part in (_cut(row, find_cuts(row)) if _is_long(row) else [row])
        ]
    return rows


def _relations(row: list[Piece]) -> list[int]:
    return [k for k, item in enumerate(row) if item.kind == "relation" and k]


def _later_relations(row: list[Piece]) -> list[int]:
    return _relations(row)[1:]


def _terms(row: list[Piece]) -> list[int]:
    previous_kinds = [None, *(item.kind for item in row)]
    return [
        k for k, item in enumerate(row) if item.is_sign and previous_kinds[k] in ("operand", "word")
    ]


def _cut(items: list[Piece], cuts: list[int]) -> list[list[Piece]]:
    return [items[a:b] for a, b in zip([0, *cuts], [*cuts, len(items)], strict=True)]


def _is_long(items: list[Piece]) -> bool:
    """Return True if the pieces have more characters than fit in a row."""
    return len(_TAG.sub("", "".join(item.markup for item in items))) > _MAX_CHARACTERS
