"""Rows of tables: what a cell is, and which columns there are by the degrees of freedom of an H.

Beside the coordinates there is in the plane ΔJ of the next step; in several degrees of freedom H,
and S and W in place of ΔJ.
"""

from typing import Any

from verify.hamiltonians.coordinates import coordinates_in
from verify.scenes.results.reference import Cell, FlowRow, OrbitRow
from verify.structures import AREA, SYMPLECTIC, structure_in

Row = tuple[str, ...]
AFTER_A_STEP = ("mse", "symplectic_defect_max")  # what there is not for N = 0
MAY_LACK = ("delta_j", "energy")  # what is of the state alone
_BESIDE = {
    AREA: ("delta_j", "mse", "lambda"),
    SYMPLECTIC: ("energy", "symplectic_defect_max", "symplectic_defect", "lambda"),
}


def cell(value: Any) -> str:
    """Return the text of a value; empty for None; of entries by name, NAME: VALUE with
    semicolons."""
    if value is None:
        return ""
    if isinstance(value, dict):
        return "; ".join(f"{name}: {x}" for name, x in value.items())
    return str(value).lower() if isinstance(value, bool) else str(value)


def start_columns(degrees: int) -> Row:
    """Return the names of the columns that hold the start: q first; q0, or q0_1 …"""
    names = coordinates_in(degrees)
    return tuple(f"{x[0]}0_{x[1:]}".rstrip("_") for x in (*names[degrees:], *names[:degrees]))


def orbit_columns(degrees: int) -> Row:
    """Return the names of an orbit's columns other than those of its state."""
    return _BESIDE[structure_in(degrees)]


def values_of(row: OrbitRow | FlowRow, degrees: int) -> dict[str, Cell]:
    """Return the numbers of a row by the names of their columns; None for a missing one."""
    values: dict[str, Cell] = {}
    for letter, numbers in (("p", row.p), ("q", row.q)):
        if isinstance(numbers, tuple):  # a file may have too few or too many
            values |= {f"{letter}{k}": x for k, x in enumerate(numbers, start=1)}
        else:
            values |= {x: numbers for x in coordinates_in(degrees) if x[0] == letter}
    if isinstance(row, OrbitRow):
        beside = orbit_columns(degrees)
        values |= {name: getattr(row, "lam" if name == "lambda" else name) for name in beside}
    return values
