"""A second look at a refuted order, by other means: an order is refuted only if it confirms that.

A printed table is looked at by steps with 60 digits, a step in floats by its own convergence.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Any

from verify.audits.methods.float_step import FAILURES, finding
from verify.audits.methods.integrator import FloatStep, Map, ReleasedIntegrator
from verify.audits.table_convergence import SystemConvergence, measure_convergence
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.tables.cost import Severity
from verify.integrators.tables.entry import TableEntry
from verify.prose import Prose, prose
from verify.verdict import Verdict

ORDER_SEVERITIES = (
    Severity.WRONG_ORDER,
    Severity.WRONG_CLOCK,
    Severity.WRONG_WEIGHTS,
)  # the severities on which the slopes of a step's errors decide
_FIRST_SUFFIX = ", {} first"
_STEP_SIZES = tuple(1 / 2**k for k in range(1, 9))
_SMALL_STEPS = 32
_ROUNDING_ERROR = 2.0**-44
_NOISE_FACTOR = 100  # an error counts if it exceeds the rounding error by this factor
_ORDER_TOLERANCE = 0.3  # the largest distance of a slope from a whole power that passes for it
_START_TIME = 0.6875


@dataclass(frozen=True)
class Look:
    """A second look: does it confirm that the order is lower than is claimed?

    `confirms`: True if the order is lower on everything that was looked at. `sentence`: one clause
    on the result. `slopes`: the convergence of a table's steps on each system.
    """

    confirms: bool
    sentence: str
    slopes: tuple[SystemConvergence, ...] = ()


def look_again(
    verdict: Verdict, evidence: Prose, severity: str, look: Callable[[], Look | None]
) -> tuple[Verdict, Prose]:
    """Return the verdict after a second look, and the evidence with its result.

    Only a refuted order is looked at again: the verdict becomes UNDECIDED if `look` does not
    confirm it, and stands if `look` returns None, as there are no other means.
    """
    second = look() if verdict is Verdict.REFUTED and severity in ORDER_SEVERITIES else None
    if second is None:
        return verdict, evidence
    return verdict if second.confirms else Verdict.UNDECIDED, prose(
        evidence, f"; {second.sentence}"
    )


def look_at_claim(entry: TableEntry, kind: str) -> Look | None:
    """Look at the order that an entry claims in its claim of that kind; None if it claims none."""
    claimed = claimed_of(entry, kind)
    return None if claimed is None else look_at_table(entry, kind, claimed)


def look_at_table(entry: TableEntry, kind: str, claimed: int, exact: bool = False) -> Look:
    """Look at a printed table's claim of that kind, by steps with 60 digits on two systems.

    `exact`: True if no number is rounded, so that steps may be as small as a residual needs.
    """
    embedded, driven = kind.startswith("embedded"), kind.startswith(("order in time", "row sums"))
    for first in ("kick", "drift"):
        if kind.endswith(_FIRST_SUFFIX.format(first)):
            entry = entry.model_copy(update={"first": first})
    try:
        slopes = measure_convergence(entry, driven, embedded)
        if exact and not any(x.is_below(claimed) for x in slopes):
            slopes = measure_convergence(entry, driven, embedded, small=True)
    except TypeError:
        return Look(False, f"steps of a {entry.kind} are not made a second time")
    orders = [x.order for x in slopes]
    confirms = all(x.is_below(claimed) for x in slopes) and orders != [None, None]
    return Look(confirms, _describe_orders(orders, "steps at 60 digits"), slopes)


def look_at_step(integrator: ReleasedIntegrator, claimed: int) -> Look:
    """Look at a step in floats, by its own convergence; if there is a second problem, by that on
    it, too, and by the probe."""
    method: FloatStep = integrator.method
    orders: list[int | None] = []
    try:
        orders.append(order_of_step(method.make(), method.hamiltonian, method.points))
        second = integrator.second_step
        if second is not None:
            orders.append(order_of_step(second.make(), second.hamiltonian, second.points))
            second_finding = finding(second)
            orders.append(
                second_finding.convergence_order if second_finding.order_decided else None
            )
    except FAILURES as error:
        return Look(False, f"a second look fails: {type(error).__name__}")
    confirms = all(x is not None and x < claimed for x in orders)
    return Look(confirms, _describe_orders(orders, "its own steps, halved"))


def _describe_orders(orders: Sequence[int | None], how: str) -> str:
    order_texts = [f"order {x}" for x in dict.fromkeys(orders) if x is not None]
    return f"a second look, by {how}, shows {' and '.join(order_texts) or 'no order'}"


def claimed_of(entry: Any, kind: str) -> int | None:
    """Return the order that an entry claims in its claim of that kind."""
    if kind.startswith("embedded"):
        order: int | None = entry.embedded_order
        return order
    return getattr(entry, "order", None)


# -- a step in floats, by its own convergence -----------------------------------------------------


def order_of_step(
    step: Map, hamiltonian: Hamiltonian, points: Sequence[tuple[Fraction, ...]]
) -> int | None:
    """Estimate the order from the differences of one step and 32 steps of h/32, h = 1/2 … 1/256.

    None if they follow no whole power above rounding. Raises what the step raises.
    """
    degrees, driven = hamiltonian.degrees, hamiltonian.time_dependent
    rows = []
    for h in _STEP_SIZES:
        # The small steps converge to the limit of the map itself, so that no exact flow is needed;
        # but a mistake that does not vanish with h is not seen.
        error = max(_step_error(step, z, h, driven, degrees) for z in _starts(points, degrees))
        if error > _ROUNDING_ERROR * _NOISE_FACTOR:
            rows.append((h, error))
    powers = [math.log2(x / y) for (_, x), (_, y) in pairwise(rows)]
    # From the smallest step sizes up, two neighbouring slopes must agree on a whole power.
    for large, small in reversed([*pairwise(powers)]):
        power = round(small)
        if abs(large - power) <= _ORDER_TOLERANCE and abs(small - power) <= _ORDER_TOLERANCE:
            return power - 1
    return None


def _starts(points: Sequence[tuple[Fraction, ...]], degrees: int) -> list[tuple[Any, Any]]:
    if degrees == 1:
        states = points or ((Fraction(1, 3), Fraction(3, 5)),)
        return [(float(p), float(q)) for p, q in states]
    import numpy as np

    return [(np.linspace(0.2, 0.35, degrees), np.linspace(0.3, -0.15, degrees))]


def _step_error(step: Map, z: tuple[Any, Any], h: float, driven: bool, degrees: int) -> float:
    """Return the distance of the end of one step of size h from that of 32 steps of h/32."""

    def take_step(z: tuple[Any, Any], t: float, size: float) -> tuple[Any, Any]:
        p, q = step(*z, t, size) if driven else step(*z, size)
        return p, q

    end, end_of_small = take_step(z, _START_TIME, h), z
    for k in range(_SMALL_STEPS):
        end_of_small = take_step(end_of_small, _START_TIME + k * h / _SMALL_STEPS, h / _SMALL_STEPS)
    if degrees == 1:
        return max(abs(float(x) - float(y)) for x, y in zip(end, end_of_small, strict=True))
    return max(float(abs(x - y).max()) for x, y in zip(end, end_of_small, strict=True))
