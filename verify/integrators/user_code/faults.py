"""What may be wrong with a user's map before anything is proved or measured, by its name."""

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial

from verify.integrators.places.place import Place
from verify.integrators.user_code.second_process import outcome, outcomes_elsewhere
from verify.integrators.user_code.step import StepError, last_line, limited, unless_it_fails
from verify.integrators.user_code.user_map import State, UserMap
from verify.prose import Number, Prose, joined, prose
from verify.verdict import Verdict

_PARTS = 8, 16  # of a place's largest step, with which it is tried
_MOST = 6  # places
_SECONDS = 2.0  # for calls in a second process


@dataclass(frozen=True)
class Fault:
    """`name`: such as "frozen"; `text`: the sentence. `allows`: the best verdict that it lets
    stand. REFUTED: it is no step of a scheme. PROVED: it is only told. `ends`: nothing more can be
    asked of it.
    """

    name: str
    text: str
    allows: Verdict = Verdict.REFUTED
    ends: bool = False

    @property
    def fatal(self) -> bool:
        return self.allows is Verdict.REFUTED or self.ends


Calls = dict[Place, State]  # what it returned at places


def examined(step: UserMap, places: Sequence[Place]) -> tuple[list[Fault], Calls]:
    """What is wrong with it at the first of the places, and what it returned there."""
    first = Calls()
    for place in places[:_MOST]:
        state = unless_it_fails(partial(at, step, place))  # at others it may not fail
        if state is not None:
            first[place] = state
        if step.left <= 0:
            break
    faults = _as_a_map(step, first) or _elsewhere(step, first)
    return [*faults, *_with_arrays(step, first)], first


def _elsewhere(step: UserMap, first: Mapping[Place, State]) -> list[Fault]:
    """Whether it answers the same in a second process, in the reverse order."""
    another = getattr(step.function, "another", None)
    if another is not None:
        answers = _answers_of(replace(step, function=another()), list(first))
    elif step.foreign:
        return []  # a library that is driven from here: it may not be forked
    else:
        seconds = min(_SECONDS, step.left / 10)
        answers = outcomes_elsewhere(lambda place: at(step, place), list(first), seconds)
    for (place, state), answer in zip(first.items(), answers, strict=True):
        if answer is not None and answer != outcome(lambda known: known, state):
            called = "in a second process, in another order of calls"
            said = f"{called}, it returns another result at {step.state(place.z)}"
            return [Fault("not a function", said, Verdict.UNDECIDED, ends=True)]
    return []


def _answers_of(step: UserMap, places: Sequence[Place]) -> list[str | None]:
    """Those of a fresh process of its program, from the last place to the first."""
    answers = [outcome(lambda place: at(step, place), place) for place in reversed(places)]
    step.function.close()  # type: ignore[attr-defined]
    return [*reversed(answers)]


def at(step: UserMap, place: Place, part: int = _PARTS[0]) -> State:
    """The state after a small step, as floats."""
    return step.at_place(place, place.step / part)


def changed_since(step: UserMap, first: Mapping[Place, State]) -> list[Fault]:
    """Whether it returns something else than it did, after many calls."""
    for place, before in first.items():
        after = unless_it_fails(partial(at, step, place))  # a cache may hold numbers of ours
        if after is not None and after != before:
            return [not_a_function(step, place.z, before, after)]
    return []


def not_a_function(
    step: UserMap, z: Sequence[float | Fraction], before: State, after: State
) -> Fault:
    """It returned one and then the other: no claim is refuted, since none can be held to it."""
    pair = prose(_shown(before), " and then ", _shown(after))
    text = prose("it is not deterministic: it returns ", pair, f" at {step.state(z)}")
    return Fault("not a function", text, Verdict.UNDECIDED, ends=True)


def _shown(state: State) -> Prose:
    return prose("(", joined(", ", (Number(repr(x)) for x in state)), ")")


def _as_a_map(step: UserMap, first: Mapping[Place, State]) -> list[Fault]:
    """Whether it is one map of z and h, the same at every call, and one that moves."""
    second = Calls()
    for place, before in first.items():
        try:
            if step.stepped:
                second[place] = at(step, place, _PARTS[1])
            after = at(step, place)
        except Exception as error:  # the user's code may raise anything
            raised = prose("it raises ", last_line(error))
            cause = error.said if isinstance(error, StepError) else raised
            return [
                Fault(
                    "fails", prose(cause, ", at a later call"), Verdict.PROVED, ends=step.left <= 0
                )
            ]
        if after != before:
            return [not_a_function(step, place.z, before, after)]
    if not step.stepped or not first:
        return []
    if all(tuple(map(float, place.z)) == after for place, after in first.items()):
        frozen = "it is frozen: p' = p and q' = q, which preserves area and is no scheme"
        return [Fault("frozen", frozen)]
    if all(second[place] == after for place, after in first.items()):
        return [Fault("ignores h", "it ignores h: its step is the same for h and h/2")]
    return []


def _with_arrays(step: UserMap, first: Mapping[Place, State]) -> list[Fault]:
    """Whether it changes arrays that it is given. Without numpy in use there are none."""
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
    kept = p.copy(), q.copy()
    parts = {"p": p, "q": q, "h": float(place.step / 8), "t": float(place.t)}
    parameters = {name: float(x) for name, x in step.parameters.items()}
    try:
        with limited(step):
            step.function(*(parts[name] for name in step.layout.roles), **parameters)
    except Exception:  # it is for single numbers
        return []
    if np.array_equal(p, kept[0]) and np.array_equal(q, kept[1]):
        return []
    return [Fault("mutates", "it changes the arrays p or q that it is given", Verdict.PROVED)]
