"""Exact numbers that satisfy a table's conditions: near those printed, or with one of them changed.

Let P = U Jᵀ(J U Jᵀ)⁻¹ with U the squared units; `verify.schemes.printed.neighbourhood` defines F, J
and x₀. If t ↦ t − F(x₀ + P t) maps a ball around −F(x₀) into itself, then by Brouwer's theorem a
solution x₀ + P t exists with t in the ball.

Conditions may depend on one another, as those of trees do if simplifying assumptions hold. Then a
solution of a set that is independent at x₀ is shown to exist, and the others are evaluated there.
If their residuals are below `HELD`, that is no proof, but much more than chance.

A single misprint is searched too: a number that can be wrong, and the value that would be right.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import flint

from verify.algebra.formula import symbol
from verify.arithmetic.arb import Ball, midpoint_and_radius, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.schemes.printed.condition_set import BITS, ConditionSet
from verify.schemes.printed.neighbourhood import (
    RADIUS,
    AnyNumbers,
    Neighbourhood,
    difference_step,
    symmetric_ball,
)

HELD = Fraction(1, 2**200)
_MOST_ITERATIONS = 40
_STEP_TOLERANCE = flint.arb(2) ** -290  # an iteration ends after a smaller step
# Limits of the search far away: how many numbers a table may have, and how large they may become.
_FEW_NUMBERS, _LARGEST_NUMBER = 12, 20

_MISPRINT_ITERATIONS = 9
_MOST_FAILING_CONDITIONS = 8  # used in the search for a misprint; then all conditions are checked
_ZERO_TOLERANCE = flint.arb(2) ** -150  # a smaller residual counts as 0
_MOST_ENTRIES = 200  # limit of the entries of an exact table for the search of a misprint
_QUOTIENT_TOLERANCE = Fraction(1, 10**40)  # a number so near to a quotient stands for it
_LARGEST_DENOMINATOR = 10**12


@dataclass(frozen=True)
class NearbySolution:
    """A solution near printed numbers.

    `distance`: the largest distance of a number, in units of the last digit. `numbers`: those of
    the solution. `shown_count`: the number of conditions that are shown to hold. `other_residual`:
    a bound of the residuals of the others.
    """

    distance: Fraction
    numbers: Mapping[str, Fraction]
    shown_count: int
    other_residual: Fraction = Fraction(0)


def nearest(near: Neighbourhood, rows: Sequence[int]) -> NearbySolution | None:
    """Return a solution of the conditions `rows` near the printed numbers.

    None if no solution is shown to exist, or if the dependent conditions do not hold there.
    """
    if not rows:
        return NearbySolution(Fraction(0), dict(near.numbers.values), 0)
    solutions = (_nearest(near, rows, chosen) for chosen in near.choices(rows))
    return next((x for x in solutions if x is not None), None)


def _nearest(
    near: Neighbourhood, rows: Sequence[int], chosen: Sequence[int]
) -> NearbySolution | None:
    inverse = near.inverse(chosen, near.slope)
    if inverse is None:
        return None
    point = list(near.start)
    for _ in range(_MOST_ITERATIONS):  # the chord method: it converges long before the limit
        value = near.residuals(point, chosen)
        change = (inverse * flint.arb_mat([[value[k].mid()] for k in chosen])).tolist()
        point = [(x - d).mid() for x, (d,) in zip(point, change, strict=True)]
        if all(abs(d) < _STEP_TOLERANCE for (d,) in change):
            break
    if not all(
        abs(x - y) < rational_ball(RADIUS / 4) for x, y in zip(point, near.start, strict=True)
    ):
        return None
    balls = _solution(near, chosen, point)
    if balls is None:
        return None
    triples = list(zip(near.names, near.start, balls, strict=True))
    distance = max(_upper(y - x) / near.numbers.units[n] for n, x, y in triples)
    # The dependent conditions are not part of the proof: their residuals are only bounded.
    others = sorted(set(rows) - set(chosen))
    dependent_residuals = near.residuals(balls, others).values() if others else ()
    largest = max(map(_upper, dependent_residuals), default=Fraction(0))
    numbers = {n: midpoint_and_radius(y)[0] for n, _, y in triples}
    return NearbySolution(distance, numbers, len(chosen), largest) if largest < HELD else None


def find_far_solution(near: Neighbourhood, rows: Sequence[int]) -> NearbySolution | None:
    """Return a solution that may be far from the printed numbers, by Newton's method.

    None if there are many numbers, if none is found, and if the solution is not an isolated one.
    """
    if len(near.names) > _FEW_NUMBERS or not rows:
        return None
    point, slope = list(near.start), near.slope
    for _ in range(_MOST_ITERATIONS):
        value = near.residuals(point, rows)
        chosen = near.choices(rows)[-1]
        inverse = near.inverse(chosen, slope)
        if inverse is None:
            return None
        change = (inverse * flint.arb_mat([[value[k].mid()] for k in chosen])).tolist()
        point = [(x - d).mid() for x, (d,) in zip(point, change, strict=True)]
        if all(abs(d) < _STEP_TOLERANCE for (d,) in change) or not all(
            abs(x) < _LARGEST_NUMBER for x in point
        ):
            break
        slopes = near.slopes(point, near.residuals(point, rows))
        slope = {k: [x.mid() for x in row] for k, row in slopes.items()}
    values = {n: midpoint_and_radius(x)[0] for n, x in zip(near.names, point, strict=True)}
    if not all(abs(x) < _LARGEST_NUMBER for x in point):
        return None
    moved_numbers = AnyNumbers(near.numbers.numbers, values, near.numbers.units)
    solution = nearest(Neighbourhood(moved_numbers, near.conditions), rows)
    if solution is None or solution.shown_count < len(near.names):
        return None
    gaps = (abs(solution.numbers[n] - x) / near.numbers.units[n] for n, x in
            near.numbers.values.items())  # fmt: skip
    return NearbySolution(
        max(gaps), solution.numbers, solution.shown_count, solution.other_residual
    )


def _solution(near: Neighbourhood, rows: Sequence[int], point: Sequence[Ball]) -> list[Ball] | None:
    """Return balls around `point` that contain a solution; None if that is not shown."""
    value = near.residuals(point, rows)
    slope = near.slopes(point, value)
    inverse = near.inverse(rows, slope)
    if inverse is None:
        return None
    target = [-value[k] for k in rows]
    # The ball must contain its image: its radius is twice the target's size plus a rounding margin.
    slack = 2 * max((x.abs_upper() for x in target), key=float) + flint.arb(2) ** -240
    ball = flint.arb_mat([[x + symmetric_ball(slack)] for x in target])
    offsets = [x for (x,) in (inverse * ball).tolist()]
    reach = sum((abs(x) for x in offsets), flint.arb(0))
    if not reach < rational_ball(RADIUS / 4):
        return None
    size = len(rows)
    identity = flint.arb_mat([[int(i == j) for j in range(size)] for i in range(size)])
    remainder = identity - flint.arb_mat([slope[k] for k in rows]) * inverse
    image = (remainder * ball).tolist()
    for i, k in enumerate(rows):
        # The remainder of Taylor's formula over the whole ball.
        curvature = symmetric_ball(near.second[k] * reach * reach / 2)
        if not ball[i, 0].contains_interior(target[i] + image[i][0] + curvature):
            return None
    return [x + d for x, d in zip(point, offsets, strict=True)]


def _upper(x: Ball) -> Fraction:
    middle, radius = midpoint_and_radius(x)
    return abs(middle) + radius


# -- a single misprint -----------------------------------------------------------------------------


@dataclass(frozen=True)
class Misprint:
    """A number that, if changed to `value`, would make the conditions hold to the digits."""

    name: str
    printed: str
    value: Fraction


def misprints(
    near: Neighbourhood, rows: Sequence[int], single: bool = False
) -> tuple[Misprint, ...]:
    """Return the numbers each of which, changed alone, would make the conditions hold.

    `single`: return none if there are several. If only last digits are wrong, several numbers seem
    to do, as the digits of the others leave room.
    """
    failing = [i for i in rows if not _is_small(near, i, near.value[i])]
    few = failing[:_MOST_FAILING_CONDITIONS] or list(rows[:_MOST_FAILING_CONDITIONS])
    candidates = (_single(near, k, rows, few) for k in range(len(near.names)))
    suspects = tuple(m for m in candidates if m is not None)
    return () if single and len(suspects) > 1 else suspects


def _single(
    near: Neighbourhood, k: int, rows: Sequence[int], few: Sequence[int]
) -> Misprint | None:
    """Solve for one number by Newton's method, in the sense of least squares."""
    numbers, value = list(near.start), near.value
    largest = max(abs(value[i]) for i in few)
    slope = [near.slope[i][k].mid() for i in few]
    for turn in range(_MISPRINT_ITERATIONS):
        if turn:
            shifted = near.shifted_residuals(numbers, k, few)
            slope = [((shifted[i] - value[i]) / difference_step()).mid() for i in few]
        change = _least_squares(slope, [value[i] for i in few])
        if change is None:
            return None
        numbers[k] = (numbers[k] - change).mid()
        value = near.residuals(numbers, few)
        # Most numbers fail here, after one step: only promising ones are iterated.
        if turn == 0 and not all(abs(value[i]) < largest for i in few):
            return None  # no change of this number alone makes the residuals small
    if not all(_is_small(near, i, value[i]) for i in few):
        return None
    value = near.residuals(numbers, rows)
    if not all(_is_small(near, i, value[i]) for i in rows):
        return None
    name = near.names[k]
    return Misprint(name, near.numbers.numbers[name], midpoint_and_radius(numbers[k])[0])


