"""A copy of a user's function in which `math` and numpy know our numbers, too.

The copy has globals of its own: modules like `math` and functions like `sin` are replaced, and so
are the helper functions of the user's modules, in closures and defaults as well. These modules are
not changed. What is hidden deeper, as in an object's attributes, is called as it is.
"""

import cmath
import contextlib
import functools
import math
import operator
import sys
import types
from collections.abc import Callable, Iterable
from fractions import Fraction
from pathlib import Path
from typing import Any

from verify.integrators.tracing.number import FUNCTIONS, Kind, TracedNumber, constant

_MODULES = ("math", "cmath", "numpy")
_FOREIGN = ("numpy", "scipy", "numba")
_PLAIN = int | float | Fraction
_FILLED = ("zeros", "ones", "empty", "full", "zeros_like", "ones_like", "empty_like", "full_like")


def copied(function: Any, kind: Kind) -> Any:
    """The function with replaced globals; itself where it is not written in Python."""
    call = vars(type(function)).get("__call__")
    if isinstance(call, types.FunctionType):
        function = types.MethodType(call, function)  # an object that is called
    return _Copier(kind).value(function)


def _is_users(x: types.FunctionType) -> bool:
    """Whether it is the user's: not of Python's library, nor of one that is full of floats."""
    home = (x.__module__ or "").partition(".")[0]
    return home not in sys.stdlib_module_names - {"__main__"} and home not in _FOREIGN


def is_users_module(x: types.ModuleType) -> bool:
    """Whether it is the user's: neither of Python's library nor installed."""
    folders = Path(getattr(x, "__file__", None) or "site-packages").parts
    standard = x.__name__.partition(".")[0] in sys.stdlib_module_names
    return not standard and not {"site-packages", "dist-packages"} & set(folders)


class _Copier:
    """Copies what a function reaches, each thing once."""

    def __init__(self, kind: Kind) -> None:
        self.kind = kind
        self.copies: dict[int, Any] = {}
        self.kept: list[Any] = []  # so that no id is used again
        own = [(math, name) for name in (*FUNCTIONS, *_OTHERS) if hasattr(math, name)]
        self.known = {id(getattr(module, name)): name for module, name in own}

    def value(self, x: Any) -> Any:
        if id(x) in self.copies:
            return self.copies[id(x)]
        if isinstance(x, types.ModuleType):
            if x.__name__ in _MODULES:
                return _Module(x, self)
            return _Helpers(x, self) if is_users_module(x) else x
        if isinstance(x, functools.partial):
            bound = {name: self.value(v) for name, v in x.keywords.items()}
            return functools.partial(self.value(x.func), *map(self.value, x.args), **bound)
        if isinstance(x, types.MethodType) and isinstance(x.__func__, types.FunctionType):
            return types.MethodType(self.value(x.__func__), _Self(x.__self__, self))
        # numba's functions, and those with a cache, hold the plain one.
        inner = getattr(x, "py_func", None) or getattr(x, "__wrapped__", None)
        if isinstance(inner, types.FunctionType) and not isinstance(x, types.FunctionType):
            return self.value(inner)
        if isinstance(x, types.FunctionType):
            return self.function(x) if _is_users(x) else x
        return self.replacement(x)

    def replacement(self, x: Any) -> Any:
        """For a function that was imported by its name; else the thing itself."""
        name = self.known.get(id(x))
        if name is None and type(x).__module__ == "numpy" and type(x).__name__ == "ufunc":
            name = x.__name__
        return self.named(name, x) if name is not None else x

    def named(self, name: str, x: Any) -> Any:
        if name in FUNCTIONS:
            return _applied(self.kind, FUNCTIONS[name], x)
        if name in _OTHERS and isinstance(x, types.BuiltinFunctionType | type):
            return _guarded(_OTHERS[name], x)
        return x

    def function(self, x: types.FunctionType) -> types.FunctionType:
        code, scope = x.__code__, dict(x.__globals__)
        cells = tuple(types.CellType() for _ in x.__closure__ or ())
        made = types.FunctionType(code, scope, x.__name__, None, cells or None)
        self.copies[id(x)] = made  # before what it calls: it may call itself
        self.kept.append(x)
        for name in names_in(code):
            if name in scope:
                scope[name] = self.value(scope[name])
        scope.setdefault("float", _Float)
        for cell, own in zip(cells, x.__closure__ or (), strict=True):
            with contextlib.suppress(ValueError):  # a name that has no value yet
                cell.cell_contents = self.value(own.cell_contents)
        if x.__defaults__:
            made.__defaults__ = tuple(map(self.value, x.__defaults__))
        if x.__kwdefaults__:
            made.__kwdefaults__ = {name: self.value(v) for name, v in x.__kwdefaults__.items()}
        return made


