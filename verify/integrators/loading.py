"""A user's own step function: loaded, and its arguments understood.

`verify check-integrator` and `verify.testing` run the user's code; nothing else in `verify` does.
"""

import inspect
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from types import ModuleType

from verify.errors import InputError, is_meant, nearest
from verify.integrators.step import TIME_LIMIT, Step, Theirs, contained, last_line
from verify.integrators.user_modules import from_file, from_folder

_NAMES = {
    **dict.fromkeys(("p", "v", "p0", "momentum", "velocity", "mom", "vel"), "p"),
    **dict.fromkeys(("q", "x", "q0", "position", "displacement", "pos"), "q"),
    **dict.fromkeys(("t", "time", "t0"), "t"),
    **dict.fromkeys(("h", "dt", "tau", "step", "step_size", "stepsize", "delta_t"), "h"),
}
_USUAL = ("p", "q", "h")
_COUNTS = {4: ["h", "p", "q", "t"], 3: ["h", "p", "q"]}  # arguments, sorted, t among them first
_USUAL_IN_TIME = ("p", "q", "t", "h")
_MOST_SECONDS = 86_400
_LISTED = 8  # functions of a module, in an error
_POSITIONAL = inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD


def load(target: str, called: str = "integrator") -> Callable[..., Theirs]:
    """The function that MODULE:FUNCTION or path/to/file.py:function names. Runs the module.

    It is looked for in the current folder first. `called`: what an error calls it. Raises
    InputError where it does not import, has no such name, or that is no function.
    """
    place, _, name = target.rpartition(":")
    if not place or not name:
        raise InputError(called, target, "write it as MODULE:FUNCTION or file.py:FUNCTION")
    if place.endswith(":"):
        raise InputError(called, target, f"write one : in it, as {place[:-1]}:{name}")
    with contained():
        module = _module(place, target, called)
        found: Theirs = module
        for part in name.split("."):
            if not hasattr(found, part):
                raise InputError(called, target, f"{place} has no {name}; {_has(module, name)}")
            found = getattr(found, part)
    if not callable(found):
        raise InputError(called, target, f"{name} is no function but {type(found).__name__}")
    function: Callable[..., Theirs] = found
    return function


def _has(module: ModuleType, wanted: str) -> str:
    """Which functions it has, the nearest to what was wanted first."""
    known = sorted(name for name, x in vars(module).items() if inspect.isfunction(x))
    if not known:
        return "it has no function"
    near = nearest(wanted, known)
    listed = sorted(known, key=lambda name: name != near)
    more = f", and {len(listed) - _LISTED} more" if len(listed) > _LISTED else ""
    return f"{is_meant(near)}it has: {', '.join(listed[:_LISTED])}{more}"


def _module(place: str, target: str, called: str) -> ModuleType:
    path = Path(place)
    try:
        if path.suffix == ".py":
            if not path.is_file():
                raise InputError(called, target, f"there is no file {place}")
            return from_file(path)
        if path.is_file() or "/" in place:
            problem = f"{place} is no Python file; write file.py:FUNCTION"
            raise InputError(called, target, problem)
        return from_folder(place)
    except (InputError, KeyboardInterrupt):
        raise
    except BaseException as error:  # SystemExit too: it is the user's code
        unknown = isinstance(error, ModuleNotFoundError) and error.name == place.split(".")[0]
        hint = "; write the path of its file, as file.py:FUNCTION" if unknown else ""
        problem = f"does not import: {last_line(error)}{hint}"
        raise InputError(called, target, problem) from None


# -- its signature --------------------------------------------------------------------------------


def step_from(
    function: Callable[..., Theirs],
    arguments: str | None = None,
    parameters: Mapping[str, Fraction] | None = None,
    time_limit: float = TIME_LIMIT,
) -> tuple[Step, list[str]]:
    """The function as a Step, and notes on how its arguments are understood.

    `arguments`: "q,p,h" or another order; without it the names of its arguments tell, where they
    do. `parameters`: those of H, which it may take by name. InputError for a wrong signature, or
    a time limit that is none.
    """
    if not 0.01 <= time_limit <= _MOST_SECONDS:
        problem = f"is no number of seconds from 0.01 to {_MOST_SECONDS}"
        raise InputError("time limit", time_limit, problem)
    order = _order(arguments) if arguments is not None else None
    try:
        named = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):  # some functions written in C have none
        return Step(function, order or _USUAL, left=time_limit), []
    name = getattr(function, "__name__", "step")
    places = [x for x in named if x.kind in _POSITIONAL]
    variadic = any(x.kind is inspect.Parameter.VAR_POSITIONAL for x in named)
    called = [_NAMES.get(x.name.lower().strip("_"), "") for x in places]
    named_so = (
        None
        if order
        else next((o for n in _COUNTS if (o := _as_order(called[:n])) is not None), None)
    )
    count = len(order or named_so or _USUAL)
    rest = [*places[count:], *(x for x in named if x.kind is inspect.Parameter.KEYWORD_ONLY)]
    known = parameters or {}
    given = {x.name: float(known[x.name]) for x in rest if x.name in known}
    missing = [x.name for x in rest if x.default is x.empty and x.name not in given]
    if (len(places) < count and not variadic) or missing:
        shown = f"{name}({', '.join(str(x) for x in named)})"
        wanted = "wanted: step(p, q, h) or step(p, q, t, h), which returns p', q'"
        raise InputError("integrator", shown, wanted)
    notes = []
    if order is None:
        order = named_so or _USUAL
        if named_so not in (_USUAL, _USUAL_IN_TIME):
            first = ", ".join(x.name for x in places[:count])
            notes.append(f"its arguments ({first}) are taken as ({', '.join(order)})")
    return Step(function, order, given, left=time_limit), notes


def _order(arguments: str) -> tuple[str, ...]:
    order = _as_order([name.strip() for name in arguments.split(",")])
    if order is None:
        problem = "is no order of p, q and h, such as q,p,h, nor of p, q, t and h"
        raise InputError("--arguments", arguments, problem)
    return order


def _as_order(names: Sequence[str]) -> tuple[str, ...] | None:
    return tuple(names) if sorted(names) in _COUNTS.values() else None
