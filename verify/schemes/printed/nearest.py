"""Exact numbers near those that a table prints which satisfy its conditions, if they exist.

With P = U Jᵀ(J U Jᵀ)⁻¹, U the squared units (the rest as in `verify.schemes.printed.nearby`), t ↦ t
− F(x₀ + P t) may map a ball around −F(x₀) into itself: then, by Brouwer, a solution exists, and it
is known where.

Conditions may depend on one another, as those of trees do where simplifying assumptions hold. Then
a solution of as many as are independent at x₀ is shown to exist, and the others are evaluated
there: where their residuals are 0 to `HELD`, that is no proof, and much more than chance.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import flint

from verify.arithmetic.arb import Ball, midpoint_and_radius, rational_ball
from verify.schemes.printed.nearby import RADIUS, AnyNumbers, Nearby, symmetric_ball

HELD = Fraction(1, 2**200)
_TURNS = 40
_CLOSE = flint.arb(2) ** -290  # of a chord's step, the last one
_FEW, _FAR = 12, 20  # at most so many numbers in the search far away, and their size there


@dataclass(frozen=True)
class Nearest:
    """A solution: how far it is, in units of the last digit, and its numbers; how many conditions
    are shown to hold there, and the largest residue of the others, as a bound."""

    off: Fraction
    numbers: Mapping[str, Fraction]
    shown: int
    rest: Fraction = Fraction(0)


def nearest(near: Nearby, rows: Sequence[int]) -> Nearest | None:
    """Return a solution of these conditions; None where none is shown to exist, or where those that
    depend on others do not hold there."""
    if not rows:
        return Nearest(Fraction(0), dict(near.numbers.values), 0)
    solutions = (_nearest(near, rows, chosen) for chosen in near.choices(rows))
    return next((each for each in solutions if each is not None), None)


def _nearest(near: Nearby, rows: Sequence[int], chosen: Sequence[int]) -> Nearest | None:
    inverse = near.inverse(chosen, near.slope)
    if inverse is None:
        return None
    point = list(near.start)
    for _ in range(_TURNS):  # chords: far faster than they are needed
        value = near.residues(point, chosen)
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
    off = max(_upper(y - x) / near.numbers.units[n] for n, x, y in triples)
    # The dependent conditions are not part of the proof: their residuals are only bounded.
    others = sorted(set(rows) - set(chosen))
    other_residues = near.residues(balls, others).values() if others else ()
    largest_rest = max(map(_upper, other_residues), default=Fraction(0))
    numbers = {n: midpoint_and_radius(y)[0] for n, _, y in triples}
    return Nearest(off, numbers, len(chosen), largest_rest) if largest_rest < HELD else None


def find_far_solution(near: Nearby, rows: Sequence[int]) -> Nearest | None:
    """Return a solution that may be far from the printed numbers, by Newton's method; None where it
    finds none, or one of many. It is for few numbers only."""
    if len(near.names) > _FEW or not rows:
        return None
    point, slope = list(near.start), near.slope
    for _ in range(_TURNS):
        value = near.residues(point, rows)
        chosen = near.choices(rows)[-1]
        inverse = near.inverse(chosen, slope)
        if inverse is None:
            return None
        change = (inverse * flint.arb_mat([[value[k].mid()] for k in chosen])).tolist()
        point = [(x - d).mid() for x, (d,) in zip(point, change, strict=True)]
        if all(abs(d) < _CLOSE for (d,) in change) or not all(abs(x) < _FAR for x in point):
            break
        slopes = near.slopes(point, near.residues(point, rows))
        slope = {k: [x.mid() for x in row] for k, row in slopes.items()}
    values = {n: midpoint_and_radius(x)[0] for n, x in zip(near.names, point, strict=True)}
    if not all(abs(x) < _FAR for x in point):
        return None
    moved_numbers = AnyNumbers(near.numbers.numbers, values, near.numbers.units)
    solution = nearest(Nearby(moved_numbers, near.conditions), rows)
    if solution is None or solution.shown < len(near.names):
        return None
    gaps = (abs(solution.numbers[n] - x) / near.numbers.units[n] for n, x in
            near.numbers.values.items())  # fmt: skip
    return Nearest(max(gaps), solution.numbers, solution.shown, solution.rest)


def _solution(near: Nearby, rows: Sequence[int], point: Sequence[Ball]) -> list[Ball] | None:
    """Return balls around `point` in which a solution lies; None where that is not shown."""
    value = near.residues(point, rows)
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