def _is_small(near: Neighbourhood, i: int, value: Ball) -> bool:
    """Return True if a residual is as small as the digits allow."""
    pairs = zip(near.slope[i], near.unit, strict=True)
    return bool(abs(value) < sum((abs(d) * u for d, u in pairs), _ZERO_TOLERANCE))


def _least_squares(slope: Sequence[Ball], value: Sequence[Ball]) -> Ball | None:
    square = sum((d * d for d in slope), flint.arb(0))
    if square == 0:
        return None
    return sum((d * v for d, v in zip(slope, value, strict=True)), flint.arb(0)) / square


# -- exact tables ---------------------------------------------------------------------------------


def find_exact_misprints(conditions: ConditionSet, order: int) -> tuple[Misprint, ...]:
    """Return the possible misprints of a rational table, each with the right quotient."""
    count = len(conditions.entry_names)
    if not 0 < count <= _MOST_ENTRIES or not all(x.is_Rational for x in conditions.entries):
        return ()
    names = [f"x{k}" for k in range(count)]
    values = {
        n: Fraction(int(x.p), int(x.q)) for n, x in zip(names, conditions.entries, strict=True)
    }
    texts = dict(zip(names, map(str, conditions.entries), strict=True))
    unknowns = AnyNumbers(texts, values, dict.fromkeys(names, _QUOTIENT_TOLERANCE**2))
    free = replace(conditions, entries=tuple(map(symbol, names)))
    with working_precision(BITS):
        near = misprints(Neighbourhood(unknowns, free), conditions.up_to(order))
    exact = (_by_quotient(conditions, order, names.index(m.name), m.value) for m in near)
    return tuple(m for m in exact if m is not None)


def _by_quotient(conditions: ConditionSet, order: int, k: int, near: Fraction) -> Misprint | None:
    """Return the misprint of entry k with the quotient near `near`.

    None if the conditions do not hold exactly with it.
    """
    value = near.limit_denominator(_LARGEST_DENOMINATOR)
    if abs(value - near) > _QUOTIENT_TOLERANCE or value == conditions.entries[k]:
        return None
    entries = [flint.fmpq(int(x.p), int(x.q)) for x in conditions.entries]
    entries[k] = flint.fmpq(value.numerator, value.denominator)
    residuals = conditions.residuals(entries, flint.fmpq(1))
    if any(residuals[i] != 0 for i in conditions.up_to(order)):
        return None
    return Misprint(conditions.entry_names[k], str(conditions.entries[k]), value)
