"""Exact numbers that satisfy a table's conditions: near those printed, or with one of them changed.

With P = U Jᵀ(J U Jᵀ)⁻¹, U the squared units (the rest as in
`verify.schemes.printed.neighbourhood`), t ↦ t − F(x₀ + P t) may map a ball around −F(x₀) into
itself: then, by Brouwer, a solution exists, and it is known where.

Conditions may depend on one another, as those of trees do where simplifying assumptions hold. Then
a solution of as many as are independent at x₀ is shown to exist, and the others are evaluated
there: where their residuals are 0 to `HELD`, that is no proof, and much more than chance.

A single misprinted number is looked for too: which it can be, and the value it would have to have.
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
_TURNS = 40
_CLOSE = flint.arb(2) ** -290  # of a chord's step, the last one
_FEW, _FAR = 12, 20  # at most so many numbers in the search far away, and their size there

_MISPRINT_TURNS = 9
_FEW_CONDITIONS = 8  # failing ones used in the search for one number; then all are checked
_ZERO = flint.arb(2) ** -150  # a residual that is 0, where no number is rounded
_MOST_ENTRIES = 200  # among which one misprint is searched
_QUOTIENT_CLOSE = Fraction(1, 10**40)  # to the quotient that a misprint stands for
_LARGEST_DENOMINATOR = 10**12


@dataclass(frozen=True)
class NearbySolution:
    """A solution: its distance from the printed numbers, in units of the last digit, and its
    numbers; how many conditions are shown to hold there, and a bound of the others' residuals."""

    distance: Fraction
    numbers: Mapping[str, Fraction]
    shown_count: int
    other_residual: Fraction = Fraction(0)


def nearest(near: Neighbourhood, rows: Sequence[int]) -> NearbySolution | None:
    """Return a solution of these conditions; None where none is shown to exist, or where those that
    depend on others do not hold there."""
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
    for _ in range(_TURNS):  # chords: far faster than they are needed
        value = near.residuals(point, chosen)
        change = (inverse * flint.arb_mat([[value[k].mid()] for k in chosen])).tolist()
        point = [(x - d).mid() for x, (d,) in zip(point, change, strict=True)]
        if all(abs(d) < _CLOSE for (d,) in change):
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
    """Return a solution that may be far from the printed numbers, by Newton's method; None where it
    finds none, or one of many. It is for few numbers only."""
    if len(near.names) > _FEW or not rows:
        return None
    point, slope = list(near.start), near.slope
    for _ in range(_TURNS):
        value = near.residuals(point, rows)
        chosen = near.choices(rows)[-1]
        inverse = near.inverse(chosen, slope)
        if inverse is None:
            return None
        change = (inverse * flint.arb_mat([[value[k].mid()] for k in chosen])).tolist()
        point = [(x - d).mid() for x, (d,) in zip(point, change, strict=True)]
        if all(abs(d) < _CLOSE for (d,) in change) or not all(abs(x) < _FAR for x in point):
            break
        slopes = near.slopes(point, near.residuals(point, rows))
        slope = {k: [x.mid() for x in row] for k, row in slopes.items()}
    values = {n: midpoint_and_radius(x)[0] for n, x in zip(near.names, point, strict=True)}
    if not all(abs(x) < _FAR for x in point):
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
    """Return balls around `point` in which a solution lies; None where that is not shown."""
    value = near.residuals(point, rows)
    slope = near.slopes(point, value)
    inverse = near.inverse(rows, slope)
    if inverse is None:
        return None
    target = [-value[k] for k in rows]
    # The ball must contain its own image: it is twice as large as the target, plus a rounding
    # margin.
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
        # The remainder of Taylor's formula over the whole reach of the ball.
        curvature = symmetric_ball(near.second[k] * reach * reach / 2)
        if not ball[i, 0].contains_interior(target[i] + image[i][0] + curvature):
            return None
    return [x + d for x, d in zip(point, offsets, strict=True)]


def _upper(x: Ball) -> Fraction:
    middle, radius = midpoint_and_radius(x)
    return abs(middle) + radius


# -- one number alone ------------------------------------------------------------------------------


@dataclass(frozen=True)
class Misprint:
    """A number that alone, with the value `value`, would make the conditions hold to the digits."""

    name: str
    printed: str
    value: Fraction


def misprints(
    near: Neighbourhood, rows: Sequence[int], single: bool = False
) -> tuple[Misprint, ...]:
    """Return the numbers of which the change of each alone would do; `single`: none where several
    would.

    Where only last digits are wrong, several seem to do: the digits of the others leave room.
    """
    failing = [i for i in rows if not _is_small(near, i, near.value[i])]
    few = failing[:_FEW_CONDITIONS] or list(rows[:_FEW_CONDITIONS])
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
    for turn in range(_MISPRINT_TURNS):
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
            return None  # no change of this number alone brings them down
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
    return bool(abs(value) < sum((abs(d) * u for d, u in pairs), _ZERO))


def _least_squares(slope: Sequence[Ball], value: Sequence[Ball]) -> Ball | None:
    square = sum((d * d for d in slope), flint.arb(0))
    if square == 0:
        return None
    return sum((d * v for d, v in zip(slope, value, strict=True)), flint.arb(0)) / square


# -- of exact tables ------------------------------------------------------------------------------


def find_exact_misprints(conditions: ConditionSet, order: int) -> tuple[Misprint, ...]:
    """Return the rational entries, not 0, each of which alone would do, with the quotient for
    it."""
    count = len(conditions.entry_names)
    if not 0 < count <= _MOST_ENTRIES or not all(x.is_Rational for x in conditions.entries):
        return ()
    names = [f"x{k}" for k in range(count)]
    values = {
        n: Fraction(int(x.p), int(x.q)) for n, x in zip(names, conditions.entries, strict=True)
    }
    texts = dict(zip(names, map(str, conditions.entries), strict=True))
    unknowns = AnyNumbers(texts, values, dict.fromkeys(names, _QUOTIENT_CLOSE**2))
    free = replace(conditions, entries=tuple(map(symbol, names)))
    with working_precision(BITS):
        near = misprints(Neighbourhood(unknowns, free), conditions.up_to(order))
    exact = (_by_quotient(conditions, order, names.index(m.name), m.value) for m in near)
    return tuple(m for m in exact if m is not None)


def _by_quotient(conditions: ConditionSet, order: int, k: int, near: Fraction) -> Misprint | None:
    """Return entry k with the quotient near that value; None where the conditions do not hold with
    it."""
    value = near.limit_denominator(_LARGEST_DENOMINATOR)
    if abs(value - near) > _QUOTIENT_CLOSE or value == conditions.entries[k]:
        return None
    entries = [flint.fmpq(int(x.p), int(x.q)) for x in conditions.entries]
    entries[k] = flint.fmpq(value.numerator, value.denominator)
    residuals = conditions.residuals(entries, flint.fmpq(1))
    if any(residuals[i] != 0 for i in conditions.up_to(order)):
        return None
    return Misprint(conditions.entry_names[k], str(conditions.entries[k]), value)
