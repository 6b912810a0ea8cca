"""Notes on a map that is not symplectic: the mistake that its defect S = JᵀΩJ − Ω shows.

p or q may be turned at the end, velocities p/m returned in place of momenta, or slopes x' taken for
momenta (1 + δ) x', as in accelerators.
"""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from verify.integrators.measures.measurement import REFUTING_RATIO
from verify.integrators.measures.reading import DefectReading

if TYPE_CHECKING:
    import numpy as np

_SLOPES_TOLERANCE = 1e-9  # relative, of a form that is kept


def note_constants(readings: Sequence[DefectReading], names: Sequence[str]) -> list[str]:
    """Return a sentence if JᵀΩJ is Σ c_i dp_i∧dq_i with the same numbers c_i in all readings."""
    half = len(names) // 2
    pairs = [(i, half + i) for i in range(half)]
    first, others = readings[0], readings[1:]
    if not others or any(
        x.ratio > REFUTING_RATIO
        for reading in readings
        for at, x in reading.components.items()
        if at not in pairs
    ):
        return []
    entries = [first.components[at] for at in pairs]
    if any(
        abs(x.value - y.value) > REFUTING_RATIO * (x.noise + y.noise)
        for reading in others
        for x, y in zip((reading.components[at] for at in pairs), entries, strict=True)
    ):
        return []
    factors = [1 + x.value for x in entries]
    if all(x.ratio <= REFUTING_RATIO for x in entries):  # a proof alone shows that S is not 0
        return []
    if all(abs(x.value + 2) <= REFUTING_RATIO * x.noise for x in entries):
        return [f"S = −2Ω: {_describe_turn(readings, names)}"]
    numbers = ", ".join(f"{c:.6g}" for c in factors)
    size = numbers if half == 1 else f"({numbers})"
    text = f"JᵀΩJ is Σ c dp∧dq with c = {size} at every place"
    if len({first.h, *(x.h for x in others)}) > 1 and all(c > 0 for c in factors):
        masses = ", ".join(f"{1 / c:.6g}" for c in factors)
        return [f"{text} and every h, as where velocities p/m are returned in place of momenta, "
                f"m = ({masses})"]  # fmt: skip
    return [f"{text}, as where p is multiplied by c at the end: by friction, or by 1/m, where "
            "velocities are returned in place of momenta"]  # fmt: skip


def _describe_turn(readings: Sequence[DefectReading], names: Sequence[str]) -> str:
    """Tell what is turned, by the signs of the diagonal of J at the smallest step."""
    half = len(names) // 2
    jacobian = min(readings, key=lambda x: x.h).jacobian
    diagonal = [jacobian[k][k] for k in range(2 * half)]
    if max(diagonal[:half]) < 0 < min(diagonal[half:]):
        return "p is turned at the end"
    if max(diagonal[half:]) < 0 < min(diagonal[:half]):
        return "q is turned at the end"
    return "p or q is turned, or they are exchanged"


def note_slopes(
    readings: Sequence[DefectReading],
    end_of: Callable[[DefectReading], Sequence[float] | None],
    names: Sequence[str],
) -> list[str]:
    """Return a sentence if the map keeps Σ d((1 + δ) p_i)∧dq_i ± dp_k∧dq_k, with δ one of the last
    pair p_k, q_k, whose p_i are slopes."""
    import numpy as np

    half = len(names) // 2
    ends = [end_of(x) for x in readings] if half > 1 else [None]
    if len(ends) < 2 or any(x is None for x in ends):
        return []
    for delta in (half - 1, 2 * half - 1):
        for sign in (1.0, -1.0):
            gaps = []
            for reading, end in zip(readings, ends, strict=True):
                jacobian = np.array(reading.jacobian)
                before = _form_of_slopes([float(x) for x in reading.place.z], delta, sign)
                after = _form_of_slopes(end or (), delta, sign)
                gap = jacobian.T @ after @ jacobian - before
                gaps.append(np.abs(gap).max() / max(np.abs(before).max(), np.abs(after).max()))
            if max(gaps) < _SLOPES_TOLERANCE:
                name = names[delta]
                return [f"it keeps the form of momenta (1 + {name}) p: slopes x' are taken in "
                        "place of momenta"]  # fmt: skip
    return []


def _form_of_slopes(z: Sequence[float], delta: int, sign: float) -> "np.ndarray":
    """Return the matrix of Σ d((1 + δ) p_i)∧dq_i + sign dp_k∧dq_k."""
    import numpy as np

    size, half = len(z), len(z) // 2
    form = np.zeros((size, size))
    for i in range(half - 1):
        form[i, half + i] += 1 + z[delta]
        form[delta, half + i] += z[i]
    form[half - 1, size - 1] += sign
    return form - form.T
