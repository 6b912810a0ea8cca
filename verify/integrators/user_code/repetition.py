"""Many hundred calls of a user's map: it must be one map of z, and one that is smooth in floats.

From each place p or q moves away by a little, then by twice as much, and so on. A smooth map bends
as the square of such a move. Where its numbers have few digits, or a value that was kept for a
point nearby is taken, it jumps. Then all is called again, in other orders.

The module also reads what of a user's function outlives its calls, and if they change it: globals
that it names, the cells and defaults of it and of the functions that it reaches, the attributes of
functions, objects and classes of the user's: all as bytes, by the name through which the function
reaches them. Of a library's module it is the numbers and texts in it that count, and its classes
are constant.
"""

import contextlib
import io
import pickle
import random
import sys
import types
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from operator import itemgetter
from typing import Any

from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.tracing.function_copy import names_in
from verify.integrators.tracing.purity import is_of_user, is_plain, is_users_module
from verify.integrators.user_code.faults import Fault, not_a_function
from verify.integrators.user_code.step import last_line
from verify.integrators.user_code.user_map import State, UserMap
from verify.prose import Prose, join_prose, prose, read_prose
from verify.verdict import Verdict

KeptState = Mapping[str, bytes]  # by name


def read_kept_state(function: Callable[..., Any]) -> KeptState:
    """Return what the function keeps between calls, now."""
    with warnings.catch_warnings(action="ignore"):  # of what is not to be pickled any more
        state = {
            name: _bytes(value) for name, value in _reachable_values(_unwrap_function(function))
        }
    return {**state, **_generators()}


def _generators() -> KeptState:
    """Return the states of random generators, which modules hide."""
    # A step that draws random numbers changes these states, though it names none of them.
    states = {"random": _bytes(random.getstate())}
    if "numpy.random" in sys.modules:
        states["numpy.random"] = _bytes(sys.modules["numpy.random"].get_state())
    return states


def changed_names(before: KeptState, after: KeptState) -> list[str]:
    """Return the names under which something else is kept now."""
    return [name for name in {**before, **after} if before.get(name) != after.get(name)]


def _unwrap_function(x: Any) -> Any:
    """Return the function that numba and caches wrap; for a method of an object, the object
    itself."""
    inner = getattr(x, "py_func", None) or getattr(x, "__wrapped__", None)
    return inner if isinstance(inner, types.FunctionType) else x


def _reachable_values(x: Any) -> Iterator[tuple[str, Any]]:
    if not isinstance(x, types.FunctionType):
        yield getattr(x, "__name__", type(x).__name__), x
        return
    code = x.__code__
    for name in sorted(set(names_in(code)) & {*x.__globals__, *sys.modules}):  # it may import it
        yield name, x.__globals__.get(name, sys.modules.get(name))
    for name, cell in zip(code.co_freevars, x.__closure__ or (), strict=True):
        with contextlib.suppress(ValueError):  # a name that has no value yet
            yield name, cell.cell_contents
    if x.__defaults__ or x.__kwdefaults__:
        yield "its defaults", (x.__defaults__, x.__kwdefaults__)
    attributes = {name: value for name, value in vars(x).items() if name != "__wrapped__"}
    if attributes:
        yield "its attributes", attributes


def _bytes(value: Any) -> bytes:
    file = io.BytesIO()
    try:
        _Pickler(file, protocol=4).dump(value)
    except Exception:  # the user's objects may raise anything
        return b""
    return file.getvalue()


class _Blank:
    """A stand-in for an object that is written by its contents."""


