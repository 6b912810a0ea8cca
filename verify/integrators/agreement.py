"""Whether our numbers make of a user's step what his floats make of it."""

import math
import random
from collections.abc import Callable, Sequence
from fractions import Fraction

from verify.integrators.probe import Trial
from verify.integrators.rounding_noise import rounding_noise
from verify.integrators.step import State, Step
from verify.integrators.step_probes import Point, dual_step
from verify.integrators.tracing.dual import Dual, Duals
from verify.integrators.tracing.functions import copied
from verify.integrators.tracing.number import UntraceableError
from verify.integrators.tracing.trace import Node, in_order, replayed, through
from verify.prose import read_prose

Lifted = Callable[[Dual, Dual, Dual, Dual], Sequence[Dual]]  # (p, q, h, t) ↦ p', q'
_SIZES = Fraction(1, 8), Fraction(1, 64)
_AGREES = 1e-12
_ROUNDED, _BEYOND = 2.0**-46, 8  # what is allowed at least, and times the bound to first order
_SCATTERED, _WIDE, _UNIT = 20, 256, 1024  # further points around each, up to 1/4 away
_ENDS_ELSEWHERE = 1e-6  # where values are compared, as a loop's tolerance may with duals


def by_graph(kind: Duals, p_next: Node, q_next: Node) -> Lifted:
    nodes = in_order(p_next, q_next)

    def at(p: Dual, q: Dual, h: Dual, t: Dual) -> tuple[Dual, Dual]:
        made = through(nodes, replayed(kind, {"p": p, "q": q, "h": h, "t": t}))
        return made[p_next.number], made[q_next.number]

    return at


def by_duals(step: Step) -> Callable[[Duals], Lifted]:
    def made(kind: Duals) -> Lifted:
        function = copied(step.function, kind)
        return lambda p, q, h, t: dual_step(step, function, p, q, h, t)

    return made


def must_agree(trial: Trial, made: Callable[[Duals], Lifted]) -> None:
    """UntraceableError where our numbers and the user's floats part at a point of the trial.

    So it is where the code keeps a state, or takes another branch with floats.
    """

    def allowed(kind: Duals, mine: State, *_: object) -> Sequence[float]:
        near = _ENDS_ELSEWHERE if kind.compared else _AGREES
        return [near * (1 + max(map(abs, mine)))] * 2

    _hold_together(trial.step, made, trial.points, allowed)


def must_agree_but_for_rounding(trial: Trial, p_next: Node, q_next: Node) -> None:
    """As `must_agree`, for a trace, at many points, and as near as rounding lets it be."""
    nodes, draw = in_order(p_next, q_next), random.Random(1)  # noqa: S311 - any points do
    scattered = [
        (p + Fraction(x, _UNIT), q + Fraction(y, _UNIT))
        for p, q in trial.points
        for x, y in zip(
            *(draw.choices(range(-_WIDE, _WIDE), k=_SCATTERED) for _ in "pq"), strict=True
        )
    ]

    def allowed(_: Duals, mine: State, *at: float) -> Sequence[float]:
        try:
            noise = rounding_noise(nodes, *at)
        except (ArithmeticError, ValueError):  # beyond what floats can do
            return math.inf, math.inf
        least = _ROUNDED * (1 + max(map(abs, mine)))
        return [least + _BEYOND * noise[x.number] for x in (p_next, q_next)]

    points = [*trial.points, *scattered]
    _hold_together(trial.step, lambda kind: by_graph(kind, p_next, q_next), points, allowed)


def _hold_together(
    step: Step,
    made: Callable[[Duals], Lifted],
    points: Sequence[Point],
    allowed: Callable[..., Sequence[float]],
) -> None:
    kind, compared = Duals(), 0
    with kind.running():
        at = made(kind)
        for point in points:
            for h in _SIZES:
                floats = float(point[0]), float(point[1]), float(h)
                try:
                    mine = step.at(*floats)
                except Exception:  # noqa: S112 - it fails there; other points may do
                    continue
                clock = step.clock(*floats[:2])
                p, q, *rest = (Fraction(x) for x in (*floats, clock))
                theirs = [x.value for x in at(*kind.state(p, q), *map(kind.rational, rest))]
                compared += 1
                gaps = zip(mine, theirs, allowed(kind, mine, *floats, clock), strict=True)
                if any(abs(x - y) > most for x, y, most in gaps):
                    where = f"p = `{point[0]}`, q = `{point[1]}`, h = `{h}`"
                    raise UntraceableError(
                        read_prose(f"with floats it does something else, at {where}")
                    )
    if not compared:
        raise UntraceableError("it fails at every point that is tried")
