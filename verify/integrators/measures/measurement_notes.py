"""Notes on a finding: where the map was measured, and likely reasons of a refutation.

A matrix that a program prints with few digits is seldom symplectic, but a symplectic one may lie
within half a unit of its last digits. A map of positions x and velocities v may preserve
Σ m_i dv_i∧dx_i.
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING

from verify.hamiltonians.coordinates import coordinates_in
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.measures.distances import Distances
from verify.integrators.measures.reading import DefectReading
from verify.integrators.measures.structure_measurement import StructureMeasurement
from verify.integrators.places.trial_places import SIDE, TrialPlace
from verify.integrators.user_code.user_map import DOUBLE, UserMap
from verify.prose import Number, Prose, join_prose, prose

if TYPE_CHECKING:
    import numpy as np

# A map is linear if its J at two places agree up to this part of the largest entry.
_LINEAR_TOLERANCE = 1e-13
_MOST_DIGITS = 14
# The search for the smallest change of an entry: its iterations, and the least weight of an entry.
_SEARCH_ITERATIONS = 40
_MIN_WEIGHT = 1e-3
# A singular value counts as 0 up to the first part of the largest one, and not from the second on;
# so do differences of masses.
_NULL_SHARE, _MIN_SHARE = 1e-9, 1e-5
_MAX_MASS_RATIO = 10**6
_SIGNIFICANT_DIGITS = 3  # of a number in a note
_MOST_NAMED = 8  # coordinates whose ranges are told


def describe_numbers(step: UserMap, doubles: str = "doubles") -> str:
    """Name the number type of the step; `doubles` is the name to use for doubles."""
    return doubles if step.numbers is DOUBLE else step.numbers.declared_as


def describe_places(step: UserMap, places: Sequence[TrialPlace]) -> Prose:
    """Describe the places and step sizes that were looked at."""
    n, ranges = step.degrees, []
    parts = {"p": slice(0, n), "q": slice(n, 2 * n)}
    if step.names != coordinates_in(max(n, 1)):
        parts = {name: slice(k, k + 1) for k, name in enumerate(step.names[:_MOST_NAMED])}
    for name, part in parts.items():
        largest = max(max(abs(x) for x in place.z[part]) for place in places)
        ranges.append(f"|{name}| ≤ {_plain(largest)}")
    if step.time_dependent:
        times = [place.t for place in places]
        ranges.append(f"{_plain(min(times))} ≤ t ≤ {_plain(max(times))}")
    count = f"{len(places)} place" + ("s" if len(places) != 1 else "")
    steps = [place.step for place in places if place.step]
    sizes = [f"h ≤ {_plain(max(steps))}"] if steps else []
    return prose(join_prose(", ", [count, *ranges, *sizes]))


def _plain(x: Fraction) -> str:
    if x.denominator <= 1000 and abs(x.numerator) < 10**5:
        return str(x)
    return Number(f"{float(x):.{_SIGNIFICANT_DIGITS}g}")


def note_places(step: UserMap, structure: StructureMeasurement) -> list[str]:
    """Return notes on where a map was measured, and on the places that are left out."""
    places = list(dict.fromkeys(x.place for x in structure.readings))
    kind = (
        "with dual numbers"
        if structure.how == "duals"
        else f"in {describe_numbers(step, 'floats')}"
    )
    notes = [f"measured {kind} at {describe_places(step, places)}, and nowhere else"]
    if structure.blind:
        blind_places = [
            ", ".join(f"{name} = `{x}`" for name, x in zip(step.names, r.place.z, strict=True))
            + f" (`{r.blur:.1e}`)"
            for r in structure.blind[:4]
        ]
        notes.append(
            f"left out, as the probe's own error is not small against 1: {'; '.join(blind_places)}"
        )
    if structure.failures:
        notes.append(
            f"at {len(structure.failures)} calls it returned no state: {structure.failures[0]}"
        )
    return notes


def note_sides(structure: StructureMeasurement) -> list[str]:
    """Return notes on the comparisons in the code whose other side was looked at, or was not."""
    far_sides = list(structure.sides.far_conditions)
    on_sides = [x.place for x in structure.readings if x.place.source == SIDE]
    notes = []
    if on_sides:
        notes.append(
            f"{len(set(on_sides))} of them lie on sides of comparisons that the others do not reach"
        )
    if far_sides:
        conditions = "; ".join(far_sides[:3])
        notes.append(f"it compares, and may do something else, where {conditions}: not looked at")
    return notes


def note_unseen(step: UserMap, distances: Distances) -> list[str]:
    """Return a note on the size below which an error of a step is not seen with floats."""
    if distances.how != "floats":
        return []
    unseen = max(x.unseen for x in distances.places)
    moves = "p' − p or q' − q" if step.names == coordinates_in(max(step.degrees, 1)) else "z' − z"
    return [
        f"in {describe_numbers(step, 'floats')}: an error of {moves} below about "
        f"`{unseen:.0e}` of them is not seen"
    ]


# -- other forms ----------------------------------------------------------------------------------


def note_digits(readings: Sequence[DefectReading]) -> list[str]:
    """Return a sentence if the map is a matrix of few digits to which a symplectic one rounds."""
    import numpy as np

    first = np.array(readings[0].jacobian)
    size = np.abs(first).max()
    if len(readings) < 2 or any(
        np.abs(np.array(x.jacobian) - first).max() > _LINEAR_TOLERANCE * size for x in readings
    ):
        return []
    digits = _decimal_places(first)
    if digits is None or _smallest_change(first) > 0.5 * 10.0**-digits * (1 + 1e-6):
        return []
    ending = {1: "st", 2: "nd", 3: "rd"}.get(digits if digits < 4 else 0, "th")
    return [
        f"a symplectic matrix lies within half a unit of the {digits}{ending} digit of its entries"
    ]


def _decimal_places(matrix: "np.ndarray") -> int | None:
    """Return the largest number of decimal places of the entries; None if it exceeds
    `_MOST_DIGITS`."""
    import numpy as np

    # A decimal that is read as a double is off by up to two units of the last place, 4e-16.
    for digits in range(_MOST_DIGITS + 1):
        scaled = matrix * 10.0**digits
        if np.all(np.abs(scaled - np.round(scaled)) <= 4e-16 * np.abs(scaled)):
            return digits
    return None


def _smallest_change(matrix: "np.ndarray") -> float:
    """Return the largest entry of a small change that makes the matrix M symplectic to first order.

    A change δ solves MᵀΩδ + δᵀΩM = −S. Iterated least squares look for the δ whose largest entry is
    least: in each iteration large entries get a lower weight.
    """
    import numpy as np

    size = len(matrix)
    half = size // 2
    unit = np.eye(half)
    omega = np.block([[np.zeros((half, half)), unit], [-unit, np.zeros((half, half))]])
    defect = matrix.T @ omega @ matrix - omega
    upper_triangle = np.triu_indices(size, 1)
    # One equation for each entry of S above the diagonal, in the entries of δ by rows.
    rows = np.zeros((len(upper_triangle[0]), size * size))
    left = matrix.T @ omega  # (left δ)_ab − (left δ)_ba
    for row, a, b in zip(rows, *upper_triangle, strict=True):
        row[b::size] += left[a]
        row[a::size] -= left[b]
    target = -defect[upper_triangle]
    weights, smallest = np.ones(size * size), np.inf
    for _ in range(_SEARCH_ITERATIONS):
        change = weights * np.linalg.lstsq(rows * weights, target, rcond=None)[0]
        largest = np.abs(change).max()
        smallest = min(smallest, largest)
        if largest == 0:
            return 0.0
        weights *= (np.abs(change) / largest + 0.05) ** -0.3
        # Without this limit, an entry that need not change would outgrow all others in weight.
        weights = np.maximum(weights / weights.max(), _MIN_WEIGHT)
    return float(smallest)


def note_masses(readings: Sequence[DefectReading], names: Sequence[str]) -> list[str]:
    """Return a sentence if the map preserves Σ m_i dp_i∧dq_i with masses that are not all equal."""
    import numpy as np

    half = len(names) // 2
    if half < 2:
        return []
    rows = []
    for reading in readings:
        jacobian = np.array(reading.jacobian)
        for a, b in combinations(range(2 * half), 2):
            u, v = jacobian[:, a], jacobian[:, b]
            row = u[:half] * v[half:] - u[half:] * v[:half]
            if b == a + half:
                row[a] -= 1
            rows.append(row / reading.components[a, b].scale)
    # A null vector of this system consists of masses with which Σ m dp∧dq is preserved. It must be
    # the only one, or the masses are not determined.
    _, sizes, directions = np.linalg.svd(np.array(rows))
    if sizes[-1] > _NULL_SHARE * sizes[0] or sizes[-2] < _MIN_SHARE * sizes[0]:
        return []
    smallest = min(directions[-1], key=abs)
    if abs(smallest) * _MAX_MASS_RATIO < 1:
        return []
    masses = directions[-1] / smallest
    if not np.all(masses > 0) or np.ptp(masses) < _MIN_SHARE:
        return []
    masses_text = ", ".join(f"{x:.6g}" for x in masses)
    return [
        f"it keeps Σ m dp∧dq with m = ({masses_text}), up to a factor: taken as velocities, "
        "in momenta p = m·v it is symplectic"
    ]


def masses_of(hamiltonian: Hamiltonian) -> tuple[Fraction, ...]:
    """Return m_i of an H = Σ p_i²/(2 m_i) + V(q); () if H is of another form, or all m_i are 1."""
    from verify.algebra.formula import symbol

    half, masses = hamiltonian.degrees, []
    for name in hamiltonian.coordinates[:half]:
        slope = hamiltonian.exact.diff(symbol(name))
        rate = slope.diff(symbol(name))
        if not rate.is_Rational or rate <= 0 or slope.subs(symbol(name), 0) != 0:
            return ()
        masses.append(Fraction(int(rate.q), int(rate.p)))
    return tuple(masses) if set(masses) != {Fraction(1)} else ()
