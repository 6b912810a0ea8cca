"""A user's own step function: found, called, and what is wrong with it named.

`verify check-integrator` and `verify.testing` run the user's code; nothing else in `verify` does.
What it prints goes to standard error, and a call that does not come back is ended where this thread
gets signals.
"""

import contextlib
import importlib
import importlib.util
import inspect
import signal
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from types import ModuleType
from typing import Any

from verify.carried_number import Carried
from verify.errors import InputError

State = tuple[float, float]
TIME_LIMIT = 60.0  # seconds for all of the user's code
_NAMES = {
    **dict.fromkeys(("p", "v", "p0", "momentum", "velocity", "mom", "vel"), "p"),
    **dict.fromkeys(("q", "x", "q0", "position", "displacement", "pos"), "q"),
    **dict.fromkeys(("h", "dt", "tau", "step", "step_size", "stepsize", "delta_t"), "h"),
}
_POSITIONAL = inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD


class StepError(Exception):
    """What the user's function did instead of a step: one clause, "it …", for people."""


class _OverTimeError(BaseException):  # so that `except Exception` in the user's code lets it pass
    pass


def last_line(error: BaseException) -> str:
    """The user's exception as Python's last line of a traceback has it."""
    lines = str(error).split("\n")
    return f"{type(error).__name__}: {lines[0]}" if lines[0] else type(error).__name__


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """What is printed goes to standard error: JSON stands alone on standard output."""
    with contextlib.redirect_stdout(sys.stderr):
        yield


# -- loading --------------------------------------------------------------------------------------


def load(target: str) -> Callable[..., Any]:
    """The function that MODULE:FUNCTION or path/to/file.py:function names. Runs the module.

    The current folder is searched first. Raises InputError where it does not import, has no such
    name, or that is no function.
    """
    place, _, name = target.rpartition(":")
    if not place or not name:
        raise InputError("integrator", target, "write it as MODULE:FUNCTION or file.py:FUNCTION")
    with _quiet():
        module = _module(place, target)
        found: Any = module
        for part in name.split("."):
            if not hasattr(found, part):
                known = sorted(n for n, x in vars(module).items() if inspect.isfunction(x))
                has = f"it has: {', '.join(known[:8])}" if known else "it has no function"
                raise InputError("integrator", target, f"{place} has no {name}; {has}")
            found = getattr(found, part)
    if not callable(found):
        raise InputError("integrator", target, f"{name} is no function but {type(found).__name__}")
    return found  # type: ignore[no-any-return]


def _module(place: str, target: str) -> ModuleType:
    path = Path(place)
    try:
        if path.suffix == ".py":
            if not path.is_file():
                raise InputError("integrator", target, f"there is no file {place}")
            sys.path.insert(0, str(path.parent.resolve()))
            spec = importlib.util.spec_from_file_location(path.stem, path)
            assert spec is not None  # noqa: S101 - a .py file has a loader
            assert spec.loader is not None  # noqa: S101
            module = importlib.util.module_from_spec(spec)
            sys.modules[path.stem] = module  # as pickles and dataclasses in it expect
            spec.loader.exec_module(module)
            return module
        sys.path.insert(0, str(Path.cwd()))
        return importlib.import_module(place)
    except (InputError, KeyboardInterrupt):
        raise
    except BaseException as error:  # SystemExit too: it is the user's code
        raise InputError("integrator", target, f"does not import: {last_line(error)}") from None


# -- calling --------------------------------------------------------------------------------------