class _Pickler(pickle.Pickler):
    """Writes functions and classes of the user's by what they hold, where pickle writes names.

    Nothing is ever read back. What cannot be written is written as its type's name.
    """

    def reducer_override(self, x: Any) -> Any:
        function = _unwrap_function(x)
        if isinstance(function, types.FunctionType):
            return _Blank, (), dict(_reachable_values(function)) if is_of_user(function) else None
        if isinstance(x, type):
            return (_Blank, (), _attributes(x)) if is_of_user(x) else NotImplemented
        if isinstance(x, types.ModuleType):
            return _Blank, (), _attributes(x) if is_users_module(x) else _plain_in(x)
        if isinstance(x, types.BuiltinFunctionType):
            return _Blank, (), getattr(x, "__self__", None)  # a method of what may change
        if isinstance(x, property | staticmethod | classmethod):
            parts = ("fget", "fset", "__func__")
            return _Blank, (), {name: getattr(x, name, None) for name in parts}
        try:
            return x.__reduce_ex__(4)
        except Exception:  # a lock, a file, a generator, what a thread keeps
            return str, (repr(x),), {"turns": _turns(x), "holds": getattr(x, "__dict__", None)}


def _turns(x: Any) -> Any:
    """Return where a generator stands."""
    frame = getattr(x, "gi_frame", None)
    return frame and (frame.f_lasti, dict(frame.f_locals))


def _plain_in(x: types.ModuleType) -> dict[str, Any]:
    return {k: v for k, v in vars(x).items() if not k.startswith("_") and is_plain(v)}


def _attributes(x: Any) -> dict[str, Any]:
    return {
        name: value
        for name, value in vars(x).items()
        if not name.startswith("__") or isinstance(value, types.FunctionType)
    }


_MOVES = [2.0**-k for k in range(44, 3, -1)]  # in units of what is small at a place
_WIDE = 2.0**-8  # from here on a move tells how the map bends
_BENDS = 16  # times as much as that, it may nearer by
_COARSE = 2.0**-40  # a jump beyond what rounding leaves of floats, and sums of many of them
_ROUNDS = 4  # in which all is called again
_PLACES = 5
_PART, _MOST_SECONDS = 0.05, 2.0  # of the time that is left
Outcome = State | Exception
_Jump = tuple[float, float]  # how far a component of z' is from where it should be; after what move


@dataclass(frozen=True)
class _Ladder:
    """States further and further from that of a place, p or q moved."""

    place: TrialPlace
    moves_p: bool
    states: tuple[tuple[float, ...], ...]


def _ladders(places: Sequence[TrialPlace]) -> list[_Ladder]:
    ladders = []
    for place in places[:_PLACES]:
        z, half = [float(x) for x in place.z], len(place.z) // 2
        for moves_p in (True, False):
            reach = [float(u) if (k < half) is moves_p else 0.0 for k, u in enumerate(place.reach)]
            states = [
                z,
                *([x + move * r for x, r in zip(z, reach, strict=True)] for move in _MOVES),
            ]
            ladders.append(_Ladder(place, moves_p, tuple(map(tuple, states))))
    return ladders


def find_repetition_faults(step: UserMap, places: Sequence[TrialPlace]) -> list[Fault]:
    """Return the faults that show when it is called often, as time allows: that it keeps a state,
    or is coarse."""
    # These calls may take a small part of the time: proofs and measurements need the rest.
    until = step.left - min(_PART * step.left, _MOST_SECONDS)
    ladders = _ladders(places)
    before, changed_keys = {} if step.foreign else read_kept_state(step.function), set[str]()

    def watch() -> None:
        if not step.foreign:  # of another process it shows in what it returns alone
            changed_keys.update(changed_names(before, read_kept_state(step.function)))

    outcomes: dict[tuple[TrialPlace, State], Outcome] = {}
    for ladder in ladders:
        for state in ladder.states:
            key = ladder.place, state
            if step.left > until and key not in outcomes:
                outcomes[key] = _outcome(step, *key)
            if len(outcomes) == 1:  # what comes and goes is seen after an odd number of calls
                watch()
        watch()
    faults = _repeat_calls(step, outcomes, until)
    if any(fault.fatal for fault in faults):
        return faults
    watch()
    return [
        *(faults or _check_coarseness(step, ladders, outcomes)),
        *_state_faults(sorted(changed_keys)),
    ]


def _outcome(step: UserMap, place: TrialPlace, state: State) -> Outcome:
    try:
        return step.evaluate(state, float(place.step / 8), float(place.t))
    except Exception as error:  # the user's code may raise anything
        return error


