"""Pieces of a displayed formula: side by side, with their indices, and in rows if it is long."""

import re
from dataclasses import dataclass
from typing import Literal

Kind = Literal["operand", "word", "text", "operator", "relation"]
_THIN = '<mspace width="0.17em"></mspace>'
_TAG = re.compile("<[^>]*>")
_LONG = 36  # characters of a formula that has room in one line of a phone


@dataclass
class Piece:
    """A piece of a formula; `inside`: of a group what stands in its brackets; `apart`: whether a
    space stands before it; `below`: whether its index belongs there; `sign`: whether it is + or −,
    with which a row may begin."""

    markup: str
    kind: Kind = "operand"
    inside: str | None = None
    apart: bool = False
    below: bool = False
    sign: bool = False


def bound(base: str, lower: str, upper: str, *, below: bool) -> str:
    """The base with its indices, where there are any."""
    if not (lower or upper):
        return base
    tag = {(True, True): "subsup", (True, False): "sub", (False, True): "sup"}[
        bool(lower), bool(upper)
    ]
    if below:
        tag = tag.replace("sub", "under").replace("sup", "over")
    inner = "".join(one(part) for part in (base, lower, upper) if part)
    return f"<m{tag}>{inner}</m{tag}>"


def taken_from(items: list[Piece]) -> list[Piece]:
    """The last of them, and what stands before it without a space, as dH before `/dt`."""
    taken = [items.pop()]
    while items and not taken[0].apart and items[-1].kind in ("operand", "word"):
        taken.insert(0, items.pop())
    return taken


def unbracketed(items: list[Piece]) -> str:
    """In a row, without the brackets that hold all of it."""
    inside = items[0].inside if len(items) == 1 else None
    return side_by_side(items) if inside is None else inside


def one(markup: str) -> str:
    """As one element."""
    return f"<mrow>{markup}</mrow>"


def side_by_side(items: list[Piece]) -> str:
    """The pieces in a row: signs at its start, or after others, belong to what follows."""
    made: list[str] = []
    before: Piece | None = None
    for item in items:
        markup = item.markup
        if item.kind == "operator" and (before is None or before.kind in ("operator", "relation")):
            markup = markup.replace("<mo>", '<mo form="prefix">', 1)
        elif _needs_space(before, item):
            made.append(_THIN)
        made.append(markup)
        before = item
    return "".join(made)


def _needs_space(before: Piece | None, item: Piece) -> bool:
    """Between factors that are written apart, and about words."""
    if before is None or {before.kind, item.kind} & {"text", "operator", "relation"}:
        return False
    return item.apart or (item.kind == "word" and before.kind == "operand")


def in_rows(items: list[Piece]) -> list[list[Piece]]:
    """In one row; what is too long for that is cut before each relation but the first, then before
    each term, and then before the first relation."""
    rows = [items]
    for places in (_later_relations, _terms, _relations):
        rows = [part for row in rows for part in (_cut(row, places(row)) if _long(row) else [row])]
    return rows


def _relations(row: list[Piece]) -> list[int]:
    return [k for k, item in enumerate(row) if item.kind == "relation" and k]


def _later_relations(row: list[Piece]) -> list[int]:
    return _relations(row)[1:]


def _terms(row: list[Piece]) -> list[int]:
    before = [None, *(item.kind for item in row)]
    return [k for k, item in enumerate(row) if item.sign and before[k] in ("operand", "word")]


def _cut(items: list[Piece], at: list[int]) -> list[list[Piece]]:
    return [items[a:b] for a, b in zip([0, *at], [*at, len(items)], strict=True)]


def _long(items: list[Piece]) -> bool:
    """Whether about so many characters stand side by side."""
    return len(_TAG.sub("", "".join(item.markup for item in items))) > _LONG
