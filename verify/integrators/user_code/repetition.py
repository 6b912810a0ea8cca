"""Many hundred calls of a user's map, which must be a function of z, and smooth in floats.

At each place p or q is moved by a tiny amount, then by twice as much, and so on. The result of a
smooth map bends as the square of the move. It jumps if its numbers have few digits, or if the code
takes a value that it has kept for a nearby point. Then all calls are repeated in other orders.

The module also detects state that calls change: globals that the function names, closure cells and
defaults of the functions that it reaches, attributes of the user's functions, objects and classes.
Each is read as bytes, under the name through which the function reaches it. Of a library's module
only the numbers and texts are read, and its classes are taken as constant.
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
    """Return the values that the function keeps between calls, as they are now."""
    with warnings.catch_warnings(action="ignore"):  # some types warn when they are pickled
        state = {
            name: _to_bytes(value) for name, value in _reachable_values(_unwrap_function(function))
        }
    return {**state, **_random_states()}


def _random_states() -> KeptState:
    """Return the states of random generators, which modules hide."""
    # A step that draws random numbers changes these states, though it names none of them.
    states = {"random": _to_bytes(random.getstate())}
    if "numpy.random" in sys.modules:
        states["numpy.random"] = _to_bytes(sys.modules["numpy.random"].get_state())
    return states


def changed_names(before: KeptState, after: KeptState) -> list[str]:
    """Return the names whose values have changed, appeared or disappeared."""
    return [name for name in {**before, **after} if before.get(name) != after.get(name)]


def _unwrap_function(x: Any) -> Any:
    """Return the function that numba or a cache wraps; any other x as it is."""
    inner = getattr(x, "py_func", None) or getattr(x, "__wrapped__", None)
    return inner if isinstance(inner, types.FunctionType) else x


def _reachable_values(x: Any) -> Iterator[tuple[str, Any]]:
    if not isinstance(x, types.FunctionType):
        yield getattr(x, "__name__", type(x).__name__), x
        return
    code = x.__code__
    # A name in the code that is no global may be a module that the function imports.
    for name in sorted(set(names_in(code)) & {*x.__globals__, *sys.modules}):
        yield name, x.__globals__.get(name, sys.modules.get(name))
    for name, cell in zip(code.co_freevars, x.__closure__ or (), strict=True):
        with contextlib.suppress(ValueError):  # a name that has no value yet
            yield name, cell.cell_contents
    if x.__defaults__ or x.__kwdefaults__:
        yield "its defaults", (x.__defaults__, x.__kwdefaults__)
    attributes = {name: value for name, value in vars(x).items() if name != "__wrapped__"}
    if attributes:
        yield "its attributes", attributes


def _to_bytes(value: Any) -> bytes:
    file = io.BytesIO()
    try:
        _Pickler(file, protocol=4).dump(value)
    except Exception:  # the user's objects may raise anything
        return b""
    return file.getvalue()


class _Blank:
    """A stand-in for the class of an object that is pickled by its contents."""


class _Pickler(pickle.Pickler):
    """Pickles the user's functions and classes by their contents; pickle itself writes names.

    Nothing is ever read back. An object that cannot be pickled is written as its repr.
    """

    def reducer_override(self, x: Any) -> Any:
        function = _unwrap_function(x)
        if isinstance(function, types.FunctionType):
            return _Blank, (), dict(_reachable_values(function)) if is_of_user(function) else None
        if isinstance(x, type):
            return (_Blank, (), _attributes(x)) if is_of_user(x) else NotImplemented
        if isinstance(x, types.ModuleType):
            return _Blank, (), _attributes(x) if is_users_module(x) else _plain_values(x)
        if isinstance(x, types.BuiltinFunctionType):
            return _Blank, (), getattr(x, "__self__", None)  # the object of a method may change
        if isinstance(x, property | staticmethod | classmethod):
            parts = ("fget", "fset", "__func__")
            return _Blank, (), {name: getattr(x, name, None) for name in parts}
        try:
            return x.__reduce_ex__(4)
        except Exception:  # a lock, a file, a generator, a thread's local data
            return (
                str,
                (repr(x),),
                {"turns": _generator_position(x), "holds": getattr(x, "__dict__", None)},
            )


def _generator_position(x: Any) -> Any:
    """Return the position and the local variables of a generator; None for other objects."""
    frame = getattr(x, "gi_frame", None)
    return frame and (frame.f_lasti, dict(frame.f_locals))


def _plain_values(x: types.ModuleType) -> dict[str, Any]:
    return {k: v for k, v in vars(x).items() if not k.startswith("_") and is_plain(v)}


def _attributes(x: Any) -> dict[str, Any]:
    return {
        name: value
        for name, value in vars(x).items()
        if not name.startswith("__") or isinstance(value, types.FunctionType)
    }


_MOVE_SIZES = [2.0**-k for k in range(44, 3, -1)]  # in units of the reach at a place
_MIN_BENDING_MOVE = 2.0**-8  # moves of this size and larger ones show the curvature of the map
_BEND_FACTOR = 16  # smaller moves may bend by this multiple of the curvature
_COARSE_JUMP = 2.0**-40  # relative; larger than the rounding of sums of many doubles
_REPETITIONS = 4  # of all calls, each in another order
_MAX_PLACES = 5
_SHARE_OF_TIME, _MAX_SECONDS = 0.05, 2.0  # of the time that is left, and at most
Outcome = State | Exception
_Jump = tuple[float, float]  # the distance of a component of z' from its line; the move before it


@dataclass(frozen=True)
class _Ladder:
    """States at growing distances from that of a place, in the direction of p or of q."""

    place: TrialPlace
    moves_p: bool
    states: tuple[tuple[float, ...], ...]


def _ladders(places: Sequence[TrialPlace]) -> list[_Ladder]:
    ladders = []
    for place in places[:_MAX_PLACES]:
        z, half = [float(x) for x in place.z], len(place.z) // 2
        for moves_p in (True, False):
            reach = [float(u) if (k < half) is moves_p else 0.0 for k, u in enumerate(place.reach)]
            states = [
                z,
                *([x + move * r for x, r in zip(z, reach, strict=True)] for move in _MOVE_SIZES),
            ]
            ladders.append(_Ladder(place, moves_p, tuple(map(tuple, states))))
    return ladders


def find_repetition_faults(step: UserMap, places: Sequence[TrialPlace]) -> list[Fault]:
    """Return the faults that many calls show: no function of z, a kept state, coarse numbers."""
    # These calls may take a small part of the time: proofs and measurements need the rest.
    until = step.seconds_left - min(_SHARE_OF_TIME * step.seconds_left, _MAX_SECONDS)
    ladders = _ladders(places)
    first_state, changed_keys = {} if step.foreign else read_kept_state(step.function), set[str]()

    def watch() -> None:
        if not step.foreign:  # the state of another process is not readable
            changed_keys.update(changed_names(first_state, read_kept_state(step.function)))

    outcomes: dict[tuple[TrialPlace, State], Outcome] = {}
    for ladder in ladders:
        for state in ladder.states:
            key = ladder.place, state
            if step.seconds_left > until and key not in outcomes:
                outcomes[key] = _call_at_state(step, *key)
            if len(outcomes) == 1:  # a state that alternates shows after an odd number of calls
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


def _call_at_state(step: UserMap, place: TrialPlace, state: State) -> Outcome:
    try:
        return step.evaluate(state, float(place.step / 8), float(place.t))
    except Exception as error:  # the user's code may raise anything
        return error


def _repeat_calls(
    step: UserMap, outcomes: dict[tuple[TrialPlace, State], Outcome], until: float
) -> list[Fault]:
    """Check that the same arguments give the same result, bit by bit, in other orders of calls."""
    # The reverse order first: it shows at once if a step depends on the call before it.
    order = list(outcomes)[::-1]
    for turn in range(_REPETITIONS):
        for place, state in order:
            if step.seconds_left <= until:
                return []
            outcome = _call_at_state(step, place, state)
            fault = _compare_outcomes(step, state, outcomes[place, state], outcome)
            if fault is not None and step.seconds_left > 0:
                return [fault]
        random.Random(turn).shuffle(order)  # noqa: S311 - any orders do
    return []


def _compare_outcomes(step: UserMap, state: State, before: Outcome, after: Outcome) -> Fault | None:
    errors = [x for x in (before, after) if isinstance(x, Exception)]
    if len(errors) == 1:
        problem = " at one call and not at another, the same"
        text = prose("it raises ", last_line(errors[0]), problem)
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
    """Check that the step jumps at half of the places at most, as it may if a loop ends early."""
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
    """Return the largest jump along a ladder, of size 0 if it has none; None if a call failed."""
    outcomes = [all_outcomes.get((ladder.place, state)) for state in ladder.states]
    states = [x for x in outcomes if isinstance(x, tuple)]
    if len(states) < len(outcomes):
        return None
    units = [float(u) for u in ladder.place.units]
    sizes = [
        max(u, *(abs(state[k]) for state in (*states, *ladder.states))) for k, u in enumerate(units)
    ]
    first, *rest = [[x / s for x, s in zip(state, sizes, strict=True)] for state in states]
    # On a line, twice the move makes twice the change; the rest is the bend.
    bent = [
        (move, max(abs((b - a) - (a - x)) for x, a, b in zip(first, one, two, strict=True)))
        for move, one, two in zip(_MOVE_SIZES, rest, rest[1:], strict=False)
    ]
    # The bend of a smooth map falls as the square of the move; wide moves show the curvature.
    curvature = max(size / move**2 for move, size in bent if move >= _MIN_BENDING_MOVE)
    jumps = [
        (size, move)
        for move, size in bent
        if size > 2 * _COARSE_JUMP + _BEND_FACTOR * curvature * move**2
    ]
    return max(jumps, key=itemgetter(0), default=(0.0, 0.0))
