"""Somebody's table of numbers in n degrees of freedom → the rows that the reference data have, too.

Its columns are p1 … pn, q1 … qn, energy, symplectic_defect_max, symplectic_defect and lambda, with
step or time; scene, scheme, step_size, q0_1 … q0_n, p0_1 … p0_n and t0 where options do not say
them.
"""

import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path

from verify.errors import NOT_GIVEN, InputError
from verify.kernels.step.tangent_map import nearest_double
from verify.reference.compare.published_in_degrees import RunOfDegrees
from verify.reference.compare.rows import (
    COUNTED,
    Row,
    Theirs,
    cells_of,
    number_of,
    places_of,
    printable,
    step_of,
)
from verify.reference.compare.table import Table, opened
from verify.reference.make.columns import orbit_columns, start_columns, state_columns

_STATE = re.compile(r"[pq][1-9][0-9]?")


def has_degrees(path: Path, names: Mapping[str, str]) -> bool:
    """Whether a table has a column p1, q1, …, or is said to call one so."""
    with opened(path) as lines:
        return any(_STATE.fullmatch(x) for x in (*lines.header, *names))


def read_in_degrees(
    path: Path,
    ours: Sequence[RunOfDegrees],
    given: Mapping[str, str],
    names: Mapping[str, str],
) -> Theirs[RunOfDegrees]:
    """The table's rows that `ours` has; `given` and `names` as options say them.

    InputError where it cannot be read, or does not tell which run a row is of.
    """
    degrees = max(run.hamiltonian.degrees for run in ours)
    values = (*state_columns(degrees), *orbit_columns(degrees))
    keys = ("scene", "scheme", "step_size", *start_columns(degrees), "t0")
    found, said = Theirs[RunOfDegrees](), _split(given)
    with opened(path) as lines:
        places = places_of(lines, names, (*values, *keys, *COUNTED), values, found)
        for row in lines:
            found.rows += 1
            cells_of(lines, row)
            own = said | {name: row[places[name]].strip() for name in keys if name in places}
            run = _run_of(found, ours, own, lines)
            if run is not None:
                begins = Fraction(run.run.t0 or 0)
                step = step_of(lines, row, places, begins, run.run.step_size)
                cells = {name: row[places[name]] for name in found.columns}
                if step in run.rows:
                    found.keep(run, step, Row(lines.line, cells), lines)
                else:
                    found.other_steps += 1
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


def _run_of(
    found: Theirs[RunOfDegrees],
    ours: Sequence[RunOfDegrees],
    inputs: Mapping[str, str],
    lines: Table,
) -> RunOfDegrees | None:
    """Which run these inputs are of; None, and so noted, where the data have no such."""
    asked: dict[str, str | float] = {}
    for name, text in inputs.items():
        if name not in ("scene", "scheme"):
            asked[name] = nearest_double(number_of(lines, text, name))
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
        return None
    return runs[0]