@dataclass
class Step:
    """The user's step(p, q, h) → (p', q').

    `order`: its arguments by their names here, such as ("q", "p", "h"); what it returns stands in
    that order too. `given`: parameters of H that it takes by name. `arrays`: it wants p and q as
    arrays, and gets them with one entry each. `left`: seconds left for its calls.
    """

    function: Callable[..., Any]
    order: tuple[str, str, str] = ("p", "q", "h")
    given: Mapping[str, float] = field(default_factory=dict)
    arrays: bool = False
    left: float = TIME_LIMIT

    def raw(self, function: Callable[..., Any], p: Any, q: Any, h: Any) -> Any:
        """What the function, or a copy of it, returns."""
        by_name = {"p": p, "q": q, "h": h}
        return function(*(by_name[name] for name in self.order), **self.given)

    def at(self, p: float, q: float, h: float) -> State:
        """(p', q') as floats. Raises StepError, also for what is not finite."""
        with self.timed():
            if self.arrays:
                import numpy as np

                result = self.raw(self.function, np.array([p]), np.array([q]), h)
            else:
                result = self.raw(self.function, p, q, h)
        x, y = (_real(x) for x in self.pair(result))
        if x - x != 0 or y - y != 0:
            raise StepError(f"it returns {x:g}, {y:g}{_at(p, q, h)}")
        return x, y

    def pair(self, result: Any) -> tuple[Any, Any]:
        """p' and q' of what was returned, each a single number. Raises StepError."""
        parts = _parts(result)
        if self.order.index("p") > self.order.index("q"):
            parts.reverse()
        return _single(parts[0]), _single(parts[1])

    @contextlib.contextmanager
    def timed(self) -> Iterator[None]:
        """Around every call: what it prints, what it raises, and how long it takes."""
        if self.left <= 0:
            raise StepError("its calls took all the time that there is")
        begun = time.perf_counter()
        try:
            with _quiet(), within(self.left, f"a call of it does not end within {self.left:.3g} s"):
                yield
        except SystemExit:
            raise StepError("it calls sys.exit") from None
        finally:
            self.left -= time.perf_counter() - begun


@contextlib.contextmanager
def within(seconds: float, problem: str) -> Iterator[None]:
    """StepError with this problem where what is done here does not end in time.

    It may stand in another one, whose time goes on. In other threads than the main one, and on
    systems without alarms, there is no limit.
    """
    error = _OverTimeError(problem)

    def late(*_: object) -> None:
        raise error

    try:
        before = signal.signal(signal.SIGALRM, late)
    except (ValueError, AttributeError):
        yield
        return
    outer, _ = signal.setitimer(signal.ITIMER_REAL, seconds)
    begun = time.perf_counter()
    try:
        yield
    except _OverTimeError as raised:
        if raised is not error:
            raise
        raise StepError(problem) from None
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
        if outer:
            spent = time.perf_counter() - begun
            signal.setitimer(signal.ITIMER_REAL, max(outer - spent, 1e-3))


def _at(p: float, q: float, h: float) -> str:
    return f" at p = {p:g}, q = {q:g}, h = {h:g}"


def _parts(result: Any) -> list[Any]:
    if result is None:
        raise StepError("it returns None; wanted: p', q'")
    if isinstance(result, str | bytes):
        raise StepError("it returns text; wanted: p', q'")
    try:
        parts = list(result)
    except TypeError:
        raise StepError(f"it returns one {type(result).__name__}; wanted: p', q'") from None
    if isinstance(result, dict | set) or len(parts) != 2:
        count = f"a {type(result).__name__} of {len(parts)}"
        raise StepError(f"it returns {count}; wanted: a pair p', q'")
    return parts


def _single(x: Any) -> Any:
    shape = getattr(x, "shape", ())
    if shape:
        if any(n != 1 for n in shape):
            raise StepError(f"it returns arrays of shape {tuple(shape)} for a single p, q")
        return x.reshape(-1)[0]
    return x[()] if hasattr(x, "dtype") and hasattr(x, "reshape") else x


def _real(x: Any) -> float:
    if isinstance(x, str | bytes | bytearray) or x is None or isinstance(x, Carried):
        raise StepError(f"it returns {'text' if isinstance(x, str) else type(x).__name__}")
    if isinstance(x, complex):
        raise StepError("it returns complex numbers")
    try:
        return float(x)
    except (TypeError, ValueError):
        raise StepError(f"it returns a pair of {type(x).__name__}; wanted: numbers") from None


# -- its signature --------------------------------------------------------------------------------


