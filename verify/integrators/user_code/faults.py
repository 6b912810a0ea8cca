"""Faults that a user's map may have before anything is proved or measured, by their names.

The map must return the same at every call, after many other calls, and in a second process that
calls it in the reverse order. That process is a fork, so that it begins with all that the code
keeps in this one. It prints nothing, runs no exit handlers when it ends, and the processes that it
has started end with it.
"""

import contextlib
import numbers
import os
import selectors
import signal
import sys
import time
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from os import _exit as leave  # the user's code may be kept from it by another one
from typing import Any, NoReturn, TypeVar

from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.user_code.step import StepError, last_line, limit_call, unless_it_fails
from verify.integrators.user_code.user_map import State, UserMap
from verify.prose import Number, Prose, join_prose, prose
from verify.verdict import Verdict

S = TypeVar("S")
_STEP_DIVISORS = 8, 16  # a place's largest step size is divided by each; the step is compared
_MOST_PLACES = 6
_MAX_SECONDS_OF_PROCESS = 2.0  # all calls in the second process together


@dataclass(frozen=True)
class Fault:
    """A fault of a step or a map.

    `name`: a keyword, such as "frozen"; `text`: the sentence for people. `allows`: the strongest
    verdict that it still permits: REFUTED if it is no step of a scheme, PROVED if the fault is only
    reported. `ends`: True if nothing more can be examined.
    """

    name: str
    text: str
    allows: Verdict = Verdict.REFUTED
    ends: bool = False

    @property
    def fatal(self) -> bool:
        """True if the examination ends with this fault."""
        return self.allows is Verdict.REFUTED or self.ends


Calls = dict[TrialPlace, State]  # the state that the step returned at each place


def find_faults(step: UserMap, places: Sequence[TrialPlace]) -> tuple[list[Fault], Calls]:
    """Return the faults at the first of the places, and the results there."""
    first = Calls()
    for place in places[:_MOST_PLACES]:
        # A step that fails at one place may work at others.
        state = unless_it_fails(partial(call_at, step, place))
        if state is not None:
            first[place] = state
        if step.seconds_left <= 0:
            break
    faults = _check_repeated_calls(step, first) or _check_second_process(step, first)
    return [*faults, *_check_arrays(step, first)], first


def _check_second_process(step: UserMap, first: Mapping[TrialPlace, State]) -> list[Fault]:
    """Check that the step answers the same in a second process, in the reverse order."""
    start_another = getattr(step.function, "another", None)
    if start_another is not None:
        answers = _answers_of(replace(step, function=start_another()), list(first))
    elif step.foreign:
        return []  # a library in this process, which must not be forked
    else:
        seconds = min(_MAX_SECONDS_OF_PROCESS, step.seconds_left / 10)
        answers = outcomes_elsewhere(lambda place: call_at(step, place), list(first), seconds)
    for (place, state), answer in zip(first.items(), answers, strict=True):
        # None means that the other process ended before it answered, which is no difference.
        if answer is not None and answer != outcome(lambda x: x, state):
            circumstances = "in a second process, in another order of calls"
            text = f"{circumstances}, it returns another result at {step.describe_state(place.z)}"
            return [Fault("not a function", text, Verdict.UNDECIDED, ends=True)]
    return []


def _answers_of(step: UserMap, places: Sequence[TrialPlace]) -> list[str | None]:
    """Return the answers of a fresh process of its program, from the last place to the first."""
    answers = [outcome(lambda place: call_at(step, place), place) for place in reversed(places)]
    step.function.close()  # type: ignore[attr-defined]
    return [*reversed(answers)]


def call_at(step: UserMap, place: TrialPlace, divisor: int = _STEP_DIVISORS[0]) -> State:
    """Return the state after a part of the place's largest step, as floats."""
    return step.at_place(place, place.step / divisor)


def find_changes(step: UserMap, first: Mapping[TrialPlace, State]) -> list[Fault]:
    """Check that the step still returns the first results, after many calls."""
    for place, before in first.items():
        # The call may fail: the code may have cached objects of our number classes.
        after = unless_it_fails(partial(call_at, step, place))
        if after is not None and after != before:
            return [not_a_function(step, place.z, before, after)]
    return []


def not_a_function(
    step: UserMap, z: Sequence[float | Fraction], before: State, after: State
) -> Fault:
    """Build the fault of a step that returned `before`, and later `after`, at the same state.

    It refutes no claim, since no claim can be checked on it.
    """
    pair = prose(_format_state(before), " and then ", _format_state(after))
    text = prose("it is not deterministic: it returns ", pair, f" at {step.describe_state(z)}")
    return Fault("not a function", text, Verdict.UNDECIDED, ends=True)


def _format_state(state: State) -> Prose:
    return prose("(", join_prose(", ", (Number(repr(x)) for x in state)), ")")


