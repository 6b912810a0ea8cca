"""A user's step called many hundred times: one map of (p, q, h), and one that is smooth in floats.

From each point p or q moves away by a little, then by twice as much, and so on. A smooth map bends
as the square of such a move. Where its numbers have few digits, or a value that was kept for a
point nearby is taken, it jumps. Then all is called again, in other orders.
"""

import random
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from verify.integrators.faults import Fault, not_a_function
from verify.integrators.kept_state import changed, kept_by
from verify.integrators.step import State, Step, last_line
from verify.prose import Prose, joined, prose, read_prose
from verify.verdict import Verdict

_SIZE = 0.125
_MOVES = [2.0**-k for k in range(44, 3, -1)]
_DIRECTIONS = (1, 0), (0, 1)
_WIDE = 2.0**-8  # from here on a move tells how the map bends
_BENDS = 16  # times as much as that, it may nearer by
_COARSE = 2.0**-40  # a jump beyond what rounding leaves of floats, and sums of many of them
_ROUNDS = 4  # in which all is called again
_PART, _MOST_SECONDS = 0.1, 3.0  # of the time that is left
Outcome = State | Exception


@dataclass(frozen=True)
class _Jump:
    """How far p' or q' is from where it should be, after a move of p or q."""

    size: float
    move: float


def repeated(step: Step, points: Sequence[tuple[Fraction, Fraction]]) -> list[Fault]:
    """What shows when it is called often, as time allows: that it keeps a state, or is coarse."""
    until = step.left - min(_PART * step.left, _MOST_SECONDS)
    ladders = [
        [(p, q), *((p + move * x, q + move * y) for move in _MOVES)]
        for p, q in (map(float, point) for point in points)
        for x, y in _DIRECTIONS
    ]
    before, others = {} if step.foreign else kept_by(step.function), set[str]()

    def watch() -> None:
        if not step.foreign:  # of another process it shows in what it returns alone
            others.update(changed(before, kept_by(step.function)))

    known: dict[State, Outcome] = {}
    for ladder in ladders:
        for state in ladder:
            if step.left > until and state not in known:
                known[state] = _outcome(step, state)
            if len(known) == 1:  # what comes and goes is seen after an odd number of calls
                watch()
        watch()
    faults = _again(step, known, until)
    if any(fault.fatal for fault in faults):
        return faults
    watch()
    return [*(faults or _coarse(ladders, known)), *_state_faults(sorted(others))]


def _outcome(step: Step, state: State) -> Outcome:
    try:
        return step.at(*state, _SIZE)
    except Exception as error:  # the user's code may raise anything
        return error


def _again(step: Step, known: dict[State, Outcome], until: float) -> list[Fault]:
    """Whether the same arguments give the same result, bit by bit, in other orders of calls."""
    order = list(known)[::-1]
    for turn in range(_ROUNDS):
        for state in order:
            if step.left <= until:
                return []
            fault = _parted(state, known[state], _outcome(step, state))
            if fault is not None and step.left > 0:
                return [fault]
        random.Random(turn).shuffle(order)  # noqa: S311 - any orders do
    return []


def _parted(state: State, before: Outcome, after: Outcome) -> Fault | None:
    raised = [x for x in (before, after) if isinstance(x, Exception)]
    if len(raised) == 1:
        said = prose(
            "it raises ", last_line(raised[0]), " at one call and not at another, the same"
        )
        return Fault("fails", said, Verdict.UNDECIDED, fails=True)
    if isinstance(before, tuple) and isinstance(after, tuple) and before != after:
        return not_a_function(state, _SIZE, before, after)
    return None


def _state_faults(names: Sequence[str]) -> list[Fault]:
    if not names:
        return []
    listed: Prose = joined(", ", map(prose, names[:3]))
    said = prose("it keeps a state from call to call, so that no trace of it is a proof: ", listed)
    return [Fault("keeps a state", said, Verdict.MEASURED)]


def _coarse(ladders: Sequence[Sequence[State]], known: dict[State, Outcome]) -> list[Fault]:
    """Whether it jumps at most points: at a few it may, where a loop does one turn more."""
    found = [_jump(ladder, known) for ladder in ladders]
    jumps: list[_Jump] = []
    for k in range(len(_DIRECTIONS)):
        told = [jump for jump in found[k :: len(_DIRECTIONS)] if jump is not None]
        seen = [jump for jump in told if jump.size > 0]
        jumps += seen if 2 * len(seen) > len(told) else []
    if not jumps:
        return []
    largest = max(jumps, key=lambda jump: jump.size)
    said = (
        f"its numbers are coarse: p' or q' jumps by `{largest.size:.1e}` as p or q moves by "
        f"`{largest.move:.1e}`, as where they are of single precision, are rounded, or are kept "
        "from calls nearby; no order holds below that"
    )
    return [Fault("coarse", read_prose(said), Verdict.UNDECIDED)]


def _jump(ladder: Sequence[State], known: dict[State, Outcome]) -> _Jump | None:
    """The largest jump along a ladder, of size 0 where there is none. None where a call failed."""
    found = [known.get(state) for state in ladder]
    states = [x for x in found if isinstance(x, tuple)]
    if len(states) < len(found):
        return None
    here, away = states[0], states[1:]
    # One that is off its line: twice the way makes twice the change.
    bent = [
        (move, max(abs((two[i] - one[i]) - (one[i] - here[i])) for i in (0, 1)))
        for move, one, two in zip(_MOVES, away, away[1:], strict=False)
    ]
    curvature = max(size / move**2 for move, size in bent if move >= _WIDE)
    least = _COARSE * (1 + max(abs(x) for state in (*states, *ladder) for x in state))
    jumps = [
        _Jump(size, move) for move, size in bent if size > least + _BENDS * curvature * move**2
    ]
    return max(jumps, key=lambda jump: jump.size, default=_Jump(0.0, 0.0))