def made_step(
    function: Callable[..., Any],
    arguments: str | None = None,
    parameters: Mapping[str, Fraction] | None = None,
    time_limit: float = TIME_LIMIT,
) -> tuple[Step, list[str]]:
    """The function as a Step, and notes on how its arguments are understood.

    `arguments`: "q,p,h" or another order; without it the names of its arguments tell, where they
    do. `parameters`: those of H, which it may take by name. InputError for a wrong signature.
    """
    order = _order(arguments) if arguments is not None else None
    try:
        named = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):  # some functions written in C have none
        return Step(function, order or ("p", "q", "h"), left=time_limit), []
    name = getattr(function, "__name__", "step")
    places = [x for x in named if x.kind in _POSITIONAL]
    variadic = any(x.kind is inspect.Parameter.VAR_POSITIONAL for x in named)
    rest = [*places[3:], *(x for x in named if x.kind is inspect.Parameter.KEYWORD_ONLY)]
    known = parameters or {}
    given = {x.name: float(known[x.name]) for x in rest if x.name in known}
    missing = [x.name for x in rest if x.default is x.empty and x.name not in given]
    if (len(places) < 3 and not variadic) or missing:
        shown = f"{name}({', '.join(str(x) for x in named)})"
        raise InputError("integrator", shown, "wanted: step(p, q, h), which returns p', q'")
    notes = []
    if order is None:
        named_so = tuple(_NAMES.get(x.name.lower().strip("_"), "") for x in places[:3])
        order = ("p", "q", "h")
        if sorted(named_so) == ["h", "p", "q"]:
            order = named_so[0], named_so[1], named_so[2]
        first = ", ".join(x.name for x in places[:3])
        if order != ("p", "q", "h") or sorted(named_so) != ["h", "p", "q"]:
            notes.append(f"its arguments ({first}) are taken as ({', '.join(order)})")
    return Step(function, order, given, left=time_limit), notes


def _order(arguments: str) -> tuple[str, str, str]:
    names = [name.strip() for name in arguments.split(",")]
    if sorted(names) != ["h", "p", "q"]:
        raise InputError("--arguments", arguments, "is no order of p, q and h, such as q,p,h")
    return names[0], names[1], names[2]


# -- what is wrong with it ------------------------------------------------------------------------


@dataclass(frozen=True)
class Fault:
    """`name`: such as "frozen"; `text`: the sentence. `fatal`: it is no step of a scheme."""

    name: str
    text: str
    fatal: bool = True


_STEPS = 0.125, 0.0625  # with which it is tried


def examined(step: Step, points: Sequence[tuple[Fraction, Fraction]]) -> list[Fault]:
    """What is wrong with it at these points; an empty list where nothing is seen.

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
        return [_failure(states[0], failures[states[0]])]
    try:
        return [*_as_a_map(step, first), *_with_arrays(step, first)]
    except StepError as error:
        return [Fault("fails", f"{error}; elsewhere it does not")]


def _first(step: Step, p: float, q: float, h: float, try_arrays: bool) -> State:
    try:
        return step.at(p, q, h)
    except (TypeError, IndexError, AttributeError):
        if not try_arrays or "numpy" not in sys.modules:
            raise
        step.arrays = True
        try:
            return step.at(p, q, h)
        except Exception:
            step.arrays = False
        raise


def _failure(state: State, error: Exception) -> Fault:
    where = _at(*state, _STEPS[0])
    if isinstance(error, StepError):
        return Fault("not a step", str(error))
    return Fault("raises", f"it raises {last_line(error)}{where}")


def _as_a_map(step: Step, first: Mapping[State, State]) -> list[Fault]:
    """Whether it is one map of (p, q, h), the same at every call, and one that moves."""
    second = {state: step.at(*state, _STEPS[1]) for state in first}
    for state, before in first.items():
        after = step.at(*state, _STEPS[0])
        if after != before:
            found = f"{before} and then {after}{_at(*state, _STEPS[0])}"
            return [Fault("not a function", f"it is not deterministic: it returns {found}")]
    if all(state == after for state, after in first.items()):
        text = "it is frozen: p' = p and q' = q, which preserves area and is no scheme"
        return [Fault("frozen", text)]
    if all(second[state] == after for state, after in first.items()):
        return [Fault("ignores h", "it ignores h: its step is the same for h = 1/8 and 1/16")]
    return []


def _with_arrays(step: Step, first: Mapping[State, State]) -> list[Fault]:
    """Whether it changes arrays that it is given. Without numpy in use there are none."""
    if "numpy" not in sys.modules:
        return []
    import numpy as np

    p, q = (np.array([state[i] for state in first]) for i in (0, 1))
    kept = p.copy(), q.copy()
    try:
        with step.timed():
            step.raw(step.function, p, q, _STEPS[0])
    except Exception:  # it is for single numbers
        return []
    if np.array_equal(p, kept[0]) and np.array_equal(q, kept[1]):
        return []
    return [Fault("mutates", "it changes the arrays p or q that it is given", fatal=False)]