def _repeat_calls(
    step: UserMap, outcomes: dict[tuple[TrialPlace, State], Outcome], until: float
) -> list[Fault]:
    """Check that the same arguments give the same result, bit by bit, in other orders of calls."""
    # The reverse order first: a step that depends on the call before it shows there at once.
    order = list(outcomes)[::-1]
    for turn in range(_ROUNDS):
        for place, state in order:
            if step.left <= until:
                return []
            fault = _compare_outcomes(
                step, state, outcomes[place, state], _outcome(step, place, state)
            )
            if fault is not None and step.left > 0:
                return [fault]
        random.Random(turn).shuffle(order)  # noqa: S311 - any orders do
    return []


def _compare_outcomes(step: UserMap, state: State, before: Outcome, after: Outcome) -> Fault | None:
    errors = [x for x in (before, after) if isinstance(x, Exception)]
    if len(errors) == 1:
        text = prose(
            "it raises ", last_line(errors[0]), " at one call and not at another, the same"
        )
        return Fault("fails", text, Verdict.UNDECIDED)
    if isinstance(before, tuple) and isinstance(after, tuple) and before != after:
        return not_a_function(step, state, before, after)
    return None


def _state_faults(names: Sequence[str]) -> list[Fault]:
    if not names:
        return []
    names_text: Prose = join_prose(", ", map(prose, names[:3]))
    text = prose(
        "it keeps a state from call to call, so that no trace of it is a proof: ", names_text
    )
    return [Fault("keeps a state", text, Verdict.MEASURED)]


def _check_coarseness(
    step: UserMap, ladders: Sequence[_Ladder], outcomes: dict[tuple[TrialPlace, State], Outcome]
) -> list[Fault]:
    """Check if it jumps at most places: at a few it may, where a loop does one turn more."""
    jumps: list[_Jump] = []
    for moves_p in (True, False):
        jumps_of_ladders = [_largest_jump(x, outcomes) for x in ladders if x.moves_p is moves_p]
        decided = [jump for jump in jumps_of_ladders if jump is not None]
        positive = [(size, move) for size, move in decided if size > 0]
        jumps += positive if 2 * len(positive) > len(decided) else []
    if not jumps:
        return []
    step.coarseness, move = max(jumps, key=itemgetter(0))
    text = (
        f"its numbers are coarse: p' or q' jumps by `{step.coarseness:.1e}` as p or q moves by "
        f"`{move:.1e}`, as where they are of single precision, are rounded, or are kept "
        "from calls nearby; no order holds below that"
    )
    return [Fault("coarse", read_prose(text), Verdict.UNDECIDED)]


def _largest_jump(
    ladder: _Ladder, all_outcomes: dict[tuple[TrialPlace, State], Outcome]
) -> _Jump | None:
    """Return the largest jump along a ladder, of size 0 where there is none. None where a call
    failed."""
    outcomes = [all_outcomes.get((ladder.place, state)) for state in ladder.states]
    states = [x for x in outcomes if isinstance(x, tuple)]
    if len(states) < len(outcomes):
        return None
    units = [float(u) for u in ladder.place.units]
    sizes = [
        max(u, *(abs(state[k]) for state in (*states, *ladder.states))) for k, u in enumerate(units)
    ]
    first, *rest = [[x / s for x, s in zip(state, sizes, strict=True)] for state in states]
    # One that is off its line: twice the way makes twice the change.
    bent = [
        (move, max(abs((b - a) - (a - x)) for x, a, b in zip(first, one, two, strict=True)))
        for move, one, two in zip(_MOVES, rest, rest[1:], strict=False)
    ]
    # Wide moves show how the map bends; nearer by the bend of a smooth map falls as the square of
    # the move.
    curvature = max(size / move**2 for move, size in bent if move >= _WIDE)
    jumps = [
        (size, move) for move, size in bent if size > 2 * _COARSE + _BENDS * curvature * move**2
    ]
    return max(jumps, key=itemgetter(0), default=(0.0, 0.0))