def _check_repeated_calls(step: UserMap, first: Mapping[TrialPlace, State]) -> list[Fault]:
    """Check that the step is a function of z and h, that it moves z, and that h has an effect."""
    second = Calls()
    for place, before in first.items():
        try:
            if step.takes_step_size:
                second[place] = call_at(step, place, _STEP_DIVISORS[1])
            after = call_at(step, place)
        except Exception as error:  # the user's code may raise anything
            message = prose("it raises ", last_line(error))
            cause = error.clause if isinstance(error, StepError) else message
            text, is_late = prose(cause, ", at a later call"), step.seconds_left <= 0
            return [Fault("fails", text, Verdict.PROVED, ends=is_late)]
        if after != before:
            return [not_a_function(step, place.z, before, after)]
    # A map without h may be the identity: only a step is called frozen.
    if not step.takes_step_size or not first:
        return []
    if all(tuple(map(float, place.z)) == after for place, after in first.items()):
        frozen = "it is frozen: p' = p and q' = q, which preserves area and is no scheme"
        return [Fault("frozen", frozen)]
    if all(second[place] == after for place, after in first.items()):
        return [Fault("ignores h", "it ignores h: its step is the same for h and h/2")]
    return []


def _check_arrays(step: UserMap, first: Mapping[TrialPlace, State]) -> list[Fault]:
    """Check that the step changes no array that it takes.

    Nothing is checked if numpy is not imported, since the user's code then has no arrays.
    """
    if "numpy" not in sys.modules or step.foreign or not first or "z" in step.layout.roles:
        return []
    import numpy as np

    place = next(iter(first))
    n = step.degrees
    if step.layout.shape:
        p, q = (np.array([float(x) for x in part]).reshape(step.layout.shape)
                for part in (place.z[:n], place.z[n:]))  # fmt: skip
    else:
        p, q = (np.array([float(x.z[i]) for x in first]) for i in (0, 1))
    # The originals are compared afterwards: a step that works in place would change a caller's
    # arrays.
    originals = p.copy(), q.copy()
    h = float(place.step / _STEP_DIVISORS[0])
    parts = {"p": p, "q": q, "h": h, "t": float(place.t)}
    parameters = {name: float(x) for name, x in step.parameters.items()}
    try:
        with limit_call(step):
            step.function(*(parts[name] for name in step.layout.roles), **parameters)
    except Exception:  # the step takes single numbers alone
        return []
    if np.array_equal(p, originals[0]) and np.array_equal(q, originals[1]):
        return []
    return [Fault("mutates", "it changes the arrays p or q that it is given", Verdict.PROVED)]


# -- in a second process --------------------------------------------------------------------------


def outcomes_elsewhere(
    call: Callable[[S], object], states: Sequence[S], seconds: float
) -> list[str | None]:
    """Return `outcome` at each state, in the order of `states`; None if none came in that time.

    The second process takes the states from the last to the first.
    """
    if not hasattr(os, "fork"):
        return [None] * len(states)
    reader, writer = os.pipe()
    # Python warns that this process has threads; the child has none.
    with warnings.catch_warnings(action="ignore"):
        child = os.fork()
    if child == 0:
        _answer(writer, call, states)
    try:
        with contextlib.suppress(OSError):  # the child may have done it itself, or have ended
            os.setpgid(child, child)
        os.close(writer)
        lines = _read(reader, len(states), seconds)
    finally:
        os.close(reader)
        for kill in (os.killpg, os.kill):
            with contextlib.suppress(OSError):
                kill(child, signal.SIGKILL)
        with contextlib.suppress(OSError):
            os.waitpid(child, 0)
    return [*[None] * (len(states) - len(lines)), *reversed(lines)]


def outcome(call: Callable[[S], object], state: S) -> str:
    """Format the result of the call at that state, all digits of its numbers, or the type of its
    error."""
    try:
        return _text(call(state))
    except BaseException as error:
        return type(error).__name__


def _text(x: Any) -> str:
    x = x.tolist() if hasattr(x, "tolist") else x
    if isinstance(x, list | tuple):
        return f"({', '.join(map(_text, x))})"
    if isinstance(x, float):
        return x.hex()
    # For any other object the text is its type: its address differs from process to process.
    return repr(x) if isinstance(x, numbers.Number | str | None) else type(x).__name__


def _answer(writer: int, call: Callable[[S], object], states: Sequence[S]) -> NoReturn:
    """Write the outcomes into the pipe, in the child, and end it."""
    try:
        os.setpgid(0, 0)
        null = os.open(os.devnull, os.O_RDWR)
        for stream in range(3):
            os.dup2(null, stream)
        sys.stdin = sys.stdout = sys.stderr = open(null, "r+", closefd=False)  # noqa: SIM115
        with open(writer, "w") as pipe:
            for state in reversed(states):
                print(outcome(call, state), file=pipe, flush=True)
    finally:
        leave(0)


def _read(reader: int, count: int, seconds: float) -> list[str]:
    """Read that number of lines, or fewer if no more come in time."""
    received_bytes, until = b"", time.monotonic() + seconds
    with selectors.DefaultSelector() as waiting:
        waiting.register(reader, selectors.EVENT_READ)
        while received_bytes.count(b"\n") < count and waiting.select(
            max(until - time.monotonic(), 0)
        ):
            part = os.read(reader, 1 << 16)
            if not part:  # the child has ended
                break
            received_bytes += part
    return received_bytes.decode().split("\n")[:-1]
