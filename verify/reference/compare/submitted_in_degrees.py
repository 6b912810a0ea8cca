"""Somebody's table of numbers in n degrees of freedom → the rows that the reference data have, too.

Its columns are p1 … pn, q1 … qn, energy, symplectic_defect_max, symplectic_defect and lambda, with
step or time; scene, scheme, step_size, q0_1 … q0_n, p0_1 … p0_n and t0 where options do not say
them.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

from verify.arithmetic.exact import rational
from verify.errors import NOT_GIVEN, InputError, unknown
from verify.kernels.step.tangent_map import nearest_double
from verify.reference.compare.published_in_degrees import RunOfDegrees
from verify.reference.compare.submitted import Row, printable
from verify.reference.compare.table import Table, opened
from verify.reference.make.models_in_degrees import OF_ORBIT
from verify.reference.make.tables_in_degrees import start_columns, state_columns

_STATE = re.compile(r"[pq][1-9][0-9]?")
_SAME_NUMBER = Fraction(1, 10**6)  # of a step, by which N·h may miss a time


@dataclass
class TheirsInDegrees:
    """As `verify.reference.compare.submitted.Theirs`, of which it has the names."""

    columns: tuple[str, ...] = ()
    ignored: tuple[str, ...] = ()
    rows: int = 0
    other_steps: int = 0
    outside: int = 0
    first_outside: str = ""
    runs: dict[str, tuple[RunOfDegrees, dict[int, Row]]] = field(default_factory=dict)
    read_as: dict[str, tuple[Fraction, Fraction]] = field(default_factory=dict)


def has_degrees(path: Path, names: Mapping[str, str]) -> bool:
    """Whether a table has a column p1, q1, …, or is said to call one so."""
    with opened(path) as lines:
        return any(_STATE.fullmatch(x) for x in (*lines.header, *names))


def read_in_degrees(
    path: Path,
    ours: Sequence[RunOfDegrees],
    given: Mapping[str, str],
    names: Mapping[str, str],
) -> TheirsInDegrees:
    """The table's rows that `ours` has; `given` and `names` as options say them.

    InputError where it cannot be read, or does not tell which run a row is of.
    """
    degrees = max(run.hamiltonian.degrees for run in ours)
    values = (*state_columns(degrees), *OF_ORBIT)
    keys = ("scene", "scheme", "step_size", *start_columns(degrees), "t0")
    found, said = TheirsInDegrees(), _split(given)
    with opened(path) as lines:
        places = _places(lines, names, (*values, *keys, "step", "time"))
        found.columns = tuple(name for name in values if name in places)
        found.ignored = tuple(printable(x) for k, x in enumerate(lines.header)
                              if k not in places.values())  # fmt: skip
        if not found.columns:
            raise lines.error(f"names no column of {', '.join(values)}")
        if "step" not in places and "time" not in places:
            raise lines.error("names no column step or time")
        for row in lines:
            found.rows += 1
            if len(row) < lines.width:
                raise lines.error(f"has {len(row)} cells, and the header {lines.width}")
            own = said | {name: row[places[name]].strip() for name in keys if name in places}
            _take(found, ours, own, {name: row[k] for name, k in places.items()}, lines)
    return found


def _split(given: Mapping[str, str]) -> dict[str, str]:
    """The options: lists of q and p part at their commas."""
    found: dict[str, str] = {}
    for name, text in given.items():
        if name in ("q0", "p0"):
            found |= {f"{name}_{k}": x.strip() for k, x in enumerate(text.split(","), start=1)}
        else:
            found[name] = text
    return found


def _places(lines: Table, names: Mapping[str, str], known: Sequence[str]) -> dict[str, int]:
    for name, theirs in names.items():
        if name not in known:
            raise unknown("--column", name, known)
        if theirs not in lines.header:
            has = ", ".join(lines.header)
            raise InputError("--column", theirs, f"is no column of the table; it has: {has}")
    heads = {theirs: ours for ours, theirs in names.items()}
    places: dict[str, int] = {}
    for at, head in enumerate(lines.header):
        column = heads.get(head, head if head not in names else None)
        if column is not None and column in known:
            if column in places:
                raise lines.error(f"has two columns for {column}; --column {column}=… says which")
            places[column] = at
    return places


def _take(
    found: TheirsInDegrees,
    ours: Sequence[RunOfDegrees],
    inputs: Mapping[str, str],
    cells: Mapping[str, str],
    lines: Table,
) -> None:
    asked: dict[str, str | float] = {}
    for name, text in inputs.items():
        if name not in ("scene", "scheme"):
            asked[name] = nearest_double(_number(lines, text, name))
        elif name == "scheme":
            asked[name] = text
    of_scene = [run for run in ours if inputs.get("scene") in (None, run.scene)]
    runs = [run for run in of_scene if run.fits(asked)]
    if len(runs) > 1:
        lacking = next((n for n, x in runs[0].inputs.items()
                        if any(run.inputs.get(n) != x for run in runs)), "scene")  # fmt: skip
        option = {"q": "q", "p": "p"}.get(lacking[0] if "0_" in lacking else "", lacking)
        told = "; ".join(run.label for run in runs[:3])
        raise InputError(f"--{option.replace('_', '-')}", NOT_GIVEN, f"is wanted; there are {told}")
    if not runs:
        found.outside += 1
        told = ", ".join(f"{name} = {printable(x)}" for name, x in inputs.items())
        found.first_outside = found.first_outside or f"line {lines.line}: {told}"
        return
    run = runs[0]
    step = _step(lines, cells, run)
    if step not in run.rows:
        found.other_steps += 1
        return
    own = Row(lines.line, {name: cells[name] for name in found.columns})
    before = found.runs.setdefault(run.label, (run, {}))[1].setdefault(step, own)
    if before.cells != own.cells:
        raise lines.error(f"says of step {step} of {run.label} other than line {before.line}")


def _step(lines: Table, cells: Mapping[str, str], run: RunOfDegrees) -> int | None:
    name = "step" if "step" in cells else "time"
    count = _number(lines, cells[name], name)
    if name == "time":
        count = (count - Fraction(run.run.t0 or 0)) / rational(run.run.step_size)
        near = round(count)
        return near if abs(count - near) <= _SAME_NUMBER * max(1, abs(near)) else None
    if count.denominator != 1:
        raise lines.error(f"has the step {cells[name][:40]!r}, which is not a whole number")
    return int(count)


def _number(lines: Table, text: str, name: str) -> Fraction:
    try:
        return rational(text, name)
    except InputError as error:
        raise lines.error(f"has the {name} {text[:40]!r}: {error.problem}") from None
