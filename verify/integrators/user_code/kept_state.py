"""What of a user's function outlives its calls, and whether they change it.

Globals that it names, the cells and defaults of it and of the functions that it reaches, the
attributes of functions, objects and classes of the user's: all as bytes, by the name through which
the function reaches them. Of a library's module it is the numbers and texts in it that count, and
its classes are constant.
"""

import contextlib
import io
import pickle
import random
import sys
import types
import warnings
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from verify.integrators.tracing.functions import names_in
from verify.integrators.tracing.purity import is_of_user, is_plain, is_users_module

Kept = Mapping[str, bytes]  # by name


def kept_by(function: Callable[..., Any]) -> Kept:
    """What the function keeps now."""
    with warnings.catch_warnings(action="ignore"):  # of what is not to be pickled any more
        kept = {name: _bytes(value) for name, value in _reached(_plain(function))}
    return {**kept, **_generators()}


def _generators() -> Kept:
    """What random numbers come from, where a module hides it."""
    kept = {"random": _bytes(random.getstate())}
    if "numpy.random" in sys.modules:
        kept["numpy.random"] = _bytes(sys.modules["numpy.random"].get_state())
    return kept


def changed(before: Kept, after: Kept) -> list[str]:
    """The names under which something else is kept now."""
    return [name for name in {**before, **after} if before.get(name) != after.get(name)]


def _plain(x: Any) -> Any:
    """What numba and caches wrap; an object's method for the object itself where it is called."""
    inner = getattr(x, "py_func", None) or getattr(x, "__wrapped__", None)
    return inner if isinstance(inner, types.FunctionType) else x


def _reached(x: Any) -> Iterator[tuple[str, Any]]:
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
    """Stands for what is written by its contents."""


class _Pickler(pickle.Pickler):
    """Writes functions and classes of the user's by what they hold, where pickle writes names.

    Nothing is ever read back. What cannot be written is written as its type's name.
    """

    def reducer_override(self, x: Any) -> Any:
        function = _plain(x)
        if isinstance(function, types.FunctionType):
            return _Blank, (), dict(_reached(function)) if is_of_user(function) else None
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
    """Where a generator stands."""
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
