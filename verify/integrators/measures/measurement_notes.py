"""Notes beside a finding: where the map was measured, and what it may be where it is refuted.

A matrix that a program prints with few digits is not symplectic, and one that is may lie within
half a unit of its last digit. A map of positions and velocities may keep Σ m_i dv_i∧dx_i.
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.measures.distances import Distances
from verify.integrators.measures.reading import DefectReading
from verify.integrators.measures.structure_measurement import StructureMeasurement
from verify.integrators.places.trial_places import SIDE, TrialPlace
from verify.integrators.user_code.user_map import DOUBLE, UserMap
from verify.prose import Number, Prose, join_prose, prose

if TYPE_CHECKING:
    import numpy as np

_SAME_JACOBIAN = 1e-13  # of J at two places, of a linear map
_MOST_DIGITS = 14
_TURNS = 40  # of a search for the least largest change
_LEAST_WEIGHT = 1e-3  # of an entry in it
_NOTHING, _SOMETHING = 1e-9, 1e-5  # parts of the largest singular value
_MOST_MASS = 10**6
_SHOWN_DIGITS = 3  # decimals of a number that is shown


def describe_numbers(step: UserMap, doubles: str = "doubles") -> str:
    """Name the numbers that the step computes in; `doubles`: the name of those."""
    return doubles if step.numbers is DOUBLE else step.numbers.declared_as


def describe_places(step: UserMap, places: Sequence[TrialPlace]) -> Prose:
    """Describe the places and step sizes that were looked at."""
    n = step.degrees
    ranges = []
    for name, part in (("p", slice(0, n)), ("q", slice(n, 2 * n))):
        largest = max(max(abs(x) for x in place.z[part]) for place in places)
        ranges.append(f"|{name}| ≤ {_plain(largest)}")
    if step.moving:
        times = [place.t for place in places]
        ranges.append(f"{_plain(min(times))} ≤ t ≤ {_plain(max(times))}")
    count = f"{len(places)} place" + ("s" if len(places) != 1 else "")
    parts = [count, *ranges]
    steps = [place.step for place in places if place.step]
    if steps:
        parts.append(f"h ≤ {_plain(max(steps))}")
    return prose(join_prose(", ", parts))


def _plain(x: Fraction) -> str:
    if x.denominator <= 1000 and abs(x.numerator) < 10**5:
        return str(x)
    return Number(f"{float(x):.{_SHOWN_DIGITS}g}")


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
    if structure.lost:
        notes.append(f"at {len(structure.lost)} calls it returned no state: {structure.lost[0]}")
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
    return [
        f"in {describe_numbers(step, 'floats')}: an error of p' − p or q' − q below about "
        f"`{unseen:.0e}` of them is not seen"
    ]


# -- other forms ----------------------------------------------------------------------------------


def note_digits(readings: Sequence[DefectReading]) -> list[str]:
    """Return a sentence where the map is a matrix of few digits that a symplectic one rounds to."""
    import numpy as np

    first = np.array(readings[0].jacobian)
    size = np.abs(first).max()
    if len(readings) < 2 or any(
        np.abs(np.array(x.jacobian) - first).max() > _SAME_JACOBIAN * size for x in readings
    ):
        return []
    digits = _digits(first)
    if digits is None or _change(first) > 0.5 * 10.0**-digits * (1 + 1e-6):
        return []
    ending = {1: "st", 2: "nd", 3: "rd"}.get(digits if digits < 4 else 0, "th")
    return [
        f"a symplectic matrix lies within half a unit of the {digits}{ending} digit of its entries"
    ]


def _digits(matrix: "np.ndarray") -> int | None:
    """Return how many digits after the point the entries have at most; None where they have
    more."""
    import numpy as np

    # 4e-16 is about two units of a double's last place: what a printed decimal may be off by.
    for digits in range(_MOST_DIGITS + 1):
        scaled = matrix * 10.0**digits
        if np.all(np.abs(scaled - np.round(scaled)) <= 4e-16 * np.abs(scaled)):
            return digits
    return None


def _change(matrix: "np.ndarray") -> float:
    """Minimize the largest change of an entry by which a symplectic matrix is reached.

    The change δ of least norm solves MᵀΩδ + δᵀΩM = −S; its large entries get more weight in each
    turn.
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
    for _ in range(_TURNS):
        change = weights * np.linalg.lstsq(rows * weights, target, rcond=None)[0]
        largest = np.abs(change).max()
        smallest = min(smallest, largest)
        if largest == 0:
            return 0.0
        weights *= (np.abs(change) / largest + 0.05) ** -0.3
        # An entry that need not change would else outgrow all others, which were then left out.
        weights = np.maximum(weights / weights.max(), _LEAST_WEIGHT)
    return float(smallest)


def note_masses(readings: Sequence[DefectReading], names: Sequence[str]) -> list[str]:
    """Return a sentence where the map keeps Σ m_i dp_i∧dq_i with masses that are not all alike."""
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
            rows.append(row * reading.scales[a, b])
    # A null vector of this system are masses with which Σ m dp∧dq is preserved; it must be the only
    # one, or the masses are not determined.
    _, sizes, directions = np.linalg.svd(np.array(rows))
    if sizes[-1] > _NOTHING * sizes[0] or sizes[-2] < _SOMETHING * sizes[0]:
        return []
    smallest = min(directions[-1], key=abs)
    if abs(smallest) * _MOST_MASS < 1:
        return []
    masses = directions[-1] / smallest
    if not np.all(masses > 0) or np.ptp(masses) < _SOMETHING:
        return []
    masses_text = ", ".join(f"{x:.6g}" for x in masses)
    return [
        f"it keeps Σ m dp∧dq with m = ({masses_text}), up to a factor: taken as velocities, "
        "in momenta p = m·v it is symplectic"
    ]


def masses_of(hamiltonian: Hamiltonian) -> tuple[Fraction, ...]:
    """Return m_i of an H = Σ p_i²/(2 m_i) + V(q); () where H is another, or all are 1."""
    from verify.algebra.formula import symbol

    half, masses = hamiltonian.degrees, []
    for name in hamiltonian.coordinates[:half]:
        slope = hamiltonian.exact.diff(symbol(name))
        rate = slope.diff(symbol(name))
        if not rate.is_Rational or rate <= 0 or slope.subs(symbol(name), 0) != 0:
            return ()
        masses.append(Fraction(int(rate.q), int(rate.p)))
    return tuple(masses) if set(masses) != {Fraction(1)} else ()
