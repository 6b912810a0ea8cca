"""One mistake in a right table: a digit, a sign, a node, a clock, a weight; and whether it shows.

What series say of a step (`tests.helpers.tables.by_series`) tells which claims still hold.
"""

import copy
import random
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

from tests.helpers.tables.by_series import gap
from tests.paths import ROOT
from verify.errors import InputError
from verify.integrators.tables import kinds
from verify.integrators.tables.table_claim import TableClaim
from verify.schemes.printed.printed_numbers import unit_of
from verify.verdict import Verdict

_NUMBERS = ("sizes", "half", "numbers", "times", "a", "b", "c", "embedded", "b_bar", "p", "q",
            "parts")  # fmt: skip
_SLACK = 1e4  # of residues, in what the last digits make of them
_NOTHING = 1e-45  # of numbers whose first 60 digits are taken
Table = dict[str, Any]


def right_tables() -> list[Table]:
    """Those of `right.toml`, and those of the literature."""
    own = tomllib.loads((Path(__file__).parent / "right.toml").read_text(encoding="utf-8"))
    printed = (ROOT / "reports" / "audits" / "literature.toml").read_text(encoding="utf-8")
    known = tomllib.loads(printed)["table"]
    return [*own["table"], *(x for x in known if x["order"] <= 6)]


def judged(table: Table) -> list[TableClaim]:
    """Its claims, as `verify check-table` has them."""
    module = kinds.get(table["kind"])
    return list(module.claims(module.ENTRY.model_validate(table)))


# -- mistakes -------------------------------------------------------------------------------------


def places(table: Table) -> list[tuple[Any, ...]]:
    """The paths to all numbers, of a text of many with the token's place at last."""
    return [path for key in _NUMBERS if key in table for path in _inside(table[key], (key,))]


def _inside(value: Any, path: tuple[Any, ...]) -> Iterator[tuple[Any, ...]]:
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _inside(inner, (*path, key))
    elif isinstance(value, list):
        for k, inner in enumerate(value):
            yield from _inside(inner, (*path, k))
    elif isinstance(value, str) and len(value.split()) > 1 and path[0] in ("sizes", "times"):
        yield from ((*path, k) for k, x in enumerate(value.split()) if x[-1:].isdigit())
    elif str(value)[-1:].isdigit() or str(value)[-1:] == ")":
        yield path


def with_mistake(table: Table, draw: random.Random) -> tuple[Table, str]:
    """A copy with one number changed, and what was done."""
    while True:
        made = copy.deepcopy(table)
        path = draw.choice(places(table))
        holder: Any = made
        for key in path[:-1]:
            parent, at = holder, key
            holder = holder[key]
        tokens = holder.split() if isinstance(holder, str) else None
        before = str(tokens[path[-1]] if tokens else holder[path[-1]])
        after = _changed(before, draw)
        if after is None:
            continue
        if tokens:
            tokens[path[-1]] = after
            parent[at] = " ".join(tokens)
        else:
            holder[path[-1]] = after
        return made, f"{table['name']}: {'.'.join(map(str, path))}: {before} → {after}"


def _changed(text: str, draw: random.Random) -> str | None:
    """Another sign, or another digit; None where that is no other number, or none at all."""
    if draw.random() < 0.25:
        if text.lstrip("-−") in ("0", "") or text[:1] in "-−":
            return text[1:] if text[:1] in "-−" and len(text) > 1 else None
        return f"-({text})" if any(x in text[1:] for x in "+-−") else f"-{text}"
    digits = [k for k, x in enumerate(text) if x.isdigit() and x.isascii()]
    digits = [k for k in digits if ("sqrt" not in text and text[k - 1 : k] not in "√e^") or k == 0]
    if not digits:
        return None
    k = draw.choice(digits)
    other = draw.choice([x for x in "0123456789" if x != text[k]])
    after = text[:k] + other + text[k + 1 :]
    parts = after.split("/")
    if len(parts) == 2 and not parts[1].strip("0"):
        return None
    return after


# -- what shows -----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Outcome:
    """`problem`: empty where what was said is right. `refuted`: whether any claim was."""

    what: str
    refuted: bool
    problem: str = ""


def outcome(right: Table, wrong: Table, what: str) -> Outcome:
    """Whether the mistake is refuted, or is below the printed digits, or costs nothing claimed."""
    try:
        claims = {claim.kind: claim for claim in judged(wrong)}
    except InputError:  # it is no table any more, as where a name is misprinted
        return Outcome(what, True)
    refuted = [kind for kind, claim in claims.items() if claim.verdict is Verdict.REFUTED]
    for kind, (order, table, timed) in _orders(wrong).items():
        known = next((t for k, (_, t, _) in _orders(right).items() if k == kind), right)
        holds = _holds(known, table, order, timed)
        if kind in refuted and holds is True:
            return Outcome(what, True, f"{kind} is refuted, and by its series it holds")
        if not refuted and holds is False:
            return Outcome(
                what, False, f"by its series {kind} does not hold, and nothing is refuted"
            )
    return Outcome(what, bool(refuted))


def _orders(table: Table) -> dict[str, tuple[int, Table, bool]]:
    """The claimed orders: each with the table that it is of, and whether it is in time."""
    found = {"order": (table["order"], table, False)}
    if "times" in table or ("c" in table and "nystrom" not in table["kind"]):
        found["order in time"] = (table["order"], table, True)
    if "embedded_order" in table:
        other = {**table, "b": table["embedded"]}
        found["embedded order"] = (table["embedded_order"], other, False)
    return found


def _holds(right: Table, table: Table, order: int, timed: bool) -> bool | None:
    """By series; None where it is nearly so, and digits decide."""
    size, scale = gap(table, order, timed), gap(right, order + 1, timed)
    before = max(gap(right, order, timed), _NOTHING * scale)
    if size <= 2 * before:
        return True
    rounded = float(max(_units(table), default=0)) * scale * _SLACK
    return None if size <= max(rounded, _SLACK * before) else False


def _units(table: Table) -> Iterator[Fraction]:
    for path in places(table):
        holder: Any = table
        for key in path:
            holder = holder.split() if isinstance(holder, str) else holder
            holder = holder[key]
        unit = unit_of(str(holder).replace("−", "-"))
        if unit is not None and unit < Fraction(1, 10**7):
            yield unit
