"""A second look at what the first one refuted; where it does not confirm it, nothing is refuted."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Any

from verify.audits.methods.float_step import FAILURES, finding
from verify.audits.methods.integrator import FloatStep, Map, ReleasedIntegrator
from verify.audits.table_convergence import SystemConvergence, slopes_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.tables.cost import Severity
from verify.integrators.tables.entry import TableEntry
from verify.prose import Prose, prose
from verify.verdict import Verdict

OF_ORDERS = (
    Severity.WRONG_ORDER,
    Severity.WRONG_CLOCK,
    Severity.WRONG_WEIGHTS,
)  # severities of which a step's slopes tell
_FIRST = ", {} first"
_SIZES = tuple(1 / 2**k for k in range(1, 9))
_PARTS = 32
_NOISE = 2.0**-44
_WITHIN = 0.3  # of a whole power
_TIME = 0.6875


@dataclass(frozen=True)
class Look:
    """A second look: does it confirm that the order is lower than is claimed?

    `confirms`: all that was looked at has a lower order. `sentence`: one clause of what was seen.
    `slopes`: the convergence of a table's steps on each system.
    """

    confirms: bool
    sentence: str
    slopes: tuple[SystemConvergence, ...] = ()


def look_again(
    verdict: Verdict, evidence: Prose, severity: str, look: Callable[[], Look | None]
) -> tuple[Verdict, Prose]:
    """Return UNDECIDED if an order is refuted and a second look does not show it; with what it
    shows.

    `look` is called for such an order alone, and returns None if there is no other means.
    """
    second = look() if verdict is Verdict.REFUTED and severity in OF_ORDERS else None
    if second is None:
        return verdict, evidence
    return verdict if second.confirms else Verdict.UNDECIDED, prose(
        evidence, f"; {second.sentence}"
    )


def look_at_claim(entry: TableEntry, kind: str) -> Look | None:
    """Look at the order that an entry claims in its claim of that kind; None if it claims
    none."""
    claimed = claimed_of(entry, kind)
    return None if claimed is None else look_at_table(entry, kind, claimed)


def look_at_table(entry: TableEntry, kind: str, claimed: int, exact: bool = False) -> Look:
    """Look at a printed table's claim of that kind: its steps at 60 digits, for two systems.

    `exact`: its numbers stand for no others, so that steps may be as small as a residual needs.
    """
    embedded, timed = kind.startswith("embedded"), kind.startswith(("order in time", "row sums"))
    for first in ("kick", "drift"):
        if kind.endswith(_FIRST.format(first)):
            entry = entry.model_copy(update={"first": first})
    try:
        slopes = slopes_of(entry, timed, embedded)
        if exact and not any(x.below(claimed) for x in slopes):
            slopes = slopes_of(entry, timed, embedded, small=True)
    except TypeError:
        return Look(False, f"steps of a {entry.kind} are not made a second time")
    orders = [x.order for x in slopes]
    confirms = all(x.below(claimed) for x in slopes) and orders != [None, None]
    return Look(confirms, _describe_orders(orders, "steps at 60 digits"), slopes)


def look_at_step(integrator: ReleasedIntegrator, claimed: int) -> Look:
    """Look at a step in floats: its own convergence, and the probe at a second problem if there is
    one."""
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
    """Estimate the order from errors of one step against 32 steps of a 32nd, for h = 1/2 … 1/256;
    None if no whole power is seen above rounding. Raises what the step raises."""
    degrees, timed = hamiltonian.degrees, hamiltonian.time_dependent
    rows = []
    for h in _SIZES:
        # The finer steps share every mistake of the map but its truncation: its own limit is what
        # is compared, so that no exact flow is needed.
        error = max(_error(step, z, h, timed, degrees) for z in _starts(points, degrees))
        if error > _NOISE * 100:
            rows.append((h, error))
    powers = [math.log2(x / y) for (_, x), (_, y) in pairwise(rows)]
    # From the smallest step sizes up, two neighbouring slopes must agree on a whole power.
    for before, last in reversed([*pairwise(powers)]):
        power = round(last)
        if abs(before - power) <= _WITHIN and abs(last - power) <= _WITHIN:
            return power - 1
    return None


def _starts(points: Sequence[tuple[Fraction, ...]], degrees: int) -> list[tuple[Any, Any]]:
    if degrees == 1:
        states = points or ((Fraction(1, 3), Fraction(3, 5)),)
        return [(float(p), float(q)) for p, q in states]
    import numpy as np

    return [(np.linspace(0.2, 0.35, degrees), np.linspace(0.3, -0.15, degrees))]


def _error(step: Map, z: tuple[Any, Any], h: float, timed: bool, degrees: int) -> float:
    """Return the distance of a step of size h from the same in parts, which are far smaller."""

    def take_step(z: tuple[Any, Any], t: float, size: float) -> tuple[Any, Any]:
        p, q = step(*z, t, size) if timed else step(*z, size)
        return p, q

    end, end_in_parts = take_step(z, _TIME, h), z
    for k in range(_PARTS):
        end_in_parts = take_step(end_in_parts, _TIME + k * h / _PARTS, h / _PARTS)
    if degrees == 1:
        return max(abs(float(x) - float(y)) for x, y in zip(end, end_in_parts, strict=True))
    return max(float(abs(x - y).max()) for x, y in zip(end, end_in_parts, strict=True))
