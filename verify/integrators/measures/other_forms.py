"""Other forms that a map may have that is not symplectic: a rounded matrix, or a map in velocities.

A matrix that a program prints with few digits is not symplectic, and one that is may lie within
half a unit of its last digit. A map of positions and velocities may keep Σ m_i dv_i∧dx_i.
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.probes.reading import Reading

if TYPE_CHECKING:
    import numpy as np

_SAME = 1e-13  # of J at two places, of a linear map
_MOST_DIGITS = 14
_TURNS = 40  # of a search for the least largest change
_LEAST_WEIGHT = 1e-3  # of an entry in it
_NOTHING, _SOMETHING = 1e-9, 1e-5  # parts of the largest singular value
_MOST_MASS = 10**6


def note_digits(readings: Sequence[Reading]) -> list[str]:
    """Return a sentence where the map is a matrix of few digits that a symplectic one rounds to."""
    import numpy as np

    first = np.array(readings[0].jacobian)
    size = np.abs(first).max()
    if len(readings) < 2 or any(
        np.abs(np.array(x.jacobian) - first).max() > _SAME * size for x in readings
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
    above = np.triu_indices(size, 1)
    # One equation for each entry of S above the diagonal, in the entries of δ by rows.
    rows = np.zeros((len(above[0]), size * size))
    left = matrix.T @ omega  # (left δ)_ab − (left δ)_ba
    for row, a, b in zip(rows, *above, strict=True):
        row[b::size] += left[a]
        row[a::size] -= left[b]
    target = -defect[above]
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


def note_masses(readings: Sequence[Reading], names: Sequence[str]) -> list[str]:
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
