"""The first coefficient in h of a structure's defect that does not vanish, for one step map.

The defect is expanded in h. If all coefficients up to some power vanish, the step written out shows
whether it is the zero function, and where it begins if it is a polynomial in h.
"""

from collections.abc import Iterable
from functools import lru_cache, partial

from verify.algebra.ring import Decision
from verify.effort import MAX_CALLS, answer_unless_long
from verify.errors import LimitError
from verify.proof.expansion import (
    MOST_ORDERS,
    VANISHES,
    Leading,
    TaylorExpansion,
    closed_series_of,
)
from verify.proof.order_for_one_h import leading_of
from verify.proof.structures.difference_from_flow import (
    ComponentLeading,
    first_nonzero,
    leading_by_difference,
)
from verify.proof.structures.structure_theorems import commutes, is_kept_by_coefficients
from verify.proof.structures.structure_values import closed_values, series_values
from verify.schemes.maps.step_map import StepMap
from verify.schemes.scheme import Scheme
from verify.structures import CanonicalForm, Structure
from verify.structures.reversible import Reversible
from verify.structures.symmetric import SYMMETRIC

# The last examined power of h, by the number of coordinates; and how far the defect is followed
# beyond the scheme's order at least.
_MOST = {1: MOST_ORDERS, 2: MOST_ORDERS, 3: 8, 4: 8}
_MOST_IN_MANY = 6
_MOST_BEYOND = 4


# Several claims may be on one structure. The cache is small, as an answer keeps its ring.
@lru_cache(maxsize=16)
def leading_of_structure(
    step_map: StepMap, structure: Structure, scheme: Scheme | None, of_flow: bool
) -> tuple[str, Leading]:
    """Return the leading coefficient of the defect, and the name of its component.

    `of_flow`: True if it is shown that the exact flow keeps the structure.
    """
    if isinstance(structure, CanonicalForm):
        leading = leading_of(step_map)  # its own fast path
        return leading.entry, leading
    if of_flow:
        names = step_map.hamiltonian.coordinates
        if isinstance(structure, Reversible) and commutes(scheme, structure, names):
            return leading_of_structure(step_map, SYMMETRIC, scheme, of_flow)  # the same defect
        if is_kept_by_coefficients(step_map, structure, scheme):
            return "", VANISHES
    order = scheme.order if scheme else 1
    most = max(_MOST.get(len(step_map.field.names), _MOST_IN_MANY), order + _MOST_BEYOND)
    first = min(most, order + 2)
    result = leading_by_difference(step_map, structure, first) if of_flow else None
    if result is None and _begins_with_z(step_map):
        result = _in_series(step_map, structure, 0, first)
    begin = first + 1
    if result is None:
        result = _in_closed_form(step_map, structure, most)
    for reach in (*range(first + 2, most, 2), most):
        if result is not None or begin > reach:
            break
        # Derivatives of roots in roots, for one, grow with each power.
        search = partial(_in_series, step_map, structure, begin, reach)
        otherwise: ComponentLeading | None = _leave_undecided(begin)
        result = answer_unless_long(search, otherwise, MAX_CALLS)
        begin = reach + 1
    return result or _leave_undecided(most + 1)


def _leave_undecided(power: int) -> ComponentLeading:
    """Return the answer that the coefficients below h^power vanish, and no more is known."""
    return "", Leading(power, Decision(None))


def _begins_with_z(step_map: StepMap) -> bool:
    """Return True unless the map, written out, is not shown to be z at h = 0."""
    if step_map.formulas is None or step_map.expand is not None:
        return True
    try:
        return closed_series_of(step_map).agrees(0)[0] is True
    except LimitError:
        return True  # it is no power series, as is told then


def _first(results: Iterable[ComponentLeading | None]) -> ComponentLeading | None:
    return next((x for x in results if x is not None), None)


def _in_series(
    step_map: StepMap, structure: Structure, begin: int, most: int
) -> ComponentLeading | None:
    """Return the first coefficient from h^begin to h^most that is not shown to vanish, or None."""
    try:
        components = structure.defect(series_values(step_map, structure, most))
    except LimitError:
        return _leave_undecided(begin)
    return _first(
        first_nonzero(n, {name: (x.ring, x.coefficients[n]) for name, x in components.items()})
        for n in range(begin, most + 1)
    )


def _in_closed_form(step_map: StepMap, structure: Structure, most: int) -> ComponentLeading | None:
    """Return the leading coefficient of the defect, written out; None if that does not show it."""

    def search() -> ComponentLeading | None:
        values = closed_values(step_map, structure)
        if values is None:
            return None
        ring = values.ring
        defect = {name: ring.reduce(x.value) for name, x in structure.defect(values).items()}
        if all(ring.vanishes(x) is True for x in defect.values()):
            return "", VANISHES
        parts = {name: TaylorExpansion(ring, x) for name, x in defect.items()}
        last = most
        if all(x.polynomial for x in parts.values()):
            last = max(n for x in defect.values() for n in ring.powers(x, "h"))
        elif _begins_with_z(step_map):
            return None  # its series is at hand, and shorter
        return _first(
            first_nonzero(n, {name: x.coefficient(n) for name, x in parts.items()})
            for n in range(last + 1)
        )

    try:
        return answer_unless_long(search, None, MAX_CALLS // 2)
    except LimitError:
        return None