def names_in(code: types.CodeType) -> Iterable[str]:
    """The names that the code, and what is defined in it, may look up."""
    yield from code.co_names
    for inner in code.co_consts:
        if isinstance(inner, types.CodeType):
            yield from names_in(inner)


class _Module:
    """`math` or numpy, with functions that know our numbers, and all else as it is."""

    def __init__(self, module: types.ModuleType, copier: _Copier) -> None:
        self._module, self._copier = module, copier

    def __getattr__(self, name: str) -> Any:
        kind = self._copier.kind
        if name in ("pi", "e", "tau") and self._module is not cmath:
            pi = kind.pi()
            return {"pi": pi, "tau": 2 * pi, "e": kind.rational(Fraction(1)).applied("exp")}[name]
        found = getattr(self._module, name)
        if self._module is cmath:
            return found
        if name in ("float64", "float_", "double"):
            return _Float
        if name in _FILLED:
            return _of_objects(found)
        return self._copier.named(name, found)


class _Helpers:
    """A module of the user's, whose functions are copied as they are asked for."""

    def __init__(self, module: types.ModuleType, copier: _Copier) -> None:
        self._module, self._copier = module, copier

    def __getattr__(self, name: str) -> Any:
        return self._copier.value(getattr(self._module, name))


class _Self:
    """An object of the user's class, whose methods are copied; the object itself is the user's."""

    def __init__(self, own: Any, copier: _Copier) -> None:
        object.__setattr__(self, "_own", own)
        object.__setattr__(self, "_copier", copier)

    def __getattr__(self, name: str) -> Any:
        found = getattr(self._own, name)
        if isinstance(found, types.MethodType) and found.__self__ is self._own:
            return types.MethodType(self._copier.value(found.__func__), self)
        return self._copier.value(found)

    def __setattr__(self, name: str, value: Any) -> None:
        setattr(self._own, name, value)


class _FloatType(type):
    def __instancecheck__(cls, x: object) -> bool:
        return isinstance(x, float | TracedNumber)


class _Float(float, metaclass=_FloatType):
    """`float` that lets our numbers through; as an array's type it is that of objects."""

    def __new__(cls, x: Any = 0.0) -> Any:
        return x if isinstance(x, TracedNumber) else float(x)


def _of_objects(original: Callable[..., Any]) -> Callable[..., Any]:
    """What makes an array of floats makes one of objects, which our numbers can be put into."""

    def call(*given: Any, **options: Any) -> Any:
        if options.get("dtype") in (None, float, _Float):
            options["dtype"] = object
        return original(*given, **options)

    return call


def _applied(kind: Kind, name: str, original: Callable[..., Any]) -> Callable[..., Any]:
    """The function of ours for our numbers and for plain ones, whose value stays exact."""

    def call(x: Any, *others: Any, **options: Any) -> Any:
        if not others and not options and isinstance(x, TracedNumber | _PLAIN):
            lifted = constant(kind, x)
            if lifted is not None:
                return lifted.applied(name)
        return original(x, *others, **options)

    return call


def _guarded(own: Callable[..., Any], original: Callable[..., Any]) -> Callable[..., Any]:
    """`own` where one of our numbers is given, else the original."""

    def call(*given: Any, **options: Any) -> Any:
        listed = not options and len(given) == 1 and isinstance(given[0], list | tuple)
        if any(isinstance(x, TracedNumber) for x in (given[0] if listed else given)):
            return own(*given, **options)
        return original(*given, **options)

    return call


def _isclose(x: Any, y: Any, *, rel_tol: float = 1e-9, abs_tol: float = 0.0) -> bool:
    return bool(abs(x - y) <= max(rel_tol * max(abs(x), abs(y)), abs_tol))


_OTHERS: dict[str, Callable[..., Any]] = {
    "isclose": _isclose,
    "pow": operator.pow,
    "fabs": operator.abs,
    "expm1": lambda x: x.applied("exp") - 1,
    "log1p": lambda x: (x + 1).applied("log"),
    "isnan": lambda x: not x.isfinite(),
    "isinf": lambda x: not x.isfinite(),
    "isfinite": lambda x: x.isfinite(),
    "fsum": sum,
    "hypot": lambda *given: sum(x * x for x in given) ** Fraction(1, 2),
}
