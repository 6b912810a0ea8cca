"""Rows of tables: what a cell is, and which columns there are by the degrees of freedom of an H.

Beside the coordinates there is in the plane ΔJ of the next step; in several degrees of freedom H,
and S and W in place of ΔJ.
"""

from itertools import count
from typing import Any

from verify.scenes.results.reference import Cell, FlowRow, OrbitRow

Row = tuple[str, ...]
_OF_PLANE = ("delta_j", "mse", "lambda")
_OF_SEVERAL = ("energy", "symplectic_defect_max", "symplectic_defect", "lambda")
AFTER_A_STEP = ("mse", "symplectic_defect_max")  # what there is not for N = 0
MAY_LACK = ("delta_j", "energy")


def cell(value: Any) -> str:
    """The text of a value; empty for None; of entries by name, NAME: VALUE with semicolons."""
    if value is None:
        return ""
    if isinstance(value, dict):
        return "; ".join(f"{name}: {x}" for name, x in value.items())
    return str(value).lower() if isinstance(value, bool) else str(value)


def start_columns(degrees: int) -> Row:
    """The names of the columns that hold the start: q first."""
    if degrees == 1:
        return "q0", "p0"
    return tuple(f"{letter}0_{k}" for letter in "qp" for k in range(1, degrees + 1))


def orbit_columns(degrees: int) -> Row:
    """The names of those that an orbit has beside its state."""
    return _OF_PLANE if degrees == 1 else _OF_SEVERAL


def values_of(row: OrbitRow | FlowRow, degrees: int) -> dict[str, Cell]:
    """The numbers of a row by the names of their columns; None for one that there is not."""
    values: dict[str, Cell] = {}
    for letter, numbers in (("p", row.p), ("q", row.q)):
        each = numbers if isinstance(numbers, tuple) else (numbers,) * degrees
        names = [letter] if degrees == 1 else (f"{letter}{k}" for k in count(1))
        values |= dict(zip(names, each, strict=False))
    if isinstance(row, OrbitRow):
        beside = orbit_columns(degrees)
        values |= {name: getattr(row, "lam" if name == "lambda" else name) for name in beside}
    return values
