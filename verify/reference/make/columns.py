"""The columns that hold the numbers of a row, by the degrees of freedom of its H.

In the plane p and q, with ΔJ of the next step; in several degrees of freedom p1 … pn, q1 … qn, with
H, and S and W in place of ΔJ.
"""

from collections.abc import Sequence
from itertools import count

from verify.hamiltonians.coordinates import coordinates_in
from verify.reference.make.cells import Row
from verify.scenes.results.reference import FlowPoint, OrbitPoint, Rounded
from verify.scenes.results.reference_in_degrees import FlowPointInDegrees, OrbitPointInDegrees

AnyOrbitPoint = OrbitPoint | OrbitPointInDegrees
AnyFlowPoint = FlowPoint | FlowPointInDegrees
_OF_PLANE = ("delta_j", "mse", "lambda")
_OF_SEVERAL = ("energy", "symplectic_defect_max", "symplectic_defect", "lambda")
AFTER_A_STEP = ("mse", "symplectic_defect_max")  # what there is not for N = 0
MAY_LACK = ("delta_j", "energy")


def start_columns(degrees: int) -> Row:
    """The names of the columns that hold the start: q first."""
    if degrees == 1:
        return "q0", "p0"
    return tuple(f"{letter}0_{k}" for letter in "qp" for k in range(1, degrees + 1))


def state_columns(degrees: int) -> Row:
    """The names of those that hold the state: p first."""
    return coordinates_in(degrees)


def orbit_columns(degrees: int) -> Row:
    """The names of those that an orbit has beside its state."""
    return _OF_PLANE if degrees == 1 else _OF_SEVERAL


def values_of(row: AnyOrbitPoint | AnyFlowPoint, degrees: int) -> dict[str, Rounded | None]:
    """The numbers of a row by the names of their columns; None for one that there is not."""
    values: dict[str, Rounded | None] = {}
    for letter, numbers in (("p", row.p), ("q", row.q)):
        each: Sequence[Rounded | None]
        each = numbers if isinstance(numbers, tuple) else (numbers,) * degrees
        names = [letter] if degrees == 1 else (f"{letter}{k}" for k in count(1))
        values |= dict(zip(names, each, strict=False))
    if isinstance(row, AnyOrbitPoint):
        *others, _ = orbit_columns(degrees)
        values |= {name: getattr(row, name) for name in others} | {"lambda": row.lam}
    return values
