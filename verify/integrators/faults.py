"""What may be wrong with a user's step before anything is proved or measured, by its name."""

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from verify.integrators.step import State, Step, StepError, last_line, line_of_error
from verify.prose import Number, Prose, joined, prose
from verify.verdict import Verdict


@dataclass(frozen=True)
class Fault:
    """`name`: such as "frozen"; `text`: the sentence. `allows`: the best verdict that it lets
    stand. REFUTED: it is no step of a scheme. PROVED: it is only told. `fails`: a call returned no
    state, as it may where H is not defined.
    """

    name: str
    text: str
    allows: Verdict = Verdict.REFUTED
    fails: bool = False

    @property
    def fatal(self) -> bool:
        return self.allows is Verdict.REFUTED


_STEPS = 0.125, 0.0625  # with which it is tried


def examined(
    step: Step, points: Sequence[tuple[Fraction, Fraction]]
) -> tuple[list[Fault], dict[State, State]]:
    """What is wrong with it at these points, and what it returned there.

    Finds out whether it wants arrays, and sets `step.arrays`.
    """
    states = [(float(p), float(q)) for p, q in points]
    first: dict[State, State] = {}
    failures: dict[State, Exception] = {}
    for index, state in enumerate(states):
        try:
            first[state] = _first(step, *state, _STEPS[0], not first and index == 0)
        except Exception as error:  # the user's code may raise anything
            failures[state] = error
            if step.left <= 0:
                break
    if not first:
        return [_failure(states[0], failures[states[0]])], first
    return [*_as_a_map(step, first), *_with_arrays(step, first)], first


def changed_since(step: Step, first: Mapping[State, State]) -> list[Fault]:
    """Whether it returns something else than it did, after many calls."""
    for state, before in first.items():
        try:
            after = step.at(*state, _STEPS[0])
        except Exception:  # noqa: S112 - a cache may hold numbers of ours
            continue
        if after != before:
            return [not_a_function(state, _STEPS[0], before, after)]
    return []


def not_a_function(state: State, h: float, before: State, after: State) -> Fault:
    """It returned one and then the other."""
    pair = prose(_shown(before), " and then ", _shown(after))
    found = prose(pair, line_of_error(*state, h))
    return Fault("not a function", prose("it is not deterministic: it returns ", found))


def _shown(state: State) -> Prose:
    return prose("(", joined(", ", (Number(repr(x)) for x in state)), ")")


def _first(step: Step, p: float, q: float, h: float, try_arrays: bool) -> State:
    try:
        return step.at(p, q, h)
    except (TypeError, IndexError, AttributeError):
        if not try_arrays or "numpy" not in sys.modules or step.foreign:
            raise
        step.arrays = True
        try:
            return step.at(p, q, h)
        except Exception:
            step.arrays = False
        raise


def _failure(state: State, error: Exception) -> Fault:
    place = line_of_error(*state, _STEPS[0])
    if isinstance(error, StepError):
        return Fault("not a step", error.said, fails=True)
    return Fault("raises", prose(f"it raises {last_line(error)}", place), fails=True)


def _as_a_map(step: Step, first: Mapping[State, State]) -> list[Fault]:
    """Whether it is one map of (p, q, h), the same at every call, and one that moves."""
    second: dict[State, State] = {}
    for state, before in first.items():
        try:
            second[state] = step.at(*state, _STEPS[1])
            after = step.at(*state, _STEPS[0])
        except Exception as error:  # the user's code may raise anything
            said = error.said if isinstance(error, StepError) else f"it raises {last_line(error)}"
            allows = Verdict.REFUTED if step.left <= 0 else Verdict.PROVED
            return [Fault("fails", prose(said, ", at a later call"), allows, fails=True)]
        if after != before:
            return [not_a_function(state, _STEPS[0], before, after)]
    if all(state == after for state, after in first.items()):
        text = "it is frozen: p' = p and q' = q, which preserves area and is no scheme"
        return [Fault("frozen", text)]
    if all(second[state] == after for state, after in first.items()):
        return [Fault("ignores h", "it ignores h: its step is the same for h = 1/8 and 1/16")]
    return []


def _with_arrays(step: Step, first: Mapping[State, State]) -> list[Fault]:
    """Whether it changes arrays that it is given. Without numpy in use there are none."""
    if "numpy" not in sys.modules or step.foreign:
        return []
    import numpy as np

    p, q = (np.array([state[i] for state in first]) for i in (0, 1))
    kept = p.copy(), q.copy()
    try:
        with step.limited():
            step.raw(step.function, p, q, _STEPS[0])
    except Exception:  # it is for single numbers
        return []
    if np.array_equal(p, kept[0]) and np.array_equal(q, kept[1]):
        return []
    return [Fault("mutates", "it changes the arrays p or q that it is given", Verdict.PROVED)]
